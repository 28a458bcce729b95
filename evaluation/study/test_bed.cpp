// SPDX-License-Identifier: MIT
#include "evaluation/study/test_bed.h"

#include "core/geometry/tangent_frame.h"
#include "evaluation/study/lumisphere.h"

#include <cmath>
#include <numbers>

namespace sheen::evaluation {
namespace {

using Eigen::Vector3f;

enum TestBedStream : std::uint64_t { kPoint = 101, kViews = 102, kNoise = 103 };

// A random frame: normals that look up or sideways, tangents turned at random.
Eigen::Matrix3f random_frame(Random& random) {
  const core::TangentFrame frame = core::tangent_frame(random.on_sphere(-0.3f));
  const float turn = random.uniform(0.0f, 2.0f * std::numbers::pi_v<float>);
  Eigen::Matrix3f world_from_patch;
  world_from_patch.col(0) = std::cos(turn) * frame.tangent + std::sin(turn) * frame.bitangent;
  world_from_patch.col(1) = frame.normal.cross(world_from_patch.col(0));
  world_from_patch.col(2) = frame.normal;
  return world_from_patch;
}

struct PointKey {
  MaterialClass material;
  std::uint64_t hash;
};

std::vector<PointKey> point_keys(const TestBedOptions& options) {
  std::vector<PointKey> keys;
  for (const MaterialClass material : options.materials) {
    for (std::uint64_t i = 0; i < options.points_per_material; ++i) {
      keys.push_back({material, hash_of({options.seed, static_cast<std::uint64_t>(material), i})});
    }
  }
  return keys;
}

Lumisphere lumisphere_of(const PointKey& key, const Environment& environment) {
  Random random(hash_of({key.hash, kPoint}));
  const Eigen::Matrix3f frame = random_frame(random);
  return {random_material(key.material, random), frame, environment};
}

StudyPoint make_point(const PointKey& key, const TestBedOptions& options,
                      const Environment& environment) {
  const Lumisphere lumisphere = lumisphere_of(key, environment);
  StudyPoint point{key.material, {}, {}};
  const std::uint64_t view_seed = hash_of({key.hash, kViews});
  std::uint32_t frame_idx = 0;
  for (const View& view : make_views(options.views, options.training_views, view_seed)) {
    Random random(hash_of({key.hash, kNoise, view.key}));
    const Vector3f reported = with_pose_error(view.direction, options.corruption, random);
    const Vector3f colour =
        photographed(lumisphere.radiance(view.direction), options.corruption, random);
    point.training.push_back({frame_idx++, reported.head<2>(), colour});
  }
  for (const Vector3f& direction : test_directions(options.test_views, view_seed)) {
    const Vector3f truth = options.corruption.exposure * lumisphere.radiance(direction);
    point.test.push_back({direction.head<2>(), truth.cwiseMin(1.0f), in_gap(direction)});
  }
  return point;
}

}  // namespace

StudySet make_test_bed(const TestBedOptions& options, const Environment& environment) {
  StudySet set{std::string(name_of(options.views)), options.training_views, {}};
  for (const PointKey& key : point_keys(options)) {
    set.points.push_back(make_point(key, options, environment));
  }
  return set;
}

double clamped_fraction(const TestBedOptions& options, const Environment& environment) {
  std::size_t clamped = 0;
  std::size_t count = 0;
  for (const PointKey& key : point_keys(options)) {
    const Lumisphere lumisphere = lumisphere_of(key, environment);
    const std::uint64_t view_seed = hash_of({key.hash, kViews});
    for (const View& view : make_views(options.views, options.training_views, view_seed)) {
      const Vector3f radiance = options.corruption.exposure * lumisphere.radiance(view.direction);
      clamped += radiance.maxCoeff() >= 1.0f ? 1 : 0;
      ++count;
    }
  }
  return static_cast<double>(clamped) / static_cast<double>(count);
}

}  // namespace sheen::evaluation
