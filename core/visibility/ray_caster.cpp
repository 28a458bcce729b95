// SPDX-License-Identifier: MIT
#include "core/visibility/ray_caster.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <stdexcept>
#include <type_traits>

namespace sheen::core {
namespace {

template <auto release>
struct Releaser {
  template <typename T>
  void operator()(T* handle) const {
    release(handle);
  }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Releaser<rtcReleaseDevice>>;
using Scene = std::unique_ptr<std::remove_pointer_t<RTCScene>, Releaser<rtcReleaseScene>>;
using Geometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, Releaser<rtcReleaseGeometry>>;

RTCRay make_ray(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float near,
                float far) {
  RTCRay ray{};
  ray.org_x = origin.x();
  ray.org_y = origin.y();
  ray.org_z = origin.z();
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.tnear = near;
  ray.tfar = far;
  ray.mask = 0xffffffffu;
  return ray;
}

/// Embree allows reads of 16 bytes at every vertex, so its own buffers (which are padded) are used.
template <typename Element, typename Source>
const Element* upload(RTCGeometry geometry, RTCBufferType type, RTCFormat format,
                      const Source& source) {
  auto* buffer = static_cast<Element*>(rtcSetNewGeometryBuffer(
      geometry, type, 0, format, sizeof(Element), std::max<std::size_t>(source.size(), 1)));
  if (buffer == nullptr) throw std::runtime_error("no memory for the ray casting hierarchy");
  std::copy(source.begin(), source.end(), buffer);
  return buffer;
}

}  // namespace

struct RayCaster::Impl {
  Device device;
  Scene scene;
  const Eigen::Vector3f* positions = nullptr;  ///< in the scene's buffer
  const Eigen::Matrix<std::uint32_t, 3, 1>* triangles = nullptr;
  float bias_m = 0;
};

namespace {

using Triangle = Eigen::Matrix<std::uint32_t, 3, 1>;

/// One question "who hides this vertex", as the filter sees it.
struct HidingQuery {
  RTCIntersectContext context;  // first, so that a pointer to it is a pointer to the query
  const Eigen::Vector3f* positions;
  const Triangle* triangles;
  Eigen::Vector3f vertex;
};

/// Refuses triangles seen from behind by the eye and those around the vertex. A line meets the
/// plane of a triangle around the vertex at the vertex only, so refusing them loses nothing, and a
/// vertex in a crease is still hidden by the next triangle of the wall beside it. Corners are
/// compared by position: the other half of a hard edge is around the vertex, too.
void refuse_what_cannot_hide(const RTCFilterFunctionNArguments* arguments) {
  const auto* query = reinterpret_cast<const HidingQuery*>(arguments->context);
  const auto* hit = reinterpret_cast<const RTCHit*>(arguments->hit);
  const auto* ray = reinterpret_cast<const RTCRay*>(arguments->ray);
  const float towards_eye =
      hit->Ng_x * ray->dir_x + hit->Ng_y * ray->dir_y + hit->Ng_z * ray->dir_z;
  const Triangle& triangle = query->triangles[hit->primID];
  const bool around_vertex = std::any_of(
      triangle.begin(), triangle.end(),
      [query](std::uint32_t corner) { return query->positions[corner] == query->vertex; });
  if (!(towards_eye > 0.0f) || around_vertex) arguments->valid[0] = 0;
}

float bounding_diagonal(const Mesh& mesh) {
  if (mesh.positions.empty()) return 0.0f;
  Eigen::Vector3f low = mesh.positions.front();
  Eigen::Vector3f high = low;
  for (const Eigen::Vector3f& position : mesh.positions) {
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }
  return (high - low).norm();
}

}  // namespace

RayCaster::RayCaster(const Mesh& mesh) : impl_(std::make_unique<Impl>()) {
  impl_->device.reset(rtcNewDevice(nullptr));
  if (!impl_->device) throw std::runtime_error("Embree finds no usable processor");
  const RTCDevice device = impl_->device.get();

  // Hand the triangles over.
  const Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  impl_->positions = upload<Eigen::Vector3f>(geometry.get(), RTC_BUFFER_TYPE_VERTEX,
                                             RTC_FORMAT_FLOAT3, mesh.positions);
  impl_->triangles =
      upload<Triangle>(geometry.get(), RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
  rtcCommitGeometry(geometry.get());

  // Build the hierarchy; robust, so that no ray slips between two triangles.
  impl_->scene.reset(rtcNewScene(device));
  rtcSetSceneFlags(
      impl_->scene.get(),
      static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  if (!mesh.triangles.empty()) rtcAttachGeometry(impl_->scene.get(), geometry.get());
  rtcCommitScene(impl_->scene.get());
  impl_->bias_m = 1e-4f * bounding_diagonal(mesh);
}

RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

std::optional<RayHit> RayCaster::first_hit(const Eigen::Vector3f& origin,
                                           const Eigen::Vector3f& direction, float near,
                                           float far) const {
  RTCRayHit query{};
  query.ray = make_ray(origin, direction, near, far);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(impl_->scene.get(), &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const Eigen::Vector3f normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
  return RayHit{.distance = query.ray.tfar,
                .triangle_idx = query.hit.primID,
                .barycentric = {1.0f - query.hit.u - query.hit.v, query.hit.u, query.hit.v},
                .front_face = normal.dot(direction) < 0.0f};
}

bool RayCaster::occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                         float near, float far) const {
  RTCRay ray = make_ray(origin, direction, near, far);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(impl_->scene.get(), &context, &ray);
  return ray.tfar < 0.0f;
}

bool RayCaster::vertex_hidden(std::uint32_t vertex_idx, const Eigen::Vector3f& eye) const {
  HidingQuery query{{}, impl_->positions, impl_->triangles, impl_->positions[vertex_idx]};
  rtcInitIntersectContext(&query.context);
  query.context.filter = refuse_what_cannot_hide;
  const Eigen::Vector3f towards_eye = eye - query.vertex;
  const float distance_m = towards_eye.norm();
  if (!(distance_m > impl_->bias_m)) return false;
  RTCRay ray = make_ray(query.vertex, towards_eye, impl_->bias_m / distance_m, 1.0f);
  rtcOccluded1(impl_->scene.get(), &query.context, &ray);
  return ray.tfar < 0.0f;
}

}  // namespace sheen::core
