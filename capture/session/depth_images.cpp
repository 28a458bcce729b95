// SPDX-License-Identifier: MIT
#include "capture/session/depth_images.h"

#include "capture/source/image_facts.h"
#include "capture/source/picture_bytes.h"
#include "core/diagnostics/error.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace sheen::capture {
namespace {

/// Sides of a depth image may be rounded from those of the frames.
constexpr double kAspectTolerance = 0.01;

/// A PNG's header says its bits and colours at fixed places.
void check_depth_png(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t bits_at = 24, colours_at = 25;
  constexpr std::uint8_t depth_bits = 16, grey = 0;
  const ImageFacts facts = read_image_facts(bytes);
  const bool is_depth = facts.kind == ImageKind::png && facts.size && bytes.size() > colours_at &&
                        bytes[bits_at] == depth_bits && bytes[colours_at] == grey;
  if (!is_depth) {
    throw core::bad_input(path, "is no PNG of 16 bits grey, which depth images are",
                          "see docs/session-format.md");
  }
  check_picture_size(path, *facts.size, bytes.size());
}

cv::Mat decoded(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = read_picture_bytes(path);
  check_depth_png(path, bytes);
  cv::Mat image;
  try {
    image = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    image.release();  // as for other pictures: it throws for absurd sizes only
  }
  if (image.type() == CV_16UC1 && !image.empty()) return image;
  throw core::bad_input(path, "cannot be read as an image: it is cut short or damaged",
                        "check that it is complete");
}

/// For every place along a side of the frame the nearest one along the depth image's.
std::vector<int> nearest_places(int frame_px, int depth_px) {
  std::vector<int> places;
  places.reserve(static_cast<std::size_t>(frame_px));
  // Pixel i covers [i, i + 1) of its side, its middle is i + 1/2.
  for (int i = 0; i < frame_px; ++i) places.push_back((2 * i + 1) * depth_px / (2 * frame_px));
  return places;
}

}  // namespace

DepthImages::DepthImages(const Session& session)
    : folder_(session.folder),
      name_(NumberedName::parse(session.depth.value().pattern).value()),
      numbers_(find_images(folder_, name_)),
      unit_m_(session.depth->unit_m),
      frame_size_(session.camera.width_px(), session.camera.height_px()) {}

cv::Mat DepthImages::read(int frame_index) const {
  const std::filesystem::path path = folder_ / name_.at(numbers_.first + frame_index);
  if (frame_index >= numbers_.count) {
    throw core::bad_input(path, fmt::format("is missing: frame {} has no depth image", frame_index),
                          "add one for every frame, or take \"depth\" out of session.json");
  }
  const cv::Mat stored = decoded(path);
  const double aspect = static_cast<double>(stored.cols) / stored.rows;
  const double wanted = static_cast<double>(frame_size_.width) / frame_size_.height;
  if (std::abs(aspect / wanted - 1) > kAspectTolerance) {
    throw core::bad_input(
        path,
        fmt::format("has {} x {} pixels, another aspect ratio than the frames ({} x {})",
                    stored.cols, stored.rows, frame_size_.width, frame_size_.height),
        "register the depth images to the colour camera");
  }

  // 0 and what no longer fits into 16 bits are not known.
  constexpr std::uint16_t too_far = std::numeric_limits<std::uint16_t>::max();
  const std::vector<int> columns = nearest_places(frame_size_.width, stored.cols);
  const std::vector<int> rows = nearest_places(frame_size_.height, stored.rows);
  cv::Mat depth_m(frame_size_, CV_32FC1);
  for (int y = 0; y < depth_m.rows; ++y) {
    const auto* const from = stored.ptr<std::uint16_t>(rows[static_cast<std::size_t>(y)]);
    auto* const to = depth_m.ptr<float>(y);
    for (int x = 0; x < depth_m.cols; ++x) {
      const std::uint16_t units = from[columns[static_cast<std::size_t>(x)]];
      to[x] = units == too_far ? 0.0f : static_cast<float>(units * unit_m_);
    }
  }
  return depth_m;
}

}  // namespace sheen::capture
