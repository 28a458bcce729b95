// SPDX-License-Identifier: MIT
#include "capture/walk_calibration/walk_calibration.h"

#include "capture/pose/bundle_residuals.h"
#include "capture/pose/joint_pose.h"

#include <Eigen/Dense>
#include <ceres/ceres.h>
#include <ceres/normal_prior.h>
#include <ceres/sized_cost_function.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

namespace sheen::capture {
namespace {

constexpr std::size_t kMostViews = 80;
constexpr double kHuberPx = 2;    // of the eight residuals of a tag together
constexpr double kToldApart = 3;  // standard deviations
constexpr double kExpectedNoisePx = 0.3;
constexpr double kMostHeightSigma = 0.1;
constexpr double kMostRmsPx = 3;
constexpr std::array<double, 3> kStarts{1.0, 0.6, 1.7};  // of the prior's focal length

constexpr int kNumbers = 9;
constexpr std::array<std::string_view, kNumbers> kNames{"focal", "edges",  "k1", "cx", "cy",
                                                        "k2",    "aspect", "p1", "p2"};
constexpr std::array<int, kNumbers> kGroups{0, 1, 2, 3, 3, 4, 5, 6, 6};  // kept or left together
constexpr int kGroupCount = 7;
constexpr int kFocal = 0;
constexpr int kEdges = 1;
constexpr int kAspect = 6;
using Lens = std::array<double, kNumbers>;
using LensMatrix = Eigen::Matrix<double, kNumbers, kNumbers>;
using LensVector = Eigen::Matrix<double, kNumbers, 1>;

/// Our numbers as the residuals want them.
template <typename T>
void expand(const T* lens, T* full) {
  using std::exp;
  const T focal = exp(lens[kFocal]);
  const std::array<T, 12> all{focal,   focal * lens[kAspect],
                              lens[3], lens[4],
                              lens[2], lens[5],
                              lens[7], lens[8],
                              T(0),    T(0),
                              T(0),    T(0)};
  std::copy(all.begin(), all.end(), full);
}

/// expand's derivative: 12 x 9.
Eigen::Matrix<double, 12, kNumbers> expansion_derivative(const Lens& lens) {
  Eigen::Matrix<double, 12, kNumbers> D = Eigen::Matrix<double, 12, kNumbers>::Zero();
  const double focal = std::exp(lens[kFocal]);
  D(0, kFocal) = focal;
  D(1, kFocal) = focal * lens[kAspect];
  D(1, kAspect) = focal;
  D(2, 3) = D(3, 4) = D(4, 2) = D(5, 5) = D(6, 7) = D(7, 8) = 1;
  return D;
}

/// What is believed beforehand: values and standard deviations of the numbers.
struct Belief {
  Lens value;
  Lens sigma;
};

Belief belief_of(const LensPrior& prior) {
  const double longer_px = std::max(prior.size.width_px, prior.size.height_px);
  return {
      {std::log(prior.focal_px), 0, 0, 0.5 * (prior.size.width_px - 1),
       0.5 * (prior.size.height_px - 1), 0, prior.pixel_aspect, 0, 0},
      {prior.focal_sigma, 0.3, 0.3, 0.03 * longer_px, 0.03 * longer_px, 0.5, 0.01, 0.005, 0.005}};
}

core::CameraModel camera_of(const Lens& lens, const ImageSize& size) {
  LensParameters full{};
  expand(lens.data(), full.data());
  core::CameraModel::Intrinsics intrinsics;
  intrinsics.width_px = size.width_px;
  intrinsics.height_px = size.height_px;
  return camera_with(full, core::CameraModel(intrinsics));
}

/// How the corners of a tag move when each of its sides moves outwards by a pixel.
Eigen::Matrix<double, 8, 1> corners_by_edges(const TagDetection& tag) {
  const auto& corners = tag.corners_px;
  const Eigen::Vector2d centre = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
  std::array<Eigen::Vector2d, 4> outward;  // of the side from each corner to the next
  for (std::size_t c = 0; c < 4; ++c) {
    const Eigen::Vector2d along = (corners[(c + 1) % 4] - corners[c]).normalized();
    outward[c] = {along.y(), -along.x()};
    if (outward[c].dot(corners[c] - centre) < 0) outward[c] = -outward[c];
  }
  Eigen::Matrix<double, 8, 1> moves;
  for (std::size_t c = 0; c < 4; ++c) {
    const Eigen::Vector2d& before = outward[(c + 3) % 4];
    // The point that is one pixel beyond both sides; flat corners are seen too obliquely to tell.
    const double turn = std::max(0.1, 1 + before.dot(outward[c]));
    moves.segment<2>(static_cast<Eigen::Index>(2 * c)) = (before + outward[c]) / turn;
  }
  return moves;
}

/// A tag's corners by pose and lens; the board lies fixed.
class WalkResidual final : public ceres::SizedCostFunction<8, 6, kNumbers> {
 public:
  WalkResidual(const TagDetection& seen, const Board::Tag& tag)
      : board_from_tag_(to_parameters(tag.board_from_tag)),
        by_edges_(corners_by_edges(seen)),
        full_(tag_and_lens_residual(core::LensKind::rational, seen, tag.size_m)) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    Lens lens{};
    std::copy_n(parameters[1], kNumbers, lens.begin());
    LensParameters full{};
    expand(lens.data(), full.data());
    const double* const all[] = {parameters[0], board_from_tag_.data(), full.data()};
    by_lens_.resize(8, 12);
    double* wanted[] = {jacobians != nullptr ? jacobians[0] : nullptr, nullptr, by_lens_.data()};
    if (!full_->Evaluate(all, residuals, jacobians != nullptr ? wanted : nullptr)) return false;
    Eigen::Map<Eigen::Matrix<double, 8, 1>>(residuals) += lens[kEdges] * by_edges_;
    if (jacobians != nullptr && jacobians[1] != nullptr) {
      using ByLens = Eigen::Matrix<double, 8, kNumbers, Eigen::RowMajor>;
      Eigen::Map<ByLens> by_numbers(jacobians[1]);
      by_numbers = by_lens_ * expansion_derivative(lens);
      by_numbers.col(kEdges) = by_edges_;
    }
    return true;
  }

 private:
  Parameters board_from_tag_;
  Eigen::Matrix<double, 8, 1> by_edges_;
  std::unique_ptr<ceres::CostFunction> full_;
  mutable Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> by_lens_;
};

struct View {
  Parameters camera_from_board;
  std::vector<const TagDetection*> tags;
};

/// Evenly spread; those that pose over two tags or more.
std::vector<View> pose_views(const Board& board, const core::CameraModel& camera,
                             const std::vector<std::vector<TagDetection>>& detections) {
  std::vector<View> views;
  for (const auto& tags : detections) {
    const auto pose = estimate_joint_pose(board, camera, tags);
    if (!pose || pose->tag_ids.size() < 2) continue;
    View view{to_parameters(pose->camera_from_board), {}};
    for (const TagDetection& tag : tags) {
      if (board.tags.contains(tag.id)) view.tags.push_back(&tag);
    }
    views.push_back(std::move(view));
  }
  return views;
}

/// Lens and poses as far as they are found.
struct State {
  Lens lens;
  std::vector<View> views;
  double cost = std::numeric_limits<double>::infinity();
};

using Free = std::array<bool, kNumbers>;

/// Moves poses and the free numbers to the least sum of Huber losses and of squared distances from
/// what is believed, which weigh as much as one corner's noise.
void adjust(const Board& board, const Belief& belief, const Free& free, State& state) {
  ceres::Problem problem;
  for (View& view : state.views) {
    for (const TagDetection* tag : view.tags) {
      problem.AddResidualBlock(new WalkResidual(*tag, board.tags.at(tag->id)),
                               new ceres::HuberLoss(kHuberPx), view.camera_from_board.data(),
                               state.lens.data());
    }
  }
  std::vector<int> held;
  ceres::Matrix A = ceres::Matrix::Zero(kNumbers, kNumbers);
  for (int i = 0; i < kNumbers; ++i) {
    const auto at = static_cast<std::size_t>(i);
    A(i, i) = kExpectedNoisePx / belief.sigma[at];
    if (!free[at]) held.push_back(i);
  }
  const Eigen::Map<const LensVector> b(belief.value.data());
  problem.AddResidualBlock(new ceres::NormalPrior(A, b), nullptr, state.lens.data());
  if (!held.empty()) {
    problem.SetManifold(state.lens.data(), new ceres::SubsetManifold(kNumbers, held));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_SCHUR;
  options.max_num_iterations = 60;
  options.function_tolerance = 1e-10;
  options.num_threads = 1;  // sums in one order: the same camera on every machine
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  state.cost =
      summary.IsSolutionUsable() ? summary.final_cost : std::numeric_limits<double>::infinity();
}

/// What the residuals at a state tell of the lens, poses eliminated (Schur complement).
struct Information {
  LensMatrix normal = LensMatrix::Zero();   ///< of the residuals
  LensMatrix scatter = LensMatrix::Zero();  ///< of the views' gradients
  Eigen::Matrix<double, kNumbers, 1> height_by_lens = LensVector::Zero();    ///< relative
  Eigen::Matrix<double, kNumbers, 1> distance_by_lens = LensVector::Zero();  ///< relative
  double square_sum = 0;  ///< Huber's weights taken in
  double plain_square_sum = 0;
  int residuals = 0;
};

double half_extent_m(const Board& board) {
  double extent = 0;
  for (const auto& [id, tag] : board.tags) {
    extent = std::max(extent, tag.board_from_tag.translation().cwiseAbs().maxCoeff());
  }
  return extent;
}

Information measure(const Board& board, const State& state) {
  Information information;
  // A small tag above the board's origin tells how heights follow the lens.
  const double height_m = half_extent_m(board);
  // Six numbers, in room for more: the compiler warns of what WalkResidual would read from it.
  const LensParameters raised{0, 0, 0, 0, 0, height_m};
  const TagDetection nowhere{0, {}, 0};
  const std::unique_ptr<ceres::CostFunction> raised_tag(
      tag_and_lens_residual(core::LensKind::rational, nowhere, 0.1 * height_m));
  LensParameters full{};
  expand(state.lens.data(), full.data());
  const auto D = expansion_derivative(state.lens);
  double height_weight = 0;

  using Residual = Eigen::Matrix<double, 8, 1>;
  using ByPose = Eigen::Matrix<double, 8, 6, Eigen::RowMajor>;
  for (const View& view : state.views) {
    Eigen::Matrix<double, 6, 6> pp = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, kNumbers> pl = Eigen::Matrix<double, 6, kNumbers>::Zero();
    LensMatrix ll = LensMatrix::Zero();
    Eigen::Matrix<double, 6, 1> pr = Eigen::Matrix<double, 6, 1>::Zero();
    LensVector lr = LensVector::Zero();
    for (const TagDetection* tag : view.tags) {
      const WalkResidual residual(*tag, board.tags.at(tag->id));
      Residual r;
      ByPose P;
      Eigen::Matrix<double, 8, kNumbers, Eigen::RowMajor> L;
      const double* const parameters[] = {view.camera_from_board.data(), state.lens.data()};
      double* jacobians[] = {P.data(), L.data()};
      if (!residual.Evaluate(parameters, r.data(), jacobians)) continue;
      const double weight = std::min(1.0, kHuberPx / std::max(1e-12, r.norm()));
      pp += weight * P.transpose() * P;
      pl += weight * P.transpose() * L;
      ll += weight * L.transpose() * L;
      pr += weight * P.transpose() * r;
      lr += weight * L.transpose() * r;
      information.square_sum += weight * r.squaredNorm();
      information.plain_square_sum += r.squaredNorm();
      information.residuals += 8;
    }
    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(pp);
    const Eigen::Matrix<double, 6, kNumbers> pose_by_lens = -solver.solve(pl);
    information.normal += ll + pl.transpose() * pose_by_lens;
    const LensVector gradient = lr - pl.transpose() * solver.solve(pr);
    information.scatter += gradient * gradient.transpose();

    // How the distance and a height above the sheet follow the lens in this view.
    const Eigen::Isometry3d board_from_camera = to_isometry(view.camera_from_board).inverse();
    const double distance_m = board_from_camera.translation().norm();
    const Eigen::Vector3d t(view.camera_from_board[3], view.camera_from_board[4],
                            view.camera_from_board[5]);
    information.distance_by_lens += pose_by_lens.bottomRows<3>().transpose() * t /
                                    (distance_m * distance_m) /
                                    static_cast<double>(state.views.size());
    Residual unused;
    ByPose P;
    ByPose T;
    Eigen::Matrix<double, 8, 12, Eigen::RowMajor> F;
    const double* const parameters[] = {view.camera_from_board.data(), raised.data(), full.data()};
    double* jacobians[] = {P.data(), T.data(), F.data()};
    if (!raised_tag->Evaluate(parameters, unused.data(), jacobians)) continue;
    const Residual by_height = T.col(5);
    information.height_by_lens -= (F * D + P * pose_by_lens).transpose() * by_height;
    height_weight += by_height.squaredNorm();
  }
  information.height_by_lens /= std::max(1e-12, height_weight * height_m);
  return information;
}

/// Covariance of the free numbers, zero elsewhere: of each number the larger variance of the one
/// from the residuals' size and the one from how views disagree.
LensMatrix covariance_of(const Information& information, const Belief& belief, const Free& free,
                         std::size_t views) {
  std::vector<int> at;
  for (int i = 0; i < kNumbers; ++i) {
    if (free[static_cast<std::size_t>(i)]) at.push_back(i);
  }
  const auto count = static_cast<Eigen::Index>(at.size());
  Eigen::MatrixXd S(count, count), M(count, count);
  const double dof = std::max(
      1.0, information.residuals - 6.0 * static_cast<double>(views) - static_cast<double>(count));
  const double variance = information.square_sum / dof;
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      S(i, j) =
          information.normal(at[static_cast<std::size_t>(i)], at[static_cast<std::size_t>(j)]);
      M(i, j) =
          information.scatter(at[static_cast<std::size_t>(i)], at[static_cast<std::size_t>(j)]);
    }
    const double sigma = belief.sigma[static_cast<std::size_t>(at[static_cast<std::size_t>(i)])];
    S(i, i) += std::max(variance, 1e-12) / (sigma * sigma);
  }
  const Eigen::MatrixXd inverse = S.ldlt().solve(Eigen::MatrixXd::Identity(count, count));
  const double few = static_cast<double>(views) /
                     std::max(1.0, static_cast<double>(views) - static_cast<double>(count));
  const Eigen::MatrixXd by_views = few * inverse * M * inverse;
  Eigen::MatrixXd C = variance * inverse;
  Eigen::VectorXd stretch(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    stretch[i] = std::sqrt(std::max(1.0, by_views(i, i) / std::max(1e-300, C(i, i))));
  }
  C = stretch.asDiagonal() * C * stretch.asDiagonal();
  LensMatrix result = LensMatrix::Zero();
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      result(at[static_cast<std::size_t>(i)], at[static_cast<std::size_t>(j)]) = C(i, j);
    }
  }
  return result;
}

/// The focal length alone, from the start that explains most.
std::optional<State> first_state(const Board& board, const LensPrior& prior, const Belief& belief,
                                 const std::vector<std::vector<TagDetection>>& detections) {
  std::optional<State> best;
  for (const double start : kStarts) {
    State state{belief.value, {}};
    state.lens[kFocal] = std::log(start * prior.focal_px);
    state.views = pose_views(board, camera_of(state.lens, prior.size), detections);
    if (state.views.size() < kFewestWalkViews) continue;
    adjust(board, belief, {true}, state);
    // Views that one start cannot pose must not speak for it.
    state.cost /= static_cast<double>(state.views.size());
    if (std::isfinite(state.cost) && (!best || state.cost < best->cost)) best = std::move(state);
    if (prior.is_stated && best) break;
  }
  return best;
}

std::vector<std::vector<TagDetection>> spread(const std::vector<std::vector<TagDetection>>& views) {
  std::vector<std::vector<TagDetection>> useful;
  for (const auto& tags : views) {
    if (tags.size() >= 2) useful.push_back(tags);
  }
  const std::size_t count = std::min(kMostViews, useful.size());
  std::vector<std::vector<TagDetection>> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(useful[i * useful.size() / count]);
  return chosen;
}

}  // namespace

std::optional<WalkCalibration> calibrate_from_walk(
    const Board& board, const LensPrior& prior,
    const std::vector<std::vector<TagDetection>>& views) {
  // Begin with the focal length alone.
  const Belief belief = belief_of(prior);
  const auto chosen = spread(views);
  auto state = first_state(board, prior, belief, chosen);
  if (!state) return std::nullopt;
  Free free{true};

  // Try the others, group by group; keep those that the images tell from what is believed.
  WalkCalibration result;
  Lens left_open{};
  for (int group = 1; group < kGroupCount; ++group) {
    State tried = *state;
    Free tried_free = free;
    for (std::size_t i = 0; i < kNumbers; ++i) tried_free[i] |= kGroups[i] == group;
    adjust(board, belief, tried_free, tried);
    const LensMatrix covariance =
        covariance_of(measure(board, tried), belief, tried_free, tried.views.size());
    bool is_told_apart = false;
    for (std::size_t i = 0; i < kNumbers; ++i) {
      if (kGroups[i] != group) continue;
      const auto at = static_cast<Eigen::Index>(i);
      left_open[i] = std::sqrt(covariance(at, at));
      is_told_apart |= std::abs(tried.lens[i] - belief.value[i]) > kToldApart * left_open[i];
    }
    if (!is_told_apart || !std::isfinite(tried.cost)) continue;
    state = std::move(tried);
    free = tried_free;
  }

  // Say how sure it is.
  const Information information = measure(board, *state);
  const LensMatrix covariance = covariance_of(information, belief, free, state->views.size());
  result.camera = camera_of(state->lens, prior.size);
  result.views = static_cast<int>(state->views.size());
  result.rms_px = std::sqrt(2 * information.plain_square_sum / std::max(1, information.residuals));
  result.height_sigma =
      std::sqrt(information.height_by_lens.dot(covariance * information.height_by_lens));
  result.distance_sigma =
      std::sqrt(information.distance_by_lens.dot(covariance * information.distance_by_lens));
  for (std::size_t i = 0; i < kNumbers; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    WalkCalibration::Number number{kNames[i], state->lens[i],
                                   free[i] ? std::sqrt(covariance(at, at)) : left_open[i],
                                   belief.value[i], free[i]};
    if (i == kFocal) {
      number.value = std::exp(number.value);
      number.prior = prior.focal_px;
      number.sigma *= number.value;
    }
    result.numbers.push_back(number);
  }
  return result;
}

std::string find_fault(const WalkCalibration& calibration) {
  if (!(calibration.rms_px <= kMostRmsPx)) {
    return fmt::format("the tags miss their places on the sheet by {:.1f} px whatever the lens",
                       calibration.rms_px);
  }
  if (!(calibration.height_sigma <= kMostHeightSigma)) {
    return fmt::format(
        "its views do not tell the camera's focal length from its distance: heights above the "
        "sheet are uncertain by {:.0f} %",
        100 * calibration.height_sigma);
  }
  return {};
}

}  // namespace sheen::capture
