// SPDX-License-Identifier: MIT
#include "capture/synthetic/scene.h"

#include "capture/synthetic/baked_light.h"
#include "capture/synthetic/board_print.h"
#include "capture/synthetic/lighting.h"
#include "core/mesh/bounds.h"
#include "core/visibility/ray_caster.h"

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace sheen::capture::synthetic {
namespace {

constexpr double kTurnRad = 0.35;          // of the object on the board
constexpr float kPatternOfRadius = 0.18f;  // half a band over the radius of the object
constexpr float kMeanBoardReflectance = 0.5f;
constexpr float kFlattest = 1e-3f;  // of a ray that meets the board: z of its direction

Eigen::Isometry3d placed_on_board(const core::Mesh& mesh, float lift_m) {
  const Eigen::AlignedBox3f box = core::bounds_of(mesh);
  const Eigen::Vector3d foot(box.center().x(), box.center().y(), box.min().z());
  return Eigen::Translation3d(0, 0, lift_m) *
         Eigen::AngleAxisd(kTurnRad, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(-foot);
}

core::Mesh transformed(const core::Mesh& mesh, const Eigen::Isometry3f& to_from_mesh) {
  core::Mesh result = mesh;
  for (Eigen::Vector3f& p : result.positions) p = to_from_mesh * p;
  for (Eigen::Vector3f& n : result.normals) n = (to_from_mesh.linear() * n).normalized();
  return result;
}

/// Value inside a triangle from the values at its corners.
template <typename Value, typename Read>
Value inside(const core::Mesh& mesh, const core::RayHit& hit, const Read& read) {
  const auto& corners = mesh.triangles[hit.triangle_idx];
  return hit.barycentric.x() * read(corners.x()) + hit.barycentric.y() * read(corners.y()) +
         hit.barycentric.z() * read(corners.z());
}

Incident incident_at(const core::Mesh& mesh, const core::RayHit& hit,
                     const std::vector<Incident>& baked) {
  Incident incident;
  for (std::size_t box = 0; box < kSoftBoxes; ++box) {
    incident.visible[box] =
        inside<float>(mesh, hit, [&](std::uint32_t vertex) { return baked[vertex].visible[box]; });
  }
  incident.ambient_irradiance =
      inside<Eigen::Vector3f>(mesh, hit, [&](std::uint32_t vertex) -> const Eigen::Vector3f& {
        return baked[vertex].ambient_irradiance;
      });
  incident.openness =
      inside<float>(mesh, hit, [&](std::uint32_t vertex) { return baked[vertex].openness; });
  return incident;
}

}  // namespace

struct Scene::Impl {
  Impl(SceneKind kind_in, core::Mesh object_in, float lift_m, int threads)
      : kind(kind_in),
        object(std::move(object_in)),
        board_from_object(placed_on_board(object, lift_m)),
        object_from_board(board_from_object.inverse().cast<float>()),
        in_board(transformed(object, board_from_object.cast<float>())),
        bounds(core::bounds_of(in_board)),
        radius_m(0.5f * bounds.sizes().maxCoeff()),
        print(radius_m),
        caster(in_board),
        ground(studio, caster, 1.4f * print.half_width_m(), threads),
        baked(bake_incident(studio, in_board, caster, ground, kMeanBoardReflectance, threads)) {}

  [[nodiscard]] Eigen::Vector3f object_value(const core::RayHit& hit, const Eigen::Vector3f& point,
                                             const Eigen::Vector3f& direction) const;
  [[nodiscard]] Eigen::Vector3f board_value(const Eigen::Vector3f& origin,
                                            const Eigen::Vector3f& direction) const;

  SceneKind kind;
  Studio studio = product_studio();
  core::Mesh object;
  Eigen::Isometry3d board_from_object;
  Eigen::Isometry3f object_from_board;
  core::Mesh in_board;
  Eigen::AlignedBox3f bounds;
  float radius_m;
  BoardPrint print;
  core::RayCaster caster;
  GroundLight ground;
  std::vector<Incident> baked;
};

Eigen::Vector3f Scene::Impl::object_value(const core::RayHit& hit, const Eigen::Vector3f& point,
                                          const Eigen::Vector3f& direction) const {
  Eigen::Vector3f normal =
      inside<Eigen::Vector3f>(in_board, hit, [&](std::uint32_t vertex) -> const Eigen::Vector3f& {
        return in_board.normals[vertex];
      }).normalized();

  // Keep the interpolated normal on the eye's side: at the silhouette it may tip over.
  const float cosine = normal.dot(-direction);
  constexpr float least = 0.02f;
  if (cosine < least) normal = (normal - (least - cosine) * direction).normalized();

  const Brdf brdf = brdf_at(kind, object_from_board * point, kPatternOfRadius * radius_m);
  return reflected_radiance(brdf, normal, -direction, studio, incident_at(in_board, hit, baked));
}

Eigen::Vector3f Scene::Impl::board_value(const Eigen::Vector3f& origin,
                                         const Eigen::Vector3f& direction) const {
  if (direction.z() > -kFlattest) return 0.5f * room_radiance(studio, direction);
  const Eigen::Vector3f foot = origin - origin.z() / direction.z() * direction;
  return print.reflectance(foot.x(), foot.y()) / std::numbers::pi_v<float> *
         ground.irradiance(foot.x(), foot.y());
}

Scene::Scene(SceneKind kind, core::Mesh object, float lift_m, int threads) {
  assert(!object.triangles.empty() && object.normals.size() == object.positions.size());
  impl_ = std::make_unique<Impl>(kind, std::move(object), lift_m, threads);
}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

const core::Mesh& Scene::object() const {
  return impl_->object;
}
const Eigen::Isometry3d& Scene::board_from_object() const {
  return impl_->board_from_object;
}
const Board& Scene::board() const {
  return impl_->print.board();
}
double Scene::object_radius_m() const {
  return static_cast<double>(impl_->radius_m);
}
Eigen::Vector3d Scene::object_centre() const {
  return impl_->bounds.center().cast<double>();
}

Scene::Sight Scene::trace(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const {
  const Impl& scene = *impl_;
  const auto hit = scene.caster.first_hit(origin, direction, 0, std::numeric_limits<float>::max());
  const Eigen::Vector3f radiance =
      hit ? scene.object_value(*hit, origin + hit->distance * direction, direction)
          : scene.board_value(origin, direction);
  return {scene.studio.exposure * radiance, hit.has_value()};
}

float Scene::distance_m(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const {
  const auto hit = impl_->caster.first_hit(origin, direction, 0, std::numeric_limits<float>::max());
  if (hit) return hit->distance;
  return direction.z() < -kFlattest ? -origin.z() / direction.z() : 0.0f;
}

}  // namespace sheen::capture::synthetic
