// SPDX-License-Identifier: MIT
#include "pipeline/evidence/print_evidence.h"

#include "core/alignment/projection_derivative.h"
#include "core/alignment/select_points.h"
#include "core/geometry/tangent_frame.h"
#include "core/numerics/median.h"

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace sheen::pipeline {
namespace {

constexpr std::size_t kMostVertices = 800;
constexpr std::size_t kMostViews = 32, kViewSpacing = 2;
constexpr double kSharp_px = 1, kSmooth_px = 3;
constexpr int kRegionMargin_px = 12;
constexpr float kLeastCosine = 0.35f;
constexpr int kSaturated = 240;  // green; highlights move with the view
constexpr std::size_t kFewestVertexViews = 8, kFewestEachSide = 3, kFewestVertices = 50;
constexpr std::size_t kFewestViewsEachSide = 5;
constexpr double kOwnRidge = 1e-3, kNoise = 1e-6;  // of sums of numbers of size 1; of luma, squared
constexpr double kLeastUpright = 0.2;  // of the samples on one side, what slopes do not explain
constexpr int kRounds = 8;
// Honest recordings show at most .6 px, or more with at most six standard deviations
// (docs/stability-sessions.md).
constexpr double kSeen_px = 0.8, kSeenCertainty = 10;

/// Normal equations of the shift by one vertex.
struct ShiftSystem {
  Eigen::Matrix3d H;
  Eigen::Vector3d g;
};

/// What disagrees by far, for its weight, counts less.
double robust_weight(const ShiftSystem& system, const Eigen::Vector3d& shift_m, double scale) {
  const double off =
      (system.g - system.H * shift_m).norm() / std::sqrt(system.H.trace()) / (2 * scale);
  return 1 / (1 + off * off);
}

double scale_of(const std::vector<ShiftSystem>& systems, const Eigen::Vector3d& shift_m) {
  std::vector<double> off;
  for (const ShiftSystem& system : systems) {
    off.push_back((system.g - system.H * shift_m).norm() / std::sqrt(system.H.trace()));
  }
  return std::max(1.4826 * core::upper_median(off), 1e-12);
}

}  // namespace

/// A vertex that enough views show, its own value and slope taken out.
struct PrintEvidence::Vertex {
  std::vector<std::size_t> views;         ///< by position, ascending
  Eigen::MatrixXd own;                    ///< of each view: 1 and its slope
  Eigen::LDLT<Eigen::Matrix3d> solver{};  ///< of the own terms
  Eigen::VectorXd left;                   ///< what they leave of the values
  double variance = 0;                    ///< of that, luma squared
  Eigen::Vector3d gradient_per_m;         ///< mean of the views, object frame

  /// What the own terms leave of a column with a number per view.
  [[nodiscard]] Eigen::VectorXd without_own(const Eigen::VectorXd& column) const {
    return column - own * solver.solve(own.transpose() * column);
  }
};

PrintEvidence::PrintEvidence(const core::Mesh& mesh)
    : mesh_(mesh),
      spacing_(1 + mesh.positions.size() / kMostVertices),
      views_(kMostViews, kViewSpacing) {}

void PrintEvidence::look_at(int frame_index, const cv::Mat& image, const core::VertexView& view,
                            const core::CameraModel& camera,
                            const Eigen::Isometry3d& camera_from_object) {
  if (!views_.is_due()) return;
  View kept;
  kept.frame_index = frame_index;
  const auto region = core::visible_region(view, kRegionMargin_px);
  if (!region) {
    views_.add(std::move(kept));
    return;
  }
  sharp_.look_at(image, *region, kSharp_px);
  const core::GradientImage smooth =
      sharp_.smoothed(std::sqrt(kSmooth_px * kSmooth_px - kSharp_px * kSharp_px));
  double px_per_m = 0;
  for (std::size_t i = 0; i < mesh_.positions.size(); i += spacing_) {
    const float cosine =
        std::sqrt(std::max(0.0f, 1 - view.u[i] * view.u[i] - view.v[i] * view.v[i]));
    if (view.rejection[i] != core::VertexRejection::none || cosine < kLeastCosine) continue;
    const auto seen = core::project_with_derivative(
        camera, camera_from_object * mesh_.positions[i].cast<double>());
    if (!seen) continue;
    const auto sharp = sharp_.read(seen->pixel), blurred = smooth.read(seen->pixel);
    if (!sharp || !blurred) continue;
    const Eigen::Vector2i px = seen->pixel.array().round().cast<int>();
    if (image.at<cv::Vec3b>(px.y(), px.x())[1] > kSaturated) continue;
    const core::TangentFrame frame = core::tangent_frame(mesh_.normals[i]);
    const Eigen::Matrix<double, 2, 3> px_by_place =
        seen->pixel_by_point * camera_from_object.linear();
    const Eigen::RowVector3d by_place =
        (sharp->gradient - blurred->gradient).transpose() * px_by_place;
    kept.samples.push_back(
        {static_cast<std::uint32_t>(i), static_cast<float>(sharp->value - blurred->value),
         Eigen::Vector2f(view.u[i], view.v[i]) / cosine,
         Eigen::Vector2f(static_cast<float>(by_place * frame.tangent.cast<double>()),
                         static_cast<float>(by_place * frame.bitangent.cast<double>()))});
    px_per_m += px_by_place.norm() / std::sqrt(2.0);
  }
  if (!kept.samples.empty()) kept.px_per_m = px_per_m / static_cast<double>(kept.samples.size());
  views_.add(std::move(kept));
}

std::vector<PrintEvidence::Vertex> PrintEvidence::vertices() const {
  std::map<std::uint32_t, std::vector<std::pair<std::size_t, const Sample*>>> seen;
  for (std::size_t v = 0; v < views_.items().size(); ++v) {
    for (const Sample& sample : views_.items()[v].samples) {
      seen[sample.vertex_idx].emplace_back(v, &sample);
    }
  }
  std::vector<Vertex> vertices;
  for (const auto& [vertex_idx, samples] : seen) {
    if (samples.size() < kFewestVertexViews) continue;
    const auto rows = static_cast<Eigen::Index>(samples.size());
    Vertex vertex;
    vertex.own.resize(rows, 3);
    Eigen::VectorXd values(rows);
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    for (Eigen::Index row = 0; row < rows; ++row) {
      const auto& [view, sample] = samples[static_cast<std::size_t>(row)];
      vertex.views.push_back(view);
      vertex.own.row(row) << 1, sample->slope.cast<double>().transpose();
      values[row] = static_cast<double>(sample->value);
      gradient += sample->gradient.cast<double>() / static_cast<double>(rows);
    }
    const Eigen::Matrix3d N =
        vertex.own.transpose() * vertex.own + kOwnRidge * Eigen::Matrix3d::Identity();
    vertex.solver.compute(N);
    vertex.left = vertex.without_own(values);
    vertex.variance = vertex.left.squaredNorm() / static_cast<double>(rows - 3) + kNoise;
    const core::TangentFrame frame = core::tangent_frame(mesh_.normals[vertex_idx]);
    vertex.gradient_per_m =
        gradient.x() * frame.tangent.cast<double>() + gradient.y() * frame.bitangent.cast<double>();
    if (vertex.gradient_per_m.squaredNorm() > 0) vertices.push_back(std::move(vertex));
  }
  return vertices;
}

/// The shift that sets in with the view at position `split`.
PrintEvidence::Jump PrintEvidence::jump_at(std::size_t split,
                                           const std::vector<Vertex>& vertices) const {
  // The object moved by d shows at a place what was d before it: less the gradient along d.
  std::vector<ShiftSystem> systems;
  for (const Vertex& vertex : vertices) {
    const auto first_after = std::ranges::lower_bound(vertex.views, split);
    const auto before = static_cast<std::size_t>(first_after - vertex.views.begin());
    if (before < kFewestEachSide || vertex.views.size() - before < kFewestEachSide) continue;
    Eigen::VectorXd is_after = Eigen::VectorXd::Zero(vertex.left.size());
    is_after.tail(vertex.left.size() - static_cast<Eigen::Index>(before)).setOnes();
    const Eigen::VectorXd column = vertex.without_own(is_after);
    const double upright = column.squaredNorm();
    if (upright < kLeastUpright) continue;
    const Eigen::Vector3d& gradient = vertex.gradient_per_m;
    systems.push_back({gradient * gradient.transpose() * (upright / vertex.variance),
                       -gradient * (column.dot(vertex.left) / vertex.variance)});
  }
  Jump jump{.frame_index = views_.items()[split].frame_index};
  if (systems.size() < kFewestVertices) return jump;

  // Least squares, reweighted; how it scatters follows from how vertices disagree.
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  for (int round = 0; round < kRounds; ++round) {
    const double scale = scale_of(systems, jump.shift_m);
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero(), scatter = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    for (const ShiftSystem& system : systems) {
      const double weight = robust_weight(system, jump.shift_m, scale);
      const Eigen::Vector3d off = weight * (system.g - system.H * jump.shift_m);
      H += weight * system.H;
      g += weight * system.g;
      scatter += off * off.transpose();
    }
    H.diagonal().array() += 1e-9 * H.trace();
    scatter.diagonal().array() += 1e-9 * scatter.trace();
    jump.shift_m = H.ldlt().solve(g);
    information = H * scatter.ldlt().solve(H);
  }
  jump.certainty = std::sqrt(std::max(0.0, jump.shift_m.dot(information * jump.shift_m)));
  return jump;
}

std::optional<PrintEvidence::Jump> PrintEvidence::jump() const {
  const auto& views = views_.items();
  const std::vector<Vertex> seen = vertices();
  std::optional<Jump> best;
  for (std::size_t split = kFewestViewsEachSide; split + kFewestViewsEachSide <= views.size();
       ++split) {
    const Jump found = jump_at(split, seen);
    if (found.certainty > 0 && (!best || found.certainty > best->certainty)) best = found;
  }
  if (!best) return best;
  std::vector<double> px_per_m;
  for (const View& view : views) px_per_m.push_back(view.px_per_m);
  best->shift_px = best->shift_m.norm() * core::upper_median(px_per_m);
  return best;
}

std::vector<Finding> PrintEvidence::findings() const {
  const auto moved = jump();
  if (!moved || moved->shift_px < kSeen_px || moved->certainty < kSeenCertainty) return {};
  return {{"object-moved",
           fmt::format("the object moved on the board by {:.1f} mm ({:.1f} px) about frame {}, or "
                       "the board's tags did: its print is elsewhere from there on; record it "
                       "again, or replay one part (--start, --end)",
                       1000 * moved->shift_m.norm(), moved->shift_px, moved->frame_index)}};
}

}  // namespace sheen::pipeline
