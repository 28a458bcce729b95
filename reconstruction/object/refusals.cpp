// SPDX-License-Identifier: MIT
#include "reconstruction/object/refusals.h"

#include "core/diagnostics/error.h"
#include "reconstruction/stage/print_check.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace sheen::reconstruction {
namespace {

constexpr int kDirections = 90;         // of the plane, over half a turn
constexpr double kWidestBlind = 45;     // degrees: a quarter of the circle is walked
constexpr double kFromAbove = 0.94;     // sine of 70 degrees
constexpr float kMostHidden = 0.8F;     // of the sheet within its tags
constexpr double kSecondObject = 0.05;  // of the first one's volume
constexpr float kLeastCovered = 0.65F;  // of the silhouettes, by the hull
constexpr float kMostlyPaper = 0.5F;    // of what was cut out
constexpr float kMovedShare = 0.25F;    // of its width
constexpr const char* kLeaveIt = "film again and leave object and sheet where they are";
constexpr double kDegrees = 180 / std::numbers::pi;

/// How far, at worst over the horizontal directions, the views are from looking across one, in
/// plan: 0 degrees would be a view along the tangent plane, which shows where the object ends
/// there. Views from above look across all of them.
double blind_angle_deg(const ViewSet& views, const Eigen::Vector3f& centre) {
  double worst = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double turn = std::numbers::pi * i / kDirections;
    const Eigen::Vector2d normal(std::cos(turn), std::sin(turn));
    double best = 90;
    for (const View& view : views.views) {
      const Eigen::Vector3d sight = (view.project.eye() - centre).cast<double>().normalized();
      if (sight.z() > kFromAbove) return 0;
      const double along = std::abs(sight.head<2>().normalized().dot(normal));
      best = std::min(best, kDegrees * std::asin(std::min(1.0, along)));
    }
    worst = std::max(worst, best);
  }
  return worst;
}

std::string percent(double share) {
  return std::to_string(std::lround(100 * share)) + " %";
}

}  // namespace

void refuse_narrow_range(const std::filesystem::path& session, const capture::Board& board,
                         const ViewSet& views) {
  const Eigen::Vector2f middle = tags_region(board).center();
  const double blind = blind_angle_deg(views, {middle.x(), middle.y(), 0});
  if (blind <= kWidestBlind) return;
  throw core::bad_input(session,
                        "its views come from too few sides to tell how deep the object is (" +
                            std::to_string(std::lround(blind)) +
                            " degrees from seeing one of them across)",
                        "film a walk all the way round it, or at least half");
}

float refuse_hidden_sheet(const std::filesystem::path& session, const capture::Board& board,
                          const StageMap& map) {
  const Eigen::AlignedBox2f region = tags_region(board);
  std::size_t within = 0;
  std::size_t hidden = 0;
  for (int row = 0; row < map.grid.size.height; ++row) {
    for (int column = 0; column < map.grid.size.width; ++column) {
      if (!region.contains(
              map.grid.point_of(static_cast<float>(column), static_cast<float>(row)))) {
        continue;
      }
      ++within;
      hidden +=
          map.source.at<std::uint8_t>(row, column) != static_cast<std::uint8_t>(TexelSource::seen)
              ? 1
              : 0;
    }
  }
  const float share = within == 0 ? 1 : static_cast<float>(hidden) / static_cast<float>(within);
  if (share <= kMostHidden) return share;
  throw core::bad_input(session,
                        percent(static_cast<double>(share)) +
                            " of the sheet is never seen, so the "
                            "object cannot be told from it",
                        "use a larger sheet or a smaller object, and keep the sheet in view");
}

void refuse_empty_sheet(const std::filesystem::path& session, const Components& components) {
  if (!components.parts.empty()) return;
  throw core::bad_input(
      session, "no object is found on the sheet",
      "film an object that differs from the sheet and stands still on it; a pale one "
      "on a sheet printed on coloured paper");
}

void refuse_what_stands_there(const std::filesystem::path& session, const capture::Board& board,
                              const Components& components) {
  const auto& parts = components.parts;
  if (parts.size() > 1 &&
      static_cast<double>(parts[1].points) > kSecondObject * static_cast<double>(parts[0].points)) {
    throw core::bad_input(session, "more than one object stands on the sheet",
                          "film one object at a time");
  }
  refuse_beside_tags(session, board, parts[0]);
}

void refuse_beside_tags(const std::filesystem::path& session, const capture::Board& board,
                        const Component& object) {
  const Eigen::Vector3f middle = object.box.center();
  if (tags_region(board).contains(middle.head<2>())) return;
  throw core::bad_input(session, "the object stands beside the sheet's tags",
                        "put it in their middle and film again");
}

void refuse_paper_like(const std::filesystem::path& session, float paper_share) {
  if (paper_share < kMostlyPaper) return;
  throw core::bad_input(session,
                        "the object looks like the sheet that it stands on (" +
                            percent(static_cast<double>(paper_share)) +
                            " of what could be cut out has the paper's colour), so where it ends "
                            "cannot be told",
                        "print the sheet on coloured or grey paper");
}

void refuse_two_places(const std::filesystem::path& session, const Component& first,
                       const Component& second) {
  const Eigen::Vector3f way = second.box.center() - first.box.center();
  if (way.head<2>().norm() < kMovedShare * first.box.sizes().head<2>().maxCoeff()) return;
  throw core::bad_input(session,
                        "the object stands elsewhere in the second half of the walk (" +
                            std::to_string(std::lround(1e3F * way.head<2>().norm())) +
                            " mm away), as if it had been moved",
                        kLeaveIt);
}

void refuse_moved_object(const std::filesystem::path& session, float covered_share) {
  if (covered_share >= kLeastCovered) return;
  throw core::bad_input(session,
                        "the object's outlines contradict each other (only " +
                            percent(static_cast<double>(covered_share)) +
                            " of them agree), as if it had been moved",
                        kLeaveIt);
}

}  // namespace sheen::reconstruction
