// SPDX-License-Identifier: MIT
#include "app/preview/drawn_part.h"

#include <cstdint>

namespace sheen::app {
namespace {

constexpr float kLensMargin = 0.03f;  // a lens bends the box's edges outwards between its corners

}  // namespace

Eigen::AlignedBox2f drawn_part(const Eigen::AlignedBox3d& box, const core::CameraModel& camera,
                               const Eigen::Isometry3d& camera_from_object) {
  const Eigen::AlignedBox2f all(Eigen::Vector2f::Zero(), Eigen::Vector2f::Ones());
  const Eigen::Array2d size_px(camera.width_px(), camera.height_px());
  Eigen::AlignedBox2f part;
  for (int i = 0; i < 8; ++i) {
    const auto corner = static_cast<Eigen::AlignedBox3d::CornerType>(i);
    const auto pixel = camera.project(camera_from_object * box.corner(corner));
    if (!pixel) return all;
    part.extend(((pixel->array() + 0.5) / size_px).matrix().cast<float>());
  }
  part.min().array() -= kLensMargin;
  part.max().array() += kLensMargin;
  return part.intersection(all);
}

void add_part(ImDrawList& list, GLuint texture, const ImVec2& corner, const ImVec2& size,
              const Eigen::AlignedBox2f& part, float strength) {
  if (part.isEmpty()) return;
  const auto place = [&](const Eigen::Vector2f& share) {
    return ImVec2(corner.x + share.x() * size.x, corner.y + share.y() * size.y);
  };
  // NOLINTNEXTLINE(performance-no-int-to-ptr): how ImGui names a texture of OpenGL.
  const auto id = reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture));
  list.AddImage(id, place(part.min()), place(part.max()), {part.min().x(), part.min().y()},
                {part.max().x(), part.max().y()}, ImGui::GetColorU32({1, 1, 1, strength}));
}

}  // namespace sheen::app
