// SPDX-License-Identifier: MIT
#include "fitting/depth_quads/options.h"

#include <string>

namespace sheen::fitting::depth_quads {
namespace {

constexpr int kMostSpacing_px = 63;
constexpr int kMostLevels = 6;
constexpr int kMostMedian = 9;
constexpr int kMostCameras = 64;

bool is_odd_within(int value, int most) {
  return value >= 1 && value <= most && value % 2 == 1;
}

}  // namespace

void Options::check() const {
  require_value(is_odd_within(spacing_px, kMostSpacing_px), "spacing", spacing_px,
                "odd numbers from 1 to " + std::to_string(kMostSpacing_px));
  require_value(levels >= 1 && levels <= kMostLevels, "levels", levels,
                "1 to " + std::to_string(kMostLevels));
  require_value(enlargement >= 0 && enlargement <= 1, "enlargement", enlargement, "0 to 1");
  require_value(is_odd_within(median, kMostMedian), "median", median,
                "odd numbers from 1 to " + std::to_string(kMostMedian));
  require_value(cameras >= 1 && cameras <= kMostCameras, "cameras", cameras,
                "1 to " + std::to_string(kMostCameras));
  fitting::check(views);
}

OptionTable option_table(Options& options) {
  OptionTable table{
      number_option("spacing", options.spacing_px, 1, kMostSpacing_px,
                    "Side of the finest quads, pixels of their photograph, odd"),
      number_option("levels", options.levels, 1, kMostLevels,
                    "Levels of detail, each of quads twice as wide and a pixel more"),
      number_option("enlargement", options.enlargement, 0.0, 1.0,
                    "By how much quads overlap on every side, pixels"),
      number_option("median", options.median, 1, kMostMedian,
                    "Side of the median filter on depths, odd, 1 for none"),
      choice_option("depths", options.depths,
                    {{"session", Depths::session}, {"mesh", Depths::mesh}},
                    "Depths are those of the session's depth images where it has some, or the "
                    "mesh's"),
      number_option("cameras", options.cameras, 1, kMostCameras,
                    "Photographs drawn into one image"),
      choice_option("quad-blending", options.blending,
                    {{"weighted", Blending::weighted}, {"hard", Blending::hard}},
                    "Quads near the surface are blended, or the nearest wins as in the paper")};
  add_options(options.views, table);
  return table;
}

}  // namespace sheen::fitting::depth_quads
