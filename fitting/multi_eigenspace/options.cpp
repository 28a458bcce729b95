// SPDX-License-Identifier: MIT
#include "fitting/multi_eigenspace/options.h"

#include <stdexcept>
#include <string>

namespace sheen::fitting::multi_eigenspace {
namespace {

constexpr double kMostTolerance = 255;
constexpr int kLeastPicture_px = 16;
constexpr int kMostPicture_px = 1024;
constexpr double kMostSpacing_deg = 90;

void refuse_beyond(const char* name, double value, double least, double most) {
  if (value >= least && value <= most) return;
  throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) + ", allowed: " +
                              std::to_string(least) + " to " + std::to_string(most));
}

}  // namespace

void Options::check() const {
  refuse_beyond("eigenimages", eigenimages, 0, kMostEigenimages);
  refuse_beyond("space-tolerance", tolerance, 0, kMostTolerance);
  refuse_beyond("picture-size", picture_px, kLeastPicture_px, kMostPicture_px);
  refuse_beyond("view-spacing", view_spacing_deg, 0, kMostSpacing_deg);
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
