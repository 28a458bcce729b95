// SPDX-License-Identifier: MIT
#include "capture/walk_calibration/lens_prior.h"

#include "capture/files/file_handle.h"
#include "capture/source/image_facts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace sheen::capture {
namespace {

constexpr double kGuessedSigma = 0.4;  // from 40 to 85 degrees, by one deviation
constexpr double kStatedSigma = 0.05;  // whole millimetres, and cropped a little
constexpr std::size_t kExifWithin = 256U
                                    << 10U;  // EXIF comes before the picture, of 64 KiB at most

}  // namespace

LensPrior guessed_lens(const ImageSize& size, double pixel_aspect) {
  const double half_side_px = 0.5 * std::max(1.0 * size.width_px, size.height_px / pixel_aspect);
  return {size, half_side_px / std::tan(std::numbers::pi / 6), kGuessedSigma, false, pixel_aspect};
}

LensPrior stated_lens(const ImageSize& size, double focal_35mm) {
  const double film_diagonal_mm = std::hypot(36.0, 24.0);
  const double diagonal_px = std::hypot(size.width_px, size.height_px);
  return {size, focal_35mm / film_diagonal_mm * diagonal_px, kStatedSigma, true, 1};
}

LensPrior lens_of_picture(const std::filesystem::path& picture, const ImageSize& size) {
  const FileHandle file = FileHandle::open_to_read(picture);
  std::vector<std::uint8_t> bytes(std::min<std::size_t>(file.size(), kExifWithin));
  bytes.resize(file.read_at(0, bytes));
  const auto focal_35mm = read_image_facts(bytes).focal_35mm;
  return focal_35mm ? stated_lens(size, *focal_35mm) : guessed_lens(size);
}

}  // namespace sheen::capture
