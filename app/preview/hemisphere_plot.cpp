// SPDX-License-Identifier: MIT
#include "app/preview/hemisphere_plot.h"

#include "app/preview/theme.h"

#include <algorithm>

namespace sheen::app {
namespace {

namespace guidance = fitting::guidance;

struct Disc {
  ImDrawList& list;
  ImVec2 centre;
  float radius;

  [[nodiscard]] ImVec2 at(float u, float v) const {
    return {centre.x + radius * u, centre.y - radius * v};
  }
};

Disc reserve_disc(float diameter) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({diameter, diameter});
  const float radius = 0.5f * diameter;
  return {*ImGui::GetWindowDrawList(), {corner.x + radius, corner.y + radius}, radius - 1};
}

void finish(const Disc& disc, const std::optional<Eigen::Vector2f>& present) {
  disc.list.AddCircle(disc.centre, disc.radius, ImGui::GetColorU32(theme::kQuiet), 64);
  if (!present) return;
  const ImVec2 place = disc.at(present->x(), present->y());
  disc.list.AddCircleFilled(place, 0.045f * disc.radius + 2,
                            ImGui::GetColorU32(theme::kBackground));
  disc.list.AddCircleFilled(place, 0.045f * disc.radius, ImGui::GetColorU32(theme::kText));
}

}  // namespace

void plot_directions(guidance::DirectionCells seen, guidance::DirectionCells reachable,
                     const std::optional<Eigen::Vector2f>& present, float diameter) {
  const Disc disc = reserve_disc(diameter);
  constexpr float half = 1.0f / guidance::kCellsPerSide;
  constexpr float gap = 0.88f;
  for (int cell = 0; cell < guidance::kCellCount; ++cell) {
    const guidance::DirectionCells bit = guidance::cell_bit(cell);
    if (((guidance::disc_cells() | seen | reachable) & bit) == 0) continue;
    const Eigen::Vector2f middle = guidance::centre_of(cell);
    const ImVec4 colour = (seen & bit) != 0        ? theme::kAccent
                          : (reachable & bit) != 0 ? theme::kAlarm
                                                   : theme::kRaised;
    const float strength = (seen & bit) != 0 ? 0.9f : (reachable & bit) != 0 ? 0.45f : 1.0f;
    disc.list.AddRectFilled(disc.at(middle.x() - gap * half, middle.y() + gap * half),
                            disc.at(middle.x() + gap * half, middle.y() - gap * half),
                            ImGui::GetColorU32({colour.x, colour.y, colour.z, strength}), 1.5f);
  }
  finish(disc, present);
}

void plot_radiance(const std::function<Eigen::Vector3f(const Eigen::Vector2f&)>& colour_at,
                   const std::optional<Eigen::Vector2f>& present, float diameter) {
  const Disc disc = reserve_disc(diameter);
  constexpr int side = 40;
  constexpr float step = 2.0f / side;
  for (int i = 0; i < side * side; ++i) {
    const Eigen::Vector2f uv(-1 + step * (static_cast<float>(i % side) + 0.5f),
                             -1 + step * (static_cast<float>(i / side) + 0.5f));
    if (uv.norm() > 1) continue;
    const Eigen::Vector3f c = colour_at(uv).cwiseMax(0.0f).cwiseMin(1.0f);
    disc.list.AddRectFilled(disc.at(uv.x() - step / 2, uv.y() + step / 2),
                            disc.at(uv.x() + step / 2, uv.y() - step / 2),
                            ImGui::GetColorU32({c.x(), c.y(), c.z(), 1}));
  }
  // Cover the stairs at the rim.
  const float cover = step * disc.radius;
  disc.list.AddCircle(disc.centre, disc.radius + 0.5f * cover - 1,
                      ImGui::GetColorU32(theme::kPanel), 64, cover);
  finish(disc, present);
}

}  // namespace sheen::app
