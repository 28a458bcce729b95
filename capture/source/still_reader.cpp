// SPDX-License-Identifier: MIT
#include "capture/source/still_reader.h"

#include "capture/source/image_check.h"
#include "capture/source/jpeg_decoder.h"
#include "capture/source/picture_bytes.h"
#include "core/diagnostics/error.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include <cmath>

namespace sheen::capture {
namespace {

core::Error unreadable(const std::filesystem::path& path, const std::string& fault) {
  return core::bad_input(path, fault, "check that it is complete, or leave it out");
}

core::Error cut_short(const std::filesystem::path& path) {
  return unreadable(path, "cannot be read as an image: it is cut short or damaged");
}

/// Refuses what the headers show already: before memory is asked for.
void check_headers(const std::filesystem::path& path, const ImageFacts& facts,
                   std::uint64_t bytes) {
  if (const auto kind = unreadable_kind(facts.kind)) {
    throw core::bad_input(path, "is " + kind->name + ", which is not read", kind->remedy);
  }
  // OpenCV would look for a decoder among many, and DICOM's ends the program over a damaged file.
  if (facts.kind == ImageKind::unknown) {
    throw unreadable(path, "is no JPEG, PNG, TIFF, BMP or WebP");
  }
  if (facts.kind == ImageKind::jpeg && facts.channels == 4) {
    throw core::bad_input(path, "has CMYK colours, as for print", "convert it to RGB");
  }
  if (!facts.colour_fault.empty()) {
    throw core::bad_input(path, facts.colour_fault, "convert it to RGB of 8 or 16 bits");
  }
  if (facts.size) check_picture_size(path, *facts.size, bytes);
}

cv::Mat decoded(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes,
                const ImageFacts& facts) {
  cv::Mat image;
  if (facts.kind == ImageKind::jpeg) {
    // OpenCV would fill the missing half of a picture with grey and say nothing.
    if (!facts.size || !decode_jpeg(bytes, *facts.size, image)) throw cut_short(path);
    return image;
  }
  try {
    const int depth = facts.bits == 16 ? cv::IMREAD_ANYDEPTH : 0;
    image = cv::imdecode(bytes, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION | depth);
  } catch (const cv::Exception&) {
    image.release();  // OpenCV throws for absurd sizes and returns nothing for other faults
  }
  if (image.empty()) throw unreadable(path, "cannot be read as an image");
  return image;
}

}  // namespace

cv::Mat StillReader::read(const std::filesystem::path& path, std::optional<ImageSize> expected) {
  const std::vector<std::uint8_t> bytes = read_picture_bytes(path);
  const ImageFacts facts = read_image_facts(bytes);
  check_headers(path, facts, bytes.size());

  // Sizes first: they are told by the headers of most kinds, before memory is asked for.
  const auto choose = [&](const ImageSize& stored) {
    const ImageSize wanted = expected.value_or(bound_.value_or(stored));
    if (bound_ && !can_have_size(stored, wanted, facts.orientation)) {
      throw core::bad_input(
          path, "is " + size_text(stored) + ", the images before it are " + size_text(*bound_),
          "keep images of one camera, size and zoom together");
    }
    return choose_turn(path, stored, wanted, facts.orientation);
  };
  if (facts.size) static_cast<void>(choose(*facts.size));
  cv::Mat image = decoded(path, bytes, facts);
  if (image.depth() == CV_16U) take_depth(path, image);
  const TurnChoice turn = choose({image.cols, image.rows});
  if (!bound_) bound_ = ImageSize{image.cols, image.rows};
  if (turn.turns) image = turned(image, facts.orientation);
  if (!turn.note.empty()) note(path, turn.note);
  convert_colours(path, facts, image);
  return image;
}

void StillReader::convert_colours(const std::filesystem::path& path, const ImageFacts& facts,
                                  cv::Mat& bgr) {
  const ColourProfile* profile = nullptr;
  if (!facts.profile.empty()) {
    auto [entry, is_new] =
        profiles_.try_emplace(std::string(facts.profile.begin(), facts.profile.end()));
    if (is_new) {
      ColourProfile read;
      if (read.take_icc(facts.profile)) entry->second = std::move(read);
    }
    if (!entry->second) {
      return note(path, "has a colour profile that cannot be read; its colours count as sRGB");
    }
    profile = &*entry->second;
  } else if (facts.is_adobe_rgb) {
    if (!adobe_rgb_) {
      adobe_rgb_.emplace();
      static_cast<void>(adobe_rgb_->take_adobe_rgb());
    }
    profile = &*adobe_rgb_;
  } else if (!facts.colour_doubt.empty()) {
    return note(
        path, "states " + facts.colour_doubt + ", which is passed over; its colours count as sRGB");
  } else if (facts.gamma && std::abs(*facts.gamma - 1 / 2.2) > 0.02) {
    return note(path, fmt::format("states a gamma of {:.2f}, which is passed over; its colours "
                                  "count as sRGB",
                                  *facts.gamma));
  }
  if (profile == nullptr || profile->is_srgb()) return;
  profile->convert(bgr);
  note(path, "its colours were converted to sRGB from the profile " + profile->name());
}

/// 8 bits of 16, rounded.
void StillReader::take_depth(const std::filesystem::path& path, cv::Mat& image) {
  if (first_deep_.empty()) first_deep_ = path;
  depth_.look_at(image);
  image.convertTo(image, CV_8U, 1 / 257.0);
}

void StillReader::note(const std::filesystem::path& path, const std::string& cause) {
  Cause& known = causes_[cause];
  if (known.count++ == 0) known.first = path.string();
}

std::vector<std::string> StillReader::notes() const {
  std::vector<std::string> notes;
  for (const auto& [cause, known] : causes_) {
    notes.push_back(known.count == 1
                        ? fmt::format("{}: {}", known.first, cause)
                        : fmt::format("{} and {} more: {}", known.first, known.count - 1, cause));
  }
  if (const std::string doubt = depth_.doubt(); !doubt.empty()) {
    notes.push_back(first_deep_.string() + ": " + doubt);
  }
  return notes;
}

}  // namespace sheen::capture
