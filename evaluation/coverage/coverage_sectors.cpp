// SPDX-License-Identifier: MIT
#include "evaluation/coverage/coverage_sectors.h"

#include "core/mesh/bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <numbers>

namespace sheen::evaluation {
namespace {

constexpr double kLowSine = 0.5;                      // 30 degrees
constexpr double kTopSine = std::numbers::sqrt3 / 2;  // 60 degrees
constexpr int kTopSector = Coverage::kSectors - 1;
constexpr int kDegreesEach = 360 / Coverage::kAzimuths;

void count_patches(const core::Mesh& mesh, const Eigen::Matrix3d& board_from_object,
                   std::span<const std::uint8_t> observed, Coverage& coverage) {
  for (std::size_t i = 0; i < observed.size(); ++i) {
    const auto sector = sector_of(board_from_object * mesh.normals[i].cast<double>());
    CoverageSector& counted =
        sector ? coverage.sectors.at(static_cast<std::size_t>(*sector)) : coverage.underneath;
    ++counted.patches;
    if (observed[i] != 0) ++counted.observed;
  }
}

}  // namespace

std::optional<int> sector_of(const Eigen::Vector3d& direction) {
  const double sine = direction.z() / direction.norm();
  if (sine < -kLowSine) return std::nullopt;
  if (sine >= kTopSine) return kTopSector;
  const double turns = std::atan2(direction.y(), direction.x()) / (2 * std::numbers::pi);
  const int azimuth =
      static_cast<int>(std::floor((turns < 0 ? turns + 1 : turns) * Coverage::kAzimuths)) %
      Coverage::kAzimuths;
  return sine < kLowSine ? azimuth : Coverage::kAzimuths + azimuth;
}

std::string sector_text(int sector) {
  if (sector == kTopSector) return "from the top";
  const int azimuth = sector % Coverage::kAzimuths;
  return fmt::format("{} to {} degrees, {}", azimuth * kDegreesEach, (azimuth + 1) * kDegreesEach,
                     sector < Coverage::kAzimuths ? "from the side" : "obliquely from above");
}

Coverage measure_coverage(const core::Mesh& mesh, const Eigen::Isometry3d& board_from_object,
                          std::span<const std::uint8_t> observed,
                          const pipeline::FrameStatistics& frames,
                          const EvaluationSummary* held_out) {
  assert(observed.size() == mesh.normals.size());
  Coverage coverage;
  count_patches(mesh, board_from_object.linear(), observed, coverage);

  // Cameras, as seen from the middle of the object.
  const Eigen::Vector3d middle = board_from_object * core::bounds_of(mesh).center().cast<double>();
  std::map<int, double> psnr_db;
  if (held_out != nullptr) {
    for (const ViewError& view : held_out->views) psnr_db[view.index] = view.error.psnr_db;
  }
  for (const pipeline::PosedFrame& frame : frames.posed) {
    const Eigen::Vector3d camera = frame.camera_from_board.inverse().translation();
    const auto sector = sector_of(camera - middle);
    if (!sector) continue;
    CoverageSector& counted = coverage.sectors.at(static_cast<std::size_t>(*sector));
    ++counted.frames;
    if (const auto view = psnr_db.find(frame.index); view != psnr_db.end()) {
      ++counted.held_out_views;
      counted.held_out_psnr_db += view->second;
    }
  }
  for (CoverageSector& sector : coverage.sectors) {
    if (sector.held_out_views > 0) {
      sector.held_out_psnr_db /= static_cast<double>(sector.held_out_views);
    }
  }
  return coverage;
}

nlohmann::ordered_json to_json(const Coverage& coverage) {
  auto sectors = nlohmann::ordered_json::array();
  for (int i = 0; i < Coverage::kSectors; ++i) {
    const CoverageSector& sector = coverage.sectors.at(static_cast<std::size_t>(i));
    sectors.push_back({{"where", sector_text(i)},
                       {"patches", sector.patches},
                       {"observed", sector.observed},
                       {"frames", sector.frames},
                       {"held_out_views", sector.held_out_views},
                       {"held_out_psnr", sector.held_out_views > 0
                                             ? nlohmann::ordered_json(sector.held_out_psnr_db)
                                             : nlohmann::ordered_json(nullptr)}});
  }
  return {{"sectors", std::move(sectors)},
          {"underneath",
           {{"patches", coverage.underneath.patches}, {"observed", coverage.underneath.observed}}}};
}

}  // namespace sheen::evaluation
