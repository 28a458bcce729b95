// SPDX-License-Identifier: MIT
#include "capture/registration/registration.h"

#include "capture/registration/colour_learning.h"
#include "capture/registration/contour.h"
#include "capture/registration/contour_match.h"
#include "core/alignment/projection_derivative.h"
#include "core/numerics/median.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace sheen::capture {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr std::array kColourReaches{1.0, 0.7, 0.5, 0.35, 0.22};  // shares of the search distance
constexpr std::array kEdgeReachesPx{6.0, 4.0, 3.0, 2.5};
constexpr int kStepsPerReach = 5;
constexpr double kShortestStepPx = 0.003;
constexpr double kSpacingPx = 4;
constexpr double kSmallestReachPx = 5;
constexpr double kLargestReachPx = 50;
constexpr double kMatchedPx = 2;
constexpr double kFarReach = 0.7;       // share of the search distance at which views are judged
constexpr double kColourSlackPx = 1.5;  // what the ends of colours may differ by between good views
constexpr double kEdgeSlackPx = 0.25;
constexpr double kSmallestSpreadPx = 0.3;
constexpr double kIndependentShare =
    0.05;  // of the points: neighbours and views share their errors
constexpr int kSmallestViews = 3;

/// Normal equations of one view. Unknowns: turn about the object's centre (times its radius, so
/// that all are metres), shift; both in the stage frame.
struct ViewSystem {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  std::vector<double> distances_px;  ///< of the matched points
  std::size_t points = 0;            ///< matched or not
};

enum class Cue { colour, edge };

struct Stage {
  Cue cue = Cue::colour;
  double reach = 1;  ///< share of the search distance (colour), px (edge)
};

class Aligner {
 public:
  Aligner(const core::Mesh& mesh, const core::CameraModel& camera,
          const std::vector<RegistrationView>& views, const Eigen::Isometry3d& guess,
          const RegistrationLimits& limits)
      : camera_(camera), views_(views), guess_(guess), limits_(limits), contours_(mesh) {
    radius_m_ = contours_.bounds().diagonal().norm() / 2;
    trust_.assign(views.size(), 1);
  }

  void run(const Stage& stage, Eigen::Isometry3d& board_from_object) {
    learn_colours(stage, board_from_object);
    trust_.assign(views_.size(), 1);
    if (stage.cue == Cue::edge) {
      // Seen from afar first: close by, a wrong view finds some edge everywhere.
      measure({Cue::colour, kFarReach}, board_from_object);
      distrust_odd_views(kColourSlackPx);
    }
    for (int step = 0; step < kStepsPerReach; ++step) {
      measure(stage, board_from_object);
      if (stage.cue == Cue::edge) distrust_odd_views(kEdgeSlackPx);
      const Vector6d twist = solve(stage, board_from_object);
      move(twist, board_from_object);
      if (twist.norm() * focal_per_metre(board_from_object) < kShortestStepPx) break;
    }
  }

  /// Residuals, uncertainty and counts at the end.
  [[nodiscard]] Registration summarise(const Eigen::Isometry3d& board_from_object) {
    measure({Cue::edge, kEdgeReachesPx.back()}, board_from_object);
    distrust_odd_views(kEdgeSlackPx);
    Registration result;
    result.board_from_object = board_from_object;
    std::vector<double> distances_px;
    std::size_t points = 0;
    std::size_t near = 0;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      if (!(trust_[v] > 0)) continue;
      ++result.views;
      points += systems_[v].points;
      for (const double distance : systems_[v].distances_px) {
        near += distance < kMatchedPx;
        distances_px.push_back(distance);
      }
    }
    for (const double trust : trust_) result.agrees.push_back(trust > 0);
    result.points = distances_px.size();
    if (points > 0) result.matched_share = static_cast<double>(near) / static_cast<double>(points);
    if (!distances_px.empty()) result.residual_px = core::upper_median(distances_px);
    estimate_uncertainty(result);
    describe_motion(result);
    return result;
  }

 private:
  [[nodiscard]] Eigen::Vector3d centre(const Eigen::Isometry3d& board_from_object) const {
    return board_from_object * contours_.bounds().center();
  }

  /// Pixels per metre at the object's centre.
  [[nodiscard]] double scale_px(const RegistrationView& view,
                                const Eigen::Isometry3d& board_from_object) const {
    const double depth_m = (view.camera_from_board * centre(board_from_object)).z();
    return camera_.intrinsics().focal_px.mean() / std::max(depth_m, 1e-3);
  }

  [[nodiscard]] double focal_per_metre(const Eigen::Isometry3d& board_from_object) const {
    double sum = 0;
    for (const auto& view : views_) sum += scale_px(view, board_from_object);
    return sum / static_cast<double>(views_.size());
  }

  [[nodiscard]] double reach_px(const Stage& stage, const RegistrationView& view,
                                const Eigen::Isometry3d& board_from_object) const {
    if (stage.cue == Cue::edge) return stage.reach;
    return std::clamp(stage.reach * limits_.search_m * scale_px(view, board_from_object),
                      kSmallestReachPx, kLargestReachPx);
  }

  /// Counts colours within the object and round it, a distance away from its supposed outline.
  void learn_colours(const Stage& stage, const Eigen::Isometry3d& board_from_object) {
    colours_ = ColourStatistics();
    for (const RegistrationView& view : views_) {
      learn_colours_of(view.image, contours_, camera_, view.camera_from_board * board_from_object,
                       reach_px(stage, view, board_from_object), kAllPixels, colours_);
    }
    colours_.finish();
  }

  /// Matches the outline in every view and sets up its normal equations.
  void measure(const Stage& stage, const Eigen::Isometry3d& board_from_object) {
    systems_.assign(views_.size(), {});
    for (std::size_t v = 0; v < views_.size(); ++v) {
      measure_view(stage, views_[v], board_from_object, systems_[v]);
    }
    if (stage.cue == Cue::edge) spread_px_ = edge_spread_px();
  }

  void measure_view(const Stage& stage, const RegistrationView& view,
                    const Eigen::Isometry3d& board_from_object, ViewSystem& system) const {
    const Eigen::Isometry3d camera_from_object = view.camera_from_board * board_from_object;
    const double reach = reach_px(stage, view, board_from_object);
    for (const ContourPoint& point : contours_.find(camera_, camera_from_object, kSpacingPx)) {
      ++system.points;
      const auto match =
          stage.cue == Cue::colour
              ? match_by_colour(view.image, colours_, point, static_cast<int>(std::lround(reach)))
              : match_by_edge(view.image, colours_, point, reach);
      if (!match) continue;
      system.distances_px.push_back(std::abs(match->offset_px));
      const double spread = stage.cue == Cue::colour ? reach : 2.5 * spread_px_;
      const double ratio = match->offset_px / spread;
      const double weight =
          view.weight * match->weight / ((1 + ratio * ratio) * (1 + ratio * ratio));
      const Vector6d a = derivative(view, board_from_object, point);
      system.H += weight * a * a.transpose();
      system.g += weight * match->offset_px * a;
    }
  }

  /// How the outline moves outwards with the object.
  [[nodiscard]] Vector6d derivative(const RegistrationView& view,
                                    const Eigen::Isometry3d& board_from_object,
                                    const ContourPoint& point) const {
    const Eigen::Vector3d in_board = board_from_object * point.in_object;
    const auto projected =
        core::project_with_derivative(camera_, view.camera_from_board * in_board);
    if (!projected) return Vector6d::Zero();
    const Eigen::Vector3d by_shift =
        (point.outward.transpose() * projected->pixel_by_point * view.camera_from_board.linear())
            .transpose();
    Vector6d a;
    a << (in_board - centre(board_from_object)).cross(by_shift) / radius_m_, by_shift;
    return a;
  }

  [[nodiscard]] double edge_spread_px() const {
    std::vector<double> distances_px;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      if (!(trust_[v] > 0)) continue;
      distances_px.insert(distances_px.end(), systems_[v].distances_px.begin(),
                          systems_[v].distances_px.end());
    }
    if (distances_px.empty()) return kSmallestSpreadPx;
    return std::max(kSmallestSpreadPx, 1.4826 * core::upper_median(distances_px));
  }

  /// A view whose outline is off by far more than the others' has a wrong pose or is smeared. What
  /// is usual is said by the views that are trusted most: the median is weighted.
  void distrust_odd_views(double slack_px) {
    std::vector<std::pair<double, double>> sorted;  // median distance, weight
    std::vector<double> medians_px(views_.size(), std::numeric_limits<double>::infinity());
    double weight = 0;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      std::vector<double> distances_px = systems_[v].distances_px;
      if (!distances_px.empty()) medians_px[v] = core::upper_median(distances_px);
      sorted.emplace_back(medians_px[v], views_[v].weight);
      weight += views_[v].weight;
    }
    std::sort(sorted.begin(), sorted.end());
    double below = 0;
    auto usual = sorted.begin();
    while (usual + 1 != sorted.end() && (below += usual->second) < weight / 2) ++usual;
    const double limit_px = 2 * usual->first + slack_px;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      if (!(medians_px[v] <= limit_px)) trust_[v] = 0;
    }
  }

  [[nodiscard]] Matrix6d weighted_hessian() const {
    Matrix6d H = Matrix6d::Zero();
    for (std::size_t v = 0; v < views_.size(); ++v) H += trust_[v] * systems_[v].H;
    return H;
  }

  /// What is to be added to the diagonal of H, for matches of the given noise.
  [[nodiscard]] double prior_information(double noise_px) const {
    return noise_px * noise_px / (kIndependentShare * limits_.search_m * limits_.search_m);
  }

  /// Gauss-Newton step. A weak prior keeps what the outline does not tell near the guess: one
  /// standard deviation of the search distance in every direction.
  [[nodiscard]] Vector6d solve(const Stage& stage,
                               const Eigen::Isometry3d& board_from_object) const {
    Vector6d g = Vector6d::Zero();
    for (std::size_t v = 0; v < views_.size(); ++v) g += trust_[v] * systems_[v].g;
    const double prior = prior_information(
        stage.cue == Cue::edge ? spread_px_ : 0.3 * reach_px(stage, views_[0], board_from_object));
    const Eigen::AngleAxisd turned(board_from_object.linear() * guess_.linear().transpose());
    Vector6d moved;
    moved << radius_m_ * turned.angle() * turned.axis(), centre(board_from_object) - centre(guess_);
    Matrix6d H = weighted_hessian();
    H.diagonal().array() += prior;
    return H.ldlt().solve(g - prior * moved);
  }

  void move(const Vector6d& twist, Eigen::Isometry3d& board_from_object) const {
    const Eigen::Vector3d turn = twist.head<3>() / radius_m_;
    const Eigen::Vector3d about = centre(board_from_object);
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.translate(about + twist.tail<3>());
    if (turn.norm() > 0) motion.rotate(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
    motion.translate(-about);
    board_from_object = motion * board_from_object;
    board_from_object.linear() =
        Eigen::Quaterniond(board_from_object.linear()).normalized().toRotationMatrix();
  }

  /// Spread of the solution if the views were drawn anew: H^-1 (sum of g g^T over views) H^-1,
  /// since neighbouring points of one view err together.
  void estimate_uncertainty(Registration& result) const {
    Matrix6d scatter = Matrix6d::Zero();
    for (std::size_t v = 0; v < views_.size(); ++v) {
      scatter += trust_[v] * systems_[v].g * systems_[v].g.transpose();
    }
    const double views = std::max(1, result.views);
    if (result.views > 1) scatter *= views / (views - 1);
    Matrix6d H = weighted_hessian();
    H.diagonal().array() += prior_information(spread_px_);
    const Matrix6d inverse = H.ldlt().solve(Matrix6d::Identity());
    const Matrix6d covariance = inverse * scatter * inverse;
    const auto worst = [](const Eigen::Matrix3d& block) {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(block, Eigen::EigenvaluesOnly);
      return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
    };
    result.sigma_rad = worst(covariance.topLeftCorner<3, 3>()) / radius_m_;
    result.sigma_m = worst(covariance.bottomRightCorner<3, 3>());
  }

  void describe_motion(Registration& result) const {
    const Eigen::Isometry3d& after = result.board_from_object;
    result.translation_m = (centre(after) - centre(guess_)).norm();
    result.rotation_rad = Eigen::AngleAxisd(after.linear() * guess_.linear().transpose()).angle();
    double sum = 0;
    std::size_t count = 0;
    for (const RegistrationView& view : views_) {
      for (const ContourPoint& point :
           contours_.find(camera_, view.camera_from_board * after, kSpacingPx)) {
        const auto before = camera_.project(view.camera_from_board * guess_ * point.in_object);
        if (!before) continue;
        sum += (point.pixel - *before).norm();
        ++count;
      }
    }
    if (count > 0) result.motion_px = sum / static_cast<double>(count);
  }

  const core::CameraModel& camera_;
  const std::vector<RegistrationView>& views_;
  const Eigen::Isometry3d& guess_;
  const RegistrationLimits& limits_;
  ContourFinder contours_;
  ColourStatistics colours_;
  double radius_m_ = 0;
  double spread_px_ = 1;
  std::vector<double> trust_;  ///< 1 or 0 per view
  std::vector<ViewSystem> systems_;
};

}  // namespace

std::optional<Registration> register_object(const core::Mesh& mesh, const core::CameraModel& camera,
                                            const std::vector<RegistrationView>& views,
                                            const Eigen::Isometry3d& guess,
                                            const RegistrationLimits& limits) {
  if (views.size() < kSmallestViews) return std::nullopt;
  Aligner aligner(mesh, camera, views, guess, limits);
  Eigen::Isometry3d board_from_object = guess;
  for (const double reach : kColourReaches) aligner.run({Cue::colour, reach}, board_from_object);
  for (const double reach : kEdgeReachesPx) aligner.run({Cue::edge, reach}, board_from_object);
  const Registration result = aligner.summarise(board_from_object);
  if (!board_from_object.matrix().allFinite() || result.matched_share < limits.min_matched_share ||
      result.views < kSmallestViews) {
    return std::nullopt;
  }
  return result;
}

}  // namespace sheen::capture
