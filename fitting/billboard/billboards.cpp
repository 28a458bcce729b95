// SPDX-License-Identifier: MIT
#include "fitting/billboard/billboards.h"

#include "core/diagnostics/error.h"
#include "core/image/jpeg.h"
#include "core/image/png.h"
#include "fitting/billboard/directions.h"

#include <utility>

namespace sheen::fitting::billboard {

Frame encode(const FrameImage& image, int quality) {
  if (image.crop.empty()) return {};
  // More effort takes longer than baking, for a tenth of the bytes.
  constexpr int effort = 4;
  return {image.crop, core::encode_jpeg(image.colour, quality),
          core::encode_png(image.shape, effort)};
}

FrameImage decode(const Frame& frame) {
  auto colour = core::decode_jpeg(std::as_bytes(std::span(frame.colour)), frame.crop.size());
  auto shape = core::decode_png(std::as_bytes(std::span(frame.shape)), frame.crop.size());
  if (colour && shape) return {frame.crop, *std::move(colour), *std::move(shape)};
  throw core::bad_input("the model", "holds a frame that cannot be decoded",
                        "make it again with sheen replay");
}

Billboards::Billboards(const Options& options, const Sphere& sphere, std::size_t vertex_count)
    : options_(options),
      sphere_(sphere),
      directions_(billboard::directions(options.directions)),
      frames_(directions_.size()),
      means_(vertex_count) {}

std::size_t Billboards::coefficient_count() const {
  constexpr std::size_t per_pixel = 5;
  std::size_t count = means_.coefficient_count();
  for (const Frame& frame : frames_) {
    count += per_pixel * static_cast<std::size_t>(frame.crop.area());
  }
  return count;
}

}  // namespace sheen::fitting::billboard
