// SPDX-License-Identifier: MIT
#include "capture/synthetic/baked_light.h"

#include "core/concurrency/parallel_for.h"
#include "core/geometry/tangent_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace sheen::capture::synthetic {
namespace {

constexpr float kGoldenAngle = 2.39996323f;
constexpr float kFar = std::numeric_limits<float>::max();
constexpr float kSurfaceOffset = 2e-4f;  // metres; a fifth of a millimetre clears rounding
constexpr int kConeRays = 32;
constexpr int kRoomRays = 192;
/// What a ray that ends on the object brings back, as a share of the room's mean radiance.
constexpr float kObjectShare = 0.25f;

using Cone = std::array<Eigen::Vector3f, kConeRays>;

/// Directions spread evenly over a soft box (a spiral of constant density over the disc).
Cone cone_directions(const SoftBox& box) {
  const core::TangentFrame frame = core::tangent_frame(box.towards);
  Cone directions;
  for (int i = 0; i < kConeRays; ++i) {
    const auto step = static_cast<float>(i);
    const float radius = std::tan(box.radius_rad) * std::sqrt((step + 0.5f) / kConeRays);
    const float angle = kGoldenAngle * step;
    directions[static_cast<std::size_t>(i)] =
        (box.towards +
         radius * (std::cos(angle) * frame.tangent + std::sin(angle) * frame.bitangent))
            .normalized();
  }
  return directions;
}

/// Directions spread evenly over the whole sphere.
std::array<Eigen::Vector3f, kRoomRays> sphere_directions() {
  std::array<Eigen::Vector3f, kRoomRays> directions;
  for (int i = 0; i < kRoomRays; ++i) {
    const auto step = static_cast<float>(i);
    const float z = 1 - (2 * step + 1) / kRoomRays;
    const float radius = std::sqrt(1 - z * z);
    const float angle = kGoldenAngle * step;
    directions[static_cast<std::size_t>(i)] = {radius * std::cos(angle), radius * std::sin(angle),
                                               z};
  }
  return directions;
}

/// Looks from points of surfaces at soft boxes and room.
class Probe {
 public:
  Probe(const Studio& studio, const core::RayCaster& caster) : studio_(studio), caster_(caster) {
    for (std::size_t i = 0; i < kSoftBoxes; ++i) cones_[i] = cone_directions(studio.boxes[i]);
  }

  /// `board_radiance(point, direction)` is what a ray that goes down and misses the object sees.
  template <typename BoardRadiance>
  Incident look(const Eigen::Vector3f& point, const Eigen::Vector3f& normal,
                const BoardRadiance& board_radiance) const {
    const Eigen::Vector3f origin = point + kSurfaceOffset * normal;
    Incident incident;
    for (std::size_t i = 0; i < kSoftBoxes; ++i)
      incident.visible[i] = seen_share(i, origin, normal);

    // Sum the room over the hemisphere; the cosines sum to pi only roughly, so divide by their sum.
    float cosines = 0;
    float open = 0;
    const Eigen::Vector3f object_radiance =
        kObjectShare * 0.5f * (studio_.zenith + studio_.horizon);
    for (const Eigen::Vector3f& direction : sphere_) {
      const float cosine = normal.dot(direction);
      if (cosine <= 0) continue;
      cosines += cosine;
      if (caster_.occluded(origin, direction, 0, kFar)) {
        incident.ambient_irradiance += cosine * object_radiance;
        continue;
      }
      open += cosine;
      incident.ambient_irradiance +=
          cosine * (direction.z() < 0 ? board_radiance(origin, direction)
                                      : room_radiance(studio_, direction));
    }
    incident.ambient_irradiance *= std::numbers::pi_v<float> / cosines;
    incident.openness = open / cosines;
    return incident;
  }

 private:
  float seen_share(std::size_t box_idx, const Eigen::Vector3f& origin,
                   const Eigen::Vector3f& normal) const {
    int seen = 0;
    for (const Eigen::Vector3f& direction : cones_[box_idx]) {
      if (normal.dot(direction) > 0 && !caster_.occluded(origin, direction, 0, kFar)) ++seen;
    }
    return static_cast<float>(seen) / kConeRays;
  }

  const Studio& studio_;
  const core::RayCaster& caster_;
  std::array<Cone, kSoftBoxes> cones_;
  std::array<Eigen::Vector3f, kRoomRays> sphere_ = sphere_directions();
};

/// Irradiance of a horizontal plane: every box by its share and the cosine, and the room.
Eigen::Vector3f on_ground(const Studio& studio, const Incident& incident) {
  Eigen::Vector3f sum = incident.ambient_irradiance;
  for (std::size_t i = 0; i < kSoftBoxes; ++i) {
    sum += incident.visible[i] * studio.boxes[i].towards.z() * studio.boxes[i].irradiance;
  }
  return sum;
}

}  // namespace

GroundLight::GroundLight(const Studio& studio, const core::RayCaster& object, float half_width_m,
                         int threads)
    : half_width_m_(half_width_m), grid_(std::size_t{kPoints} * kPoints) {
  const Probe probe(studio, object);
  const Eigen::Vector3f up = Eigen::Vector3f::UnitZ();
  const auto nothing_below = [](const Eigen::Vector3f&, const Eigen::Vector3f&) {
    return Eigen::Vector3f::Zero().eval();
  };

  // A point far aside knows the light without the object.
  const Eigen::Vector3f aside(1e3f * half_width_m, 1e3f * half_width_m, 0);
  unshadowed_ = on_ground(studio, probe.look(aside, up, nothing_below));

  core::parallel_for(grid_.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const float step = 2 * half_width_m_ / (kPoints - 1);
      const Eigen::Vector3f point(static_cast<float>(i % kPoints) * step - half_width_m_,
                                  static_cast<float>(i / kPoints) * step - half_width_m_, 0);
      grid_[i] = on_ground(studio, probe.look(point, up, nothing_below));
    }
  });
}

Eigen::Vector3f GroundLight::irradiance(float x, float y) const {
  const float scale = (kPoints - 1) / (2 * half_width_m_);
  const float column = (x + half_width_m_) * scale;
  const float row = (y + half_width_m_) * scale;
  constexpr float last = kPoints - 1;
  if (!(column >= 0 && row >= 0 && column < last && row < last)) return unshadowed_;
  const auto i = static_cast<std::size_t>(column);
  const auto j = static_cast<std::size_t>(row);
  const float fx = column - static_cast<float>(i);
  const float fy = row - static_cast<float>(j);
  const Eigen::Vector3f* corner = &grid_[j * kPoints + i];
  return (1 - fy) * ((1 - fx) * corner[0] + fx * corner[1]) +
         fy * ((1 - fx) * corner[kPoints] + fx * corner[kPoints + 1]);
}

std::vector<Incident> bake_incident(const Studio& studio, const core::Mesh& object,
                                    const core::RayCaster& caster, const GroundLight& ground,
                                    float board_reflectance, int threads) {
  const Probe probe(studio, caster);
  const auto board_radiance = [&](const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) {
    const Eigen::Vector3f foot = origin - origin.z() / direction.z() * direction;
    return Eigen::Vector3f(board_reflectance / std::numbers::pi_v<float> * ground.irradiance(foot.x(), foot.y()));
  };
  std::vector<Incident> incident(object.positions.size());
  core::parallel_for(incident.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      incident[i] = probe.look(object.positions[i], object.normals[i], board_radiance);
    }
  });
  return incident;
}

}  // namespace sheen::capture::synthetic
