// SPDX-License-Identifier: MIT
#include "capture/source/frame_source.h"
#include "capture/source/video_source.h"
#include "tests/capture/expect_bad_input.h"
#include "tests/capture/video_file.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <cmath>

namespace sheen::capture::test {
namespace {

using tests::TemporaryFolder;

constexpr ImageSize kVideoSize{64, 48};

/// Frames told apart by their brightness, in steps that lossy compression keeps.
Eigen::Vector3d grey_by_number(int frame, bool /*is_right*/) {
  return Eigen::Vector3d::Constant((20 + 8 * (frame % 28)) / 255.0);
}
int number_of(const cv::Mat& image) {
  return static_cast<int>(std::lround((cv::mean(image)[0] - 20) / 8));
}

VideoSpec numbered(int frames, std::int64_t first_ms = 0, std::int64_t step_ms = 40) {
  VideoSpec spec;
  for (int i = 0; i < frames; ++i) spec.stamps_ms.push_back(first_ms + step_ms * i);
  spec.colour = grey_by_number;
  return spec;
}

std::vector<Frame> all_frames(FrameSource& source) {
  std::vector<Frame> frames;
  while (auto frame = source.next()) {
    frame->image = frame->image.clone();
    frames.push_back(std::move(*frame));
  }
  return frames;
}

bool says(const SourceReport& report, const std::string& word) {
  return std::any_of(report.notes.begin(), report.notes.end(), [&word](const std::string& note) {
    return note.find(word) != std::string::npos;
  });
}

/// Largest difference, in steps of 8 bits, of the middle of each half from the wanted colours.
double colour_error(const cv::Mat& image, const std::array<Eigen::Vector3d, 2>& rgb) {
  double worst = 0;
  for (int half = 0; half < 2; ++half) {
    const cv::Vec3b bgr = image.at<cv::Vec3b>(image.rows / 2, image.cols * (1 + 2 * half) / 4);
    for (int i = 0; i < 3; ++i) {
      worst = std::max(worst, std::abs(bgr[2 - i] - 255 * rgb[static_cast<std::size_t>(half)][i]));
    }
  }
  return worst;
}

/// Strong colours, none of them clipped by limited range.
const std::array<std::array<Eigen::Vector3d, 2>, 3> kColours{
    {{{{0.9, 0.15, 0.1}, {0.1, 0.85, 0.2}}},
     {{{0.15, 0.2, 0.9}, {0.9, 0.8, 0.1}}},
     {{{0.5, 0.5, 0.5}, {0.95, 0.95, 0.95}}}}};

TEST(VideoColours, AreReadByTheMatrixAndRangeThatTheFileStates) {
  const TemporaryFolder folder;
  for (const AVColorSpace matrix : {AVCOL_SPC_SMPTE170M, AVCOL_SPC_BT709, AVCOL_SPC_BT2020_NCL}) {
    for (const bool is_full : {false, true}) {
      for (const AVPixelFormat format :
           {AV_PIX_FMT_YUV444P, AV_PIX_FMT_YUV420P, AV_PIX_FMT_YUV420P10LE}) {
        SCOPED_TRACE("matrix " + std::to_string(matrix) + (is_full ? " full" : " limited") +
                     " format " + std::to_string(format));
        VideoSpec spec = numbered(3);
        spec.format = format;
        spec.matrix = matrix;
        spec.is_full_range = is_full;
        spec.colour = [](int frame, bool is_right) {
          return kColours[static_cast<std::size_t>(frame)][is_right ? 1 : 0];
        };
        write_video(folder / "colours.mkv", spec);
        const auto source = open_video(folder / "colours.mkv", kVideoSize, {}, std::nullopt);
        const auto frames = all_frames(*source);
        ASSERT_EQ(frames.size(), 3u);
        // 8 bits: luma is off by half a step of 255/219, colour differences by half a step of
        // 255/224 times 1.9 at most, and libswscale's numbers have 13 bits.
        for (std::size_t i = 0; i < frames.size(); ++i) {
          EXPECT_LE(colour_error(frames[i].image, kColours[i]), 2.5) << i;
        }
      }
    }
  }
}

// libswscale converts blocks of pixels: beyond the last column, and short of it, with the widths
// that are no multiples of them (portrait phones, laptops).
TEST(VideoColours, ReachTheLastColumnOfAnyWidth) {
  const TemporaryFolder folder;
  for (const int width : {2, 98, 102, 360, 1080, 1366}) {
    SCOPED_TRACE(width);
    VideoSpec spec = numbered(2);
    spec.format = AV_PIX_FMT_YUV420P;
    spec.width = width;
    write_video(folder / "wide.mkv", spec);
    const auto source = open_video(folder / "wide.mkv", {width, spec.height}, {}, std::nullopt);
    const auto frames = all_frames(*source);
    ASSERT_EQ(frames.size(), 2u);
    for (const Frame& frame : frames) {
      double least = 0;
      double most = 0;
      cv::minMaxLoc(frame.image.reshape(1), &least, &most);
      EXPECT_LE(most - least, 1);  // flat grey, but for a rounding
    }
  }
}

TEST(VideoColours, HighDynamicRangeIsConvertedAndSaid) {
  const TemporaryFolder folder;
  for (const auto transfer : {AVCOL_TRC_ARIB_STD_B67, AVCOL_TRC_SMPTE2084}) {
    VideoSpec spec = numbered(2);
    spec.format = AV_PIX_FMT_YUV420P10LE;
    spec.matrix = AVCOL_SPC_BT2020_NCL;
    spec.transfer = transfer;
    spec.primaries = AVCOL_PRI_BT2020;
    // Reference white on the left (BT.2408: 75 % of HLG, 58 % of PQ), 18 % grey on the right.
    const double white = transfer == AVCOL_TRC_ARIB_STD_B67 ? 0.75 : 0.58;
    spec.colour = [white](int /*frame*/, bool is_right) {
      return Eigen::Vector3d::Constant(is_right ? 0.38 : white).eval();
    };
    write_video(folder / "hdr.mkv", spec);
    const auto source = open_video(folder / "hdr.mkv", kVideoSize, {}, std::nullopt);
    const auto frames = all_frames(*source);
    ASSERT_EQ(frames.size(), 2u);
    // The standard's percentages are rounded (pixels_test has the sums): 4 steps.
    EXPECT_LE(colour_error(frames[0].image, {Eigen::Vector3d::Ones().eval(),
                                             Eigen::Vector3d::Constant(0.394).eval()}),
              5);
    EXPECT_TRUE(says(source->report(), "sRGB"));
    EXPECT_TRUE(says(source->report(), "clipped"));
  }
}

TEST(VideoColours, HighDefinitionWithoutAWordIsSaidToBeDoubtful) {
  const TemporaryFolder folder;
  VideoSpec spec = numbered(1);
  spec.width = 1280;
  spec.height = 720;
  spec.states_colours = false;
  write_video(folder / "silent.mkv", spec);
  const auto source = open_video(folder / "silent.mkv", {1280, 720}, {}, std::nullopt);
  EXPECT_EQ(all_frames(*source).size(), 1u);
  EXPECT_TRUE(says(source->report(), "BT.601"));
}

TEST(VideoTimes, AreTheFramesOwnWhateverTheRate) {
  const TemporaryFolder folder;
  // 25 a second, then a pause, then 10 a second.
  VideoSpec spec = numbered(0);
  for (const std::int64_t ms : {0, 40, 80, 120, 700, 800, 900, 1000}) spec.stamps_ms.push_back(ms);
  write_video(folder / "vfr.mkv", spec);
  const auto source = open_video(folder / "vfr.mkv", kVideoSize, {}, std::nullopt);
  const auto frames = all_frames(*source);
  ASSERT_EQ(frames.size(), spec.stamps_ms.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].index, static_cast<int>(i));
    EXPECT_NEAR(frames[i].time_s, static_cast<double>(spec.stamps_ms[i]) / 1000, 1e-6);
    EXPECT_EQ(number_of(frames[i].image), static_cast<int>(i));
  }
  EXPECT_NEAR(frames[7].spacing_s, 0.1, 1e-6);
  EXPECT_TRUE(source->report().notes.empty());

  // A stated rate wins, and the two disagree by 1 - 7/25 = 0.72 s at the end.
  const auto stated = open_video(folder / "vfr.mkv", kVideoSize, {}, 25);
  const auto even = all_frames(*stated);
  ASSERT_EQ(even.size(), frames.size());
  EXPECT_NEAR(even[7].time_s, 7 / 25.0, 1e-9);
  EXPECT_TRUE(says(stated->report(), "0.72"));
}

TEST(VideoTimes, WhatAnEditListHidesIsNotThere) {
  const TemporaryFolder folder;
  // Twelve frames before the cut, which a player does not show: frame 12 is the first.
  VideoSpec spec = numbered(24, -12 * 40);
  spec.codec = AV_CODEC_ID_MPEG4;
  spec.format = AV_PIX_FMT_YUV420P;
  spec.states_colours = false;
  spec.matrix = AVCOL_SPC_SMPTE170M;
  write_video(folder / "trimmed.mp4", spec);
  const auto source = open_video(folder / "trimmed.mp4", kVideoSize, {}, std::nullopt);
  EXPECT_EQ(source->frame_count(), 12);
  const auto frames = all_frames(*source);
  ASSERT_EQ(frames.size(), 12u);
  for (int i = 0; i < 12; ++i) {
    const Frame& frame = frames[static_cast<std::size_t>(i)];
    EXPECT_EQ(frame.index, i);
    EXPECT_NEAR(frame.time_s, 0.04 * i, 1e-4);
    EXPECT_EQ(number_of(frame.image), 12 + i);
  }
  EXPECT_EQ(source->report().damaged, 0);
}

TEST(VideoTurns, StoredPixelsAreTakenUnlessTheCameraIsForTurnedOnes) {
  const TemporaryFolder folder;
  for (const double degrees : {90.0, 180.0, 270.0}) {
    VideoSpec spec = numbered(2);
    spec.codec = AV_CODEC_ID_MPEG4;
    spec.format = AV_PIX_FMT_YUV420P;
    spec.states_colours = false;
    spec.matrix = AVCOL_SPC_SMPTE170M;
    spec.clockwise_degrees = degrees;
    spec.colour = [](int /*frame*/, bool is_right) {
      return Eigen::Vector3d::Constant(is_right ? 0.8 : 0.2).eval();
    };
    write_video(folder / "turned.mp4", spec);
    const auto stored = open_video(folder / "turned.mp4", kVideoSize, {}, std::nullopt);
    const cv::Mat image = stored->next()->image;
    EXPECT_LT(image.at<cv::Vec3b>(24, 16)[0], 100);
    EXPECT_GT(image.at<cv::Vec3b>(24, 48)[0], 150);
    while (stored->next()) {
    }
    EXPECT_TRUE(says(stored->report(), "turned by " + std::to_string(std::lround(degrees))));
    if (degrees == 180) continue;
    // Clockwise by a quarter the left half comes to the top.
    const auto upright = open_video(folder / "turned.mp4", {48, 64}, {}, std::nullopt);
    const cv::Mat shown = upright->next()->image;
    ASSERT_EQ(shown.size(), cv::Size(48, 64));
    const bool is_dark_above = shown.at<cv::Vec3b>(16, 24)[0] < 100;
    EXPECT_EQ(is_dark_above, degrees == 90);
  }
}

// Stored 64 x 48 of pixels 4 : 3, shown 85 x 48. Of the stored pixels fy / fx is 4 / 3. AVI files
// of JPEG images have a reader of their own.
TEST(VideoPixels, ThatAreNotSquareAreToldToTheCameraFile) {
  const TemporaryFolder folder;
  VideoSpec matroska = numbered(2);
  VideoSpec avi = matroska;
  avi.codec = AV_CODEC_ID_MJPEG;
  avi.format = AV_PIX_FMT_YUVJ444P;
  avi.states_colours = false;
  for (const auto& file : {std::pair("wide.mkv", matroska), std::pair("wide.avi", avi)}) {
    const char* const name = file.first;
    VideoSpec wide = file.second;
    wide.pixel_aspect = 4.0 / 3;
    write_video(folder / name, wide);
    EXPECT_NEAR(video_pixel_aspect(folder / name), 4.0 / 3, 1e-3);
    const auto notes = [&](std::optional<double> focal_ratio) {
      const auto source = open_video(folder / name, kVideoSize, {}, std::nullopt, focal_ratio);
      while (source->next()) {
      }
      return source->report();
    };
    EXPECT_TRUE(says(notes(1.0), "pixels 1.333 times as wide as high")) << name;
    EXPECT_FALSE(says(notes(4.0 / 3), "as wide as high")) << name;
    EXPECT_FALSE(says(notes(std::nullopt), "as wide as high")) << name;
    expect_bad_input(
        [&] {
          (void)open_video(folder / name, {85, 48}, {}, std::nullopt);
        },
        name, "stored as 64x48", "by 0.75");

    write_video(folder / name, file.second);
    EXPECT_EQ(video_pixel_aspect(folder / name), 1);
    EXPECT_FALSE(says(notes(1.2), "as wide as high")) << name;
  }
}

TEST(VideoFiles, DamagedFramesAreLeftOutAndCounted) {
  const TemporaryFolder folder;
  VideoSpec spec = numbered(20);
  spec.codec = AV_CODEC_ID_PNG;  // every image by itself
  spec.format = AV_PIX_FMT_RGB24;
  spec.damaged = {3, 4, 11};
  write_video(folder / "damaged.mkv", spec);
  const auto source = open_video(folder / "damaged.mkv", kVideoSize, {}, std::nullopt);
  const auto frames = all_frames(*source);
  std::vector<int> indices;
  for (const Frame& frame : frames) indices.push_back(frame.index);
  std::vector<int> whole;
  for (int i = 0; i < 20; ++i) {
    if (!spec.damaged.contains(i)) whole.push_back(i);
  }
  EXPECT_EQ(indices, whole);
  for (const Frame& frame : frames) {
    // Those after a damaged one keep their places and times.
    EXPECT_EQ(number_of(frame.image), frame.index);
    EXPECT_NEAR(frame.time_s, 0.04 * frame.index, 1e-6);
  }
  EXPECT_EQ(source->report().damaged, 3);
}

TEST(VideoFiles, NamesWithColonsAndPerCentsAreNames) {
  const TemporaryFolder folder;
  const std::string name = "http:100%d 10:30.mkv";
  write_video(folder / name, numbered(3));
  EXPECT_EQ(all_frames(*open_video(folder / name, kVideoSize, {}, std::nullopt)).size(), 3u);
}

// Cut where the index begins, and in the middle of the images before it: what a recorder leaves
// that was switched off.
TEST(VideoFiles, AnUnfinishedRecordingIsCalledOne) {
  const TemporaryFolder folder;
  VideoSpec spec = numbered(4);
  spec.codec = AV_CODEC_ID_MPEG4;
  spec.format = AV_PIX_FMT_YUV420P;
  spec.states_colours = false;
  write_video(folder / "whole.mp4", spec);
  const std::string whole = tests::read_file(folder / "whole.mp4");
  const std::size_t index = whole.find("moov") - 4;
  ASSERT_LT(whole.find("mdat"), index);
  for (const std::size_t size : {index, (whole.find("mdat") + index) / 2}) {
    const auto path = folder.write("cut.mp4", whole.substr(0, size));
    expect_bad_input([&] { (void)open_video(path, kVideoSize, {}, std::nullopt); }, "cut.mp4",
                     "not finished", "moov");
  }
}

TEST(VideoFiles, EveryFileCutShortIsReadOrRefused) {
  const TemporaryFolder folder;
  write_video(folder / "whole.mkv", numbered(4));
  const std::string whole = tests::read_file(folder / "whole.mkv");
  for (std::size_t size = 0; size < whole.size(); size += 97) {
    const auto path = folder.write("cut.mkv", whole.substr(0, size));
    try {
      EXPECT_LE(all_frames(*open_video(path, kVideoSize, {}, std::nullopt)).size(), 4u);
    } catch (const core::Error& error) {
      EXPECT_EQ(error.kind(), core::Error::Kind::bad_input);
    }
  }
}

}  // namespace
}  // namespace sheen::capture::test
