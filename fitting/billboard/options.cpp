// SPDX-License-Identifier: MIT
#include "fitting/billboard/options.h"

#include "fitting/billboard/directions.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace sheen::fitting::billboard {
namespace {

constexpr int kLeastSide_px = 16;
constexpr int kMostSide_px = 1024;
constexpr double kWidestField_deg = 120;
/// Those that bake a frame from mesh and numbers alone.
constexpr std::array kBakedFrom{"sparse", "iwls", "sh", "mean", "nearest-views"};

}  // namespace

void Options::check() const {
  if (std::ranges::find(kDirectionCounts, directions) == kDirectionCounts.end()) {
    refuse_value("directions", std::to_string(directions), "20, 80, 320, 1280, 5120");
  }
  if (side_px < kLeastSide_px || side_px > kMostSide_px) {
    refuse_value("billboard-size", std::to_string(side_px), "16 to 1024");
  }
  if (!(field_of_view_deg >= 0 && field_of_view_deg <= kWidestField_deg)) {
    refuse_value("billboard-fov", std::to_string(field_of_view_deg), "0 to 120");
  }
  if (std::ranges::find(kBakedFrom, baked_from) == kBakedFrom.end()) {
    refuse_value("baked-from", baked_from, "sparse, iwls, sh, mean, nearest-views");
  }
  fitting::check(views);
}

OptionTable option_table(Options& options) {
  std::vector<std::pair<std::string, int>> counts;
  for (const int count : kDirectionCounts) counts.emplace_back(std::to_string(count), count);
  std::vector<std::pair<std::string, std::string>> names;
  for (const char* const name : kBakedFrom) names.emplace_back(name, name);
  OptionTable table{
      choice_option("directions", options.directions, counts,
                    "Directions from which the object is baked"),
      number_option("billboard-size", options.side_px, kLeastSide_px, kMostSide_px,
                    "Side of a frame that just holds the object, pixels"),
      number_option("billboard-fov", options.field_of_view_deg, 0.0, kWidestField_deg,
                    "Field of view of the cameras that bake the frames, degrees, 0: orthographic"),
      choice_option("billboard-blending", options.blending,
                    {{"blended", Blending::blended}, {"nearest", Blending::nearest}},
                    "The frames around by their depths, or the nearest one as in the paper"),
      choice_option("baked-from", options.baked_from, names,
                    "Representation that is fitted first, which the frames show")};
  add_options(options.views, table);
  return table;
}

}  // namespace sheen::fitting::billboard
