// SPDX-License-Identifier: MIT
#include "fitting/multi_eigenspace/options.h"

#include <string>

namespace sheen::fitting::multi_eigenspace {
namespace {

constexpr double kMostTolerance = 255;
constexpr int kLeastPicture_px = 16;
constexpr int kMostPicture_px = 1024;
constexpr double kMostSpacing_deg = 90;

}  // namespace

void Options::check() const {
  require_value(eigenimages >= 0 && eigenimages <= kMostEigenimages, "eigenimages", eigenimages,
                "0 to " + std::to_string(kMostEigenimages));
  require_value(tolerance >= 0 && tolerance <= kMostTolerance, "space-tolerance", tolerance,
                "0 to 255");
  require_value(picture_px >= kLeastPicture_px && picture_px <= kMostPicture_px, "picture-size",
                picture_px, "16 to 1024");
  require_value(view_spacing_deg >= 0 && view_spacing_deg <= kMostSpacing_deg, "view-spacing",
                view_spacing_deg, "0 to 90");
}

OptionTable option_table(Options& options) {
  return {number_option("eigenimages", options.eigenimages, 0, kMostEigenimages,
                        "Eigenimages of a space beside its mean, at most"),
          number_option("space-tolerance", options.tolerance, 0, kMostTolerance,
                        "Error that views of a space may have, grey levels RMS"),
          number_option("picture-size", options.picture_px, kLeastPicture_px, kMostPicture_px,
                        "Side of the pictures, pixels"),
          number_option("view-spacing", options.view_spacing_deg, 0, kMostSpacing_deg,
                        "Views nearer than this to a kept one are left out, degrees"),
          choice_option("switching", options.switching,
                        {{"cross-fade", Switching::cross_fade}, {"hard", Switching::hard}},
                        "Between spaces: both are blended, or one of them as in the paper")};
}

}  // namespace sheen::fitting::multi_eigenspace
