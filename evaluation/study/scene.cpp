// SPDX-License-Identifier: MIT
#include "evaluation/study/scene.h"

#include "core/geometry/tangent_frame.h"
#include "evaluation/study/handheld_path.h"
#include "evaluation/study/lumisphere.h"
#include "evaluation/study/view_sets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace sheen::evaluation {
namespace {

using Eigen::Vector3f;

enum SceneStream : std::uint64_t {
  kScenePoint = 201,
  kSceneFrame = 202,
  kSceneNoise = 203,
  kSceneTraining = 204,
  kSceneTest = 205,
  kSceneScattered = 206
};

// Positions on the walk in its finest division: frame k of any division is one of them.
constexpr std::size_t kFinestSteps = 1u << 14;
constexpr std::size_t kTestFrames = 120;

// Scattered cameras: sine of the elevation, the heights that the walk covers.
constexpr float kLowestEye = 0.15f;
constexpr float kHighestEye = 0.95f;

// A direction of the camera as it is and as the tracker reports it.
struct Frame {
  Vector3f actual, reported;
  std::uint64_t key;
};

std::vector<Frame> walk(const HandheldOrbit& orbit, std::size_t count,
                        const SceneOptions& options) {
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t key = i * kFinestSteps / count;
    const Vector3f actual = orbit.at(static_cast<float>(key) / static_cast<float>(kFinestSteps));
    Random random(hash_of({options.seed, kSceneFrame, key}));
    // The error is a turn about the object: the frame z > 0 of with_pose_error is the camera's own.
    const core::TangentFrame camera = core::tangent_frame(actual);
    const Vector3f error = with_pose_error({0, 0, 1}, options.corruption, random);
    frames.push_back({actual, camera.in_object(error), key});
  }
  return frames;
}

MaterialClass material_of(std::size_t point) {
  constexpr std::array<MaterialClass, 10> share{
      MaterialClass::lambert, MaterialClass::ggx60,  MaterialClass::lambert, MaterialClass::ggx25,
      MaterialClass::ggx60,   MaterialClass::mix,    MaterialClass::lambert, MaterialClass::ggx60,
      MaterialClass::ggx15,   MaterialClass::lambert};
  return share[point % share.size()];
}

// Points of equal areas on the sphere, the lowest part left out.
Vector3f normal_of(std::size_t point, std::size_t count) {
  const float part = (static_cast<float>(point) + 0.5f) / static_cast<float>(count);
  const float z = 1.0f - 1.2f * part;
  const float radius = std::sqrt(1.0f - z * z);
  const float azimuth = 2.3999632f * static_cast<float>(point);  // golden angle
  return {radius * std::cos(azimuth), radius * std::sin(azimuth), z};
}

// What one point sees of training and test frames.
struct PointMaker {
  const SceneOptions& options;
  const Environment& environment;
  const std::vector<Frame>& training;
  const std::vector<Vector3f>& path_eyes;
  const std::vector<Vector3f>& scattered_eyes;

  void add(std::size_t point_idx, Scene& scene) const {
    const core::TangentFrame frame = core::tangent_frame(normal_of(point_idx, options.points));
    Eigen::Matrix3f world_from_patch;
    world_from_patch << frame.tangent, frame.bitangent, frame.normal;
    const std::uint64_t key = hash_of({options.seed, kScenePoint, point_idx});
    Random random(key);
    const MaterialClass material = material_of(point_idx);
    const Lumisphere lumisphere(random_material(material, random), world_from_patch, environment);
    const auto truth_at = [&](const Vector3f& local) {
      const Vector3f radiance = options.corruption.exposure * lumisphere.radiance(local);
      return TestSample{local.head<2>(), radiance.cwiseMin(1.0f), false};
    };
    StudyPoint along_path{material, {}, {}};
    // See the training frames.
    for (std::size_t i = 0; i < training.size(); ++i) {
      const Vector3f local = world_from_patch.transpose() * training[i].actual;
      if (local.z() < kMinCosine) continue;
      Vector3f reported = world_from_patch.transpose() * training[i].reported;
      reported.z() = std::max(reported.z(), 1e-3f);
      reported.normalize();
      Random noise(hash_of({key, kSceneNoise, training[i].key}));
      along_path.training.push_back(
          {static_cast<std::uint32_t>(i), reported.head<2>(),
           photographed(lumisphere.radiance(local), options.corruption, noise)});
    }
    // See the test frames, and scattered directions.
    StudyPoint scattered{material, along_path.training, {}};
    const auto look = [&](const std::vector<Vector3f>& eyes, StudyPoint& point) {
      for (const Vector3f& eye : eyes) {
        const Vector3f local = world_from_patch.transpose() * eye;
        if (local.z() >= kMinCosine) point.test.push_back(truth_at(local));
      }
    };
    look(path_eyes, along_path);
    look(scattered_eyes, scattered);
    scene.path.points.push_back(std::move(along_path));
    scene.scattered.points.push_back(std::move(scattered));
  }
};

// Part of the frames of the finest walk that a point sees, averaged over the points.
double visible_fraction(const HandheldOrbit& orbit, std::size_t points) {
  constexpr std::size_t steps = 256;
  std::size_t seen = 0;
  for (std::size_t step = 0; step < steps; ++step) {
    const Vector3f eye = orbit.at(static_cast<float>(step) / static_cast<float>(steps));
    for (std::size_t point = 0; point < points; ++point) {
      seen += normal_of(point, points).dot(eye) >= kMinCosine ? 1 : 0;
    }
  }
  return static_cast<double>(seen) / static_cast<double>(steps * points);
}

}  // namespace

Scene make_scene(const SceneOptions& options, const Environment& environment) {
  // Walk around the object: training in three rounds, tests in one and a half on another height.
  const HandheldOrbit training_orbit(hash_of({options.seed, kSceneTraining}), 0.15f, 1.2f, 3.0f);
  const HandheldOrbit test_orbit(hash_of({options.seed, kSceneTest}), 0.9f, 0.3f, 1.5f);
  const double fraction = visible_fraction(training_orbit, options.points);
  const auto frame_count = static_cast<std::size_t>(
      std::lround(static_cast<double>(options.samples_per_point) / fraction));
  const std::vector<Frame> training = walk(training_orbit, frame_count, options);
  std::vector<Vector3f> path_eyes;
  std::vector<Vector3f> scattered_eyes;
  for (std::size_t i = 0; i < kTestFrames; ++i) {
    path_eyes.push_back(test_orbit.at(static_cast<float>(i) / static_cast<float>(kTestFrames)));
    Random random(hash_of({options.seed, kSceneScattered, i}));
    scattered_eyes.push_back(random.on_sphere(kLowestEye, kHighestEye));
  }
  // Let every point look.
  Scene scene{{"scene-path", frame_count, {}}, {"scene-scattered", frame_count, {}}};
  const PointMaker maker{options, environment, training, path_eyes, scattered_eyes};
  for (std::size_t i = 0; i < options.points; ++i) maker.add(i, scene);
  return scene;
}

}  // namespace sheen::evaluation
