// SPDX-License-Identifier: MIT
#include "render/depth_quads/screen_quads.h"

#include "core/concurrency/parallel_for.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

namespace sheen::render {
namespace {

using fitting::KeptView;
using fitting::depth_quads::QuadLevel;
using fitting::depth_quads::QuadView;

/// A quad has the depth of its middle; a surface at 60 degrees differs by 0.9 sides at its border,
/// and two such quads by twice that.
constexpr float kToleranceSides = 2.0f;
/// Of quads in which two surfaces may be mixed.
constexpr float kMixedWeight = 0.02f;

std::size_t cell_idx(const QuadLevel& level, int i, int j) {
  return static_cast<std::size_t>(j) * static_cast<std::size_t>(level.columns) +
         static_cast<std::size_t>(i);
}

/// One level of a photograph.
struct Cells {
  const QuadView& quads;
  const QuadLevel& level;
  const std::uint16_t* codes;  ///< of the level
  const std::vector<Eigen::Vector2f>& nodes;
  double enlargement_px;
  float tolerance;
};

Cells cells_of(const KeptView& photograph, const QuadView& quads, std::size_t level_idx,
               const std::vector<Eigen::Vector2f>& nodes, double enlargement_px) {
  const QuadLevel& level = quads.levels[level_idx];
  std::size_t first = 0;
  for (std::size_t l = 0; l < level_idx; ++l) first += quads.levels[l].size();
  return {quads, level,          quads.depths.codes.data() + first,
          nodes, enlargement_px, depth_tolerance(photograph, level)};
}

/// How much a quad's colour counts for what stands around it: all where every neighbour goes on at
/// its depth, little beside a hole or a jump, hardly where no neighbour does: a flier.
float certainty(const Cells& cells, int i, int j, float depth_m) {
  const QuadLevel& level = cells.level;
  int present = 0;
  int continuing = 0;
  for (const auto& [di, dj] : {std::array{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
    const int x = i + di;
    const int y = j + dj;
    if (x < 0 || y < 0 || x >= level.columns || y >= level.rows) continue;
    const std::uint16_t code = cells.codes[cell_idx(level, x, y)];
    if (code == 0) continue;
    ++present;
    const float difference_m = std::abs(cells.quads.depths.depth_m(code) - depth_m);
    if (difference_m <= cells.tolerance * depth_m) ++continuing;
  }
  if (present > 0 && continuing == 0) return kFlierCertainty;
  return continuing == 4 ? 1.0f : kMixedWeight;
}

/// Enlarges a cell around its middle.
std::optional<CellQuad> cell_quad(const Cells& cells, int i, int j) {
  const QuadLevel& level = cells.level;
  const std::uint16_t code = cells.codes[cell_idx(level, i, j)];
  if (code == 0) return std::nullopt;
  const auto row = static_cast<std::size_t>(level.columns) + 1;
  const Eigen::Vector2f* const upper = cells.nodes.data() + static_cast<std::size_t>(j) * row + i;
  const Eigen::Vector2d a = upper[0].cast<double>();
  const Eigen::Vector2d b = upper[1].cast<double>();
  const Eigen::Vector2d c = upper[row].cast<double>();
  const Eigen::Vector2d d = upper[row + 1].cast<double>();
  const double side_px = level.spacing_px + 2 * cells.enlargement_px;
  const double larger = side_px / level.spacing_px;
  CellQuad quad{};
  quad.along = larger / 2 * (b + d - a - c);
  quad.down = larger / 2 * (c + d - a - b);
  quad.middle = (a + b + c + d) / 4;
  if (!(quad.middle + quad.along + quad.down).allFinite()) return std::nullopt;
  quad.depth_m = cells.quads.depths.depth_m(code);
  quad.certainty = certainty(cells, i, j, quad.depth_m);
  quad.first_x = static_cast<float>(i * level.spacing_px - 0.5 - cells.enlargement_px);
  quad.first_y = static_cast<float>(j * level.spacing_px - 0.5 - cells.enlargement_px);
  return quad;
}

/// What all quads of a photograph share.
struct Sheet {
  const QuadCamera& viewer;
  Eigen::Isometry3d viewer_from_photograph;
  Eigen::Vector3d viewer_eye;  ///< in the photograph's frame
  float side_px;
  float tolerance;
};

/// The pixels between four corners in the viewer's frame; nothing when one has no pixel.
std::optional<cv::Rect2d> pixel_box(const std::array<Eigen::Vector3d, 4>& corners,
                                    const core::CameraModel& camera) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& corner : corners) {
    const auto pixel = camera.project(corner);
    if (!pixel) return std::nullopt;
    box.extend(*pixel);
  }
  return cv::Rect2d(box.min().x(), box.min().y(), box.sizes().x(), box.sizes().y());
}

std::optional<ScreenQuad> screen_quad(const Sheet& sheet, const CellQuad& cell) {
  const auto depth_m = static_cast<double>(cell.depth_m);
  if (!(sheet.viewer_eye.z() < depth_m)) return std::nullopt;  // seen from behind

  // Put it at its depth.
  const auto in_viewer = [&](const Eigen::Vector2d& vector) -> Eigen::Vector3d {
    return sheet.viewer_from_photograph.linear() *
           Eigen::Vector3d(depth_m * vector.x(), depth_m * vector.y(), 0);
  };
  const Eigen::Vector2d first = cell.middle - (cell.along + cell.down) / 2;
  const Eigen::Vector3d P0 = sheet.viewer_from_photograph * (depth_m * first.homogeneous());
  const Eigen::Vector3d U = in_viewer(cell.along);
  const Eigen::Vector3d V = in_viewer(cell.down);

  // Find the pixels that may see it.
  const core::CameraModel& camera = sheet.viewer.camera;
  const auto box = pixel_box({P0, P0 + U, P0 + V, P0 + U + V}, camera);
  if (!box) return std::nullopt;
  ScreenQuad quad{};
  const auto within = [](double x, int most) {
    return static_cast<int>(std::clamp(x, -1.0, static_cast<double>(most)));
  };
  quad.left = std::max(within(std::ceil(box->x), camera.width_px()), 0);
  quad.top = std::max(within(std::ceil(box->y), camera.height_px()), 0);
  quad.right = within(std::floor(box->x + box->width), camera.width_px() - 1);
  quad.bottom = within(std::floor(box->y + box->height), camera.height_px() - 1);
  if (quad.left > quad.right || quad.top > quad.bottom) return std::nullopt;

  // Work in depths of the quad, far from the limits of single precision.
  const Eigen::Vector3d normal = U.cross(V) / (depth_m * depth_m);
  const double volume = P0.dot(normal);
  if (!(std::abs(volume) > 0)) return std::nullopt;
  const double scale = std::copysign(1 / (depth_m * depth_m), volume);
  quad.normal = (scale * U.cross(V)).cast<float>();
  quad.to_a = (scale * V.cross(P0)).cast<float>();
  quad.to_b = (scale * P0.cross(U)).cast<float>();
  quad.per_volume = static_cast<float>(1 / std::abs(volume));
  quad.first_x = cell.first_x;
  quad.first_y = cell.first_y;
  quad.side_px = sheet.side_px;
  quad.tolerance = sheet.tolerance;

  // Weigh it.
  const Eigen::Vector3d middle = depth_m * cell.middle.homogeneous();
  const double angle2 =
      (-middle.normalized() - (sheet.viewer_eye - middle).normalized()).squaredNorm();
  quad.weight = cell.certainty * static_cast<float>(1 / (angle2 + kLeastAngle * kLeastAngle));
  quad.is_flier = cell.certainty == kFlierCertainty;
  return quad;
}

}  // namespace

float depth_tolerance(const KeptView& photograph, const QuadLevel& level) {
  const auto focal_px = static_cast<float>(photograph.camera.intrinsics().focal_px.minCoeff());
  return kToleranceSides * static_cast<float>(level.spacing_px) * (1.0f / focal_px);
}

std::vector<Eigen::Vector2f> node_rays(const KeptView& photograph, const QuadLevel& level,
                                       const RayGrid& rays) {
  std::vector<Eigen::Vector2f> nodes;
  nodes.reserve(static_cast<std::size_t>(level.columns + 1) *
                static_cast<std::size_t>(level.rows + 1));
  for (int j = 0; j <= level.rows; ++j) {
    for (int i = 0; i <= level.columns; ++i) {
      nodes.push_back(rays.at(photograph.crop.x + i * level.spacing_px - 0.5,
                              photograph.crop.y + j * level.spacing_px - 0.5));
    }
  }
  return nodes;
}

std::size_t choose_level(const KeptView& photograph, const QuadView& quads,
                         const QuadCamera& viewer) {
  constexpr double widest_px = 2;
  const double finer =
      viewer.camera.intrinsics().focal_px.x() / photograph.camera.intrinsics().focal_px.x();
  double scale = 0;  // pixels of the view per pixel of the photograph, where it is largest
  for (const Eigen::Vector3d& probe : quads.probes) {
    const double in_viewer_m = (viewer.camera_from_object * probe).z();
    if (!(in_viewer_m > 0)) continue;
    scale = std::max(scale, finer * (photograph.camera_from_object * probe).z() / in_viewer_m);
  }
  std::size_t level = 0;
  while (level + 1 < quads.levels.size() &&
         quads.levels[level + 1].spacing_px * scale <= widest_px) {
    ++level;
  }
  return level;
}

std::vector<CellQuad> cell_quads(const KeptView& photograph, const QuadView& quads,
                                 std::size_t level_idx, const std::vector<Eigen::Vector2f>& nodes,
                                 double enlargement_px) {
  const Cells cells = cells_of(photograph, quads, level_idx, nodes, enlargement_px);
  std::vector<CellQuad> all;
  for (int j = 0; j < cells.level.rows; ++j) {
    for (int i = 0; i < cells.level.columns; ++i) {
      if (const auto quad = cell_quad(cells, i, j)) all.push_back(*quad);
    }
  }
  return all;
}

std::vector<ScreenQuad> screen_quads(const KeptView& photograph, const QuadView& quads,
                                     std::size_t level_idx,
                                     const std::vector<Eigen::Vector2f>& nodes,
                                     double enlargement_px, const QuadCamera& viewer, int threads) {
  const Cells cells = cells_of(photograph, quads, level_idx, nodes, enlargement_px);
  const Eigen::Isometry3d viewer_from_photograph =
      viewer.camera_from_object * photograph.camera_from_object.inverse();
  const Sheet sheet{viewer, viewer_from_photograph, viewer_from_photograph.inverse().translation(),
                    static_cast<float>(cells.level.spacing_px + 2 * enlargement_px),
                    cells.tolerance};

  // Rows of cells by threads, then one behind the other.
  std::vector<std::vector<ScreenQuad>> rows(static_cast<std::size_t>(cells.level.rows));
  core::parallel_for(
      rows.size(), threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t j = begin; j < end; ++j) {
          for (int i = 0; i < cells.level.columns; ++i) {
            const auto cell = cell_quad(cells, i, static_cast<int>(j));
            if (!cell) continue;
            if (const auto quad = screen_quad(sheet, *cell)) rows[j].push_back(*quad);
          }
        }
      },
      8);
  std::vector<ScreenQuad> all;
  for (const auto& row : rows) all.insert(all.end(), row.begin(), row.end());
  return all;
}

}  // namespace sheen::render
