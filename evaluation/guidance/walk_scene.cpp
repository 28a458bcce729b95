// SPDX-License-Identifier: MIT
#include "evaluation/guidance/walk_scene.h"

#include "core/samples/vertex_view.h"
#include "evaluation/study/random.h"

#include <cmath>
#include <numbers>

namespace sheen::evaluation {
namespace {

constexpr int kSectors = 48;  // round the ring
constexpr int kSides = 24;    // round its tube
constexpr int kSegments = 6;  // of one material each
constexpr float kRing_m = 1.0f;
constexpr float kTube_m = 0.45f;
constexpr float kNoise = 0.01f;

core::Mesh ring() {
  core::Mesh mesh;
  constexpr float turn = 2 * std::numbers::pi_v<float>;
  for (int i = 0; i < kSectors; ++i) {
    for (int j = 0; j < kSides; ++j) {
      const float a = turn * static_cast<float>(i) / kSectors;
      const float b = turn * static_cast<float>(j) / kSides;
      const Eigen::Vector3f normal(std::cos(b) * std::cos(a), std::cos(b) * std::sin(a),
                                   std::sin(b));
      mesh.normals.push_back(normal);
      mesh.positions.emplace_back(Eigen::Vector3f(kRing_m * std::cos(a), kRing_m * std::sin(a), 0) +
                                  kTube_m * normal);
    }
  }
  const auto vertex = [](int i, int j) {
    return static_cast<std::uint32_t>((i % kSectors) * kSides + j % kSides);
  };
  for (int i = 0; i < kSectors; ++i) {
    for (int j = 0; j < kSides; ++j) {
      mesh.triangles.emplace_back(vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1));
      mesh.triangles.emplace_back(vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
  }
  return mesh;
}

}  // namespace

WalkScene::WalkScene(std::uint64_t seed)
    : mesh_(ring()), caster_(mesh_), frames_(core::tangent_frames(mesh_)) {
  constexpr std::array materials{MaterialClass::lambert, MaterialClass::ggx25,
                                 MaterialClass::ggx60,   MaterialClass::ggx15,
                                 MaterialClass::mix,     MaterialClass::ggx40};
  static_assert(materials.size() == kSegments);
  std::vector<Material> made;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    Random random(hash_of({seed, i}));
    made.push_back(random_material(materials[i], random));
  }
  const Environment environment = studio_environment();
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    Eigen::Matrix3f world_from_patch;
    world_from_patch << frames_[i].tangent, frames_[i].bitangent, frames_[i].normal;
    const std::size_t sector = i / kSides;
    radiance_.emplace_back(made[sector * kSegments / kSectors], world_from_patch, environment);
  }
}

std::vector<WalkScene::Sight> WalkScene::sights(const Eigen::Vector3f& eye) const {
  const core::SamplingLimits limits;
  std::vector<Sight> sights;
  for (std::uint32_t i = 0; i < mesh_.positions.size(); ++i) {
    const auto direction = core::direction_towards(frames_[i], mesh_.positions[i], eye);
    if (direction.cosine < limits.min_cosine || caster_.vertex_hidden(i, eye)) continue;
    const Eigen::Vector3f view(direction.uv.x(), direction.uv.y(), direction.cosine);
    sights.push_back({i, direction.uv, radiance_[i].radiance(view).cwiseMax(0.0f).cwiseMin(1.0f)});
  }
  return sights;
}

core::SampleBatch WalkScene::look(const Eigen::Vector3f& eye, std::uint64_t key) const {
  Random random(key);
  core::SampleBatch batch;
  for (const Sight& sight : sights(eye)) {
    const auto noisy = [&](float value) {
      return std::clamp(value + kNoise * random.normal(), 0.0f, 1.0f);
    };
    batch.patch.push_back(sight.vertex_idx);
    batch.u.push_back(sight.uv.x());
    batch.v.push_back(sight.uv.y());
    batch.r.push_back(noisy(sight.colour.x()));
    batch.g.push_back(noisy(sight.colour.y()));
    batch.b.push_back(noisy(sight.colour.z()));
  }
  return batch;
}

std::vector<WalkScene::VertexError> WalkScene::errors(const fitting::PatchLightField& model,
                                                      const Eigen::Vector3f& eye) const {
  std::vector<VertexError> errors;
  for (const Sight& sight : sights(eye)) {
    const Eigen::Vector3f shown =
        model.evaluate(sight.vertex_idx, sight.uv).colour().cwiseMax(0.0f).cwiseMin(1.0f);
    errors.push_back({sight.vertex_idx, sight.uv,
                      static_cast<double>((shown - sight.colour).squaredNorm() / 3)});
  }
  return errors;
}

}  // namespace sheen::evaluation
