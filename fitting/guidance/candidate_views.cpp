// SPDX-License-Identifier: MIT
#include "fitting/guidance/candidate_views.h"

#include "core/geometry/tangent_frame.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

namespace sheen::fitting::guidance {
namespace {

constexpr float kLowestSine = 0.1f;  // of the elevation above the board: 6 degrees
constexpr float kHighestSine = 0.99f;
constexpr float kShortestWay_rad = 0.2f;

}  // namespace

std::vector<Eigen::Vector3f> candidate_places(const Eigen::Vector3f& centre, float distance_m,
                                              const Eigen::Vector3f& up, int count) {
  const core::TangentFrame axes = core::tangent_frame(up.normalized());
  const float golden_angle = std::numbers::pi_v<float> * (3 - std::sqrt(5.0f));
  std::vector<Eigen::Vector3f> places;
  for (int i = 0; i < count; ++i) {
    // Equal steps of the sine are equal areas of the sphere.
    const float z = kLowestSine + (kHighestSine - kLowestSine) * (static_cast<float>(i) + 0.5f) /
                                      static_cast<float>(count);
    const float r = std::sqrt(1 - z * z);
    const float azimuth = golden_angle * static_cast<float>(i);
    places.emplace_back(centre +
                        distance_m * (r * std::cos(azimuth) * axes.tangent +
                                      r * std::sin(azimuth) * axes.bitangent + z * axes.normal));
  }
  return places;
}

CandidateViews::CandidateViews(const core::Mesh& mesh, const core::RayCaster& caster,
                               const core::SamplingLimits& limits,
                               std::vector<Eigen::Vector3f> places,
                               const std::function<bool()>& stop)
    : places_(std::move(places)), reachable_(mesh.positions.size(), 0) {
  const std::vector<core::TangentFrame> frames = core::tangent_frames(mesh);
  for (const Eigen::Vector3f& place : places_) {
    auto& cells = cell_.emplace_back(mesh.positions.size(), kUnseen);
    if (stop()) continue;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto direction = core::direction_towards(frames[i], mesh.positions[i], place);
      if (direction.cosine < limits.min_cosine) continue;
      if (caster.vertex_hidden(static_cast<std::uint32_t>(i), place)) continue;
      const int cell = cell_of(direction.uv);
      cells[i] = static_cast<std::uint8_t>(cell);
      reachable_[i] |= cell_bit(cell);
    }
  }
}

std::vector<double> CandidateViews::gains(const std::vector<PatchKnowledge>& patches,
                                          const std::vector<float>& unseen_direction_error,
                                          const std::vector<float>& area) const {
  std::vector<float> scale(patches.size());
  std::vector<float> before(patches.size());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const int wanted = std::max(1, std::popcount(reachable_[i]));
    scale[i] = area[i] * unseen_direction_error[i] / static_cast<float>(wanted);
    before[i] = variance_sum(patches[i].seen, reachable_[i]);
  }
  std::vector<double> gains(places_.size(), 0);
  for (std::size_t place = 0; place < places_.size(); ++place) {
    for (std::size_t i = 0; i < patches.size(); ++i) {
      const std::uint8_t cell = cell_[place][i];
      if (cell == kUnseen || before[i] == 0) continue;
      const DirectionCells seen = patches[i].seen | cell_bit(cell);
      if (seen == patches[i].seen) continue;
      gains[place] +=
          static_cast<double>(scale[i] * (before[i] - variance_sum(seen, reachable_[i])));
    }
  }
  return gains;
}

std::optional<std::size_t> next_best_view(const std::vector<Eigen::Vector3f>& places,
                                          const std::vector<double>& gains,
                                          const Eigen::Vector3f& centre,
                                          const Eigen::Vector3f& eye) {
  std::optional<std::size_t> best;
  double best_rate = 0;
  const Eigen::Vector3f here = (eye - centre).normalized();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const float cosine = std::clamp(here.dot((places[i] - centre).normalized()), -1.0f, 1.0f);
    const double rate = gains[i] / static_cast<double>(std::acos(cosine) + kShortestWay_rad);
    if (rate > best_rate) {
      best_rate = rate;
      best = i;
    }
  }
  return best;
}

}  // namespace sheen::fitting::guidance
