// SPDX-License-Identifier: MIT
// Depth images of a session: numbers, sizes, and files that are not what they should be.
#include "capture/session/depth_images.h"

#include "capture/calibration/camera_file.h"
#include "capture/session/session_file.h"
#include "tests/capture/expect_bad_input.h"
#include "tests/capture/rendered_board.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <string>
#include <vector>

namespace sheen::capture::test {
namespace {

constexpr int kWidth = 8, kHeight = 6;

/// A session of which only the depth images are there.
class DepthFolder {
 public:
  DepthFolder() {
    std::filesystem::create_directories(folder_.path() / "depth");
    session_.folder = folder_.path();
    session_.camera = make_camera(kWidth, kHeight, false);
    session_.depth = DepthFiles{"depth/%04d.png", 0.001};
  }

  [[nodiscard]] std::filesystem::path path(int number) const {
    return folder_.path() / "depth" / ("000" + std::to_string(number) + ".png");
  }
  void write(int number, const cv::Mat& image) const { cv::imwrite(path(number).string(), image); }
  [[nodiscard]] cv::Mat read(int frame_index) const {
    return DepthImages(session_).read(frame_index);
  }

  Session session_;

 private:
  tests::TemporaryFolder folder_;
};

cv::Mat numbered(int width, int height) {
  cv::Mat image(height, width, CV_16UC1);
  for (int i = 0; i < width * height; ++i)
    image.at<std::uint16_t>(i) = static_cast<std::uint16_t>(100 * i);
  return image;
}

TEST(DepthImages, StepsBecomeMetres) {
  DepthFolder folder;
  cv::Mat image = numbered(kWidth, kHeight);
  image.at<std::uint16_t>(1, 2) = 65535;  // more than 16 bits hold
  folder.write(0, image);
  folder.session_.depth->unit_m = 0.0002;
  const cv::Mat depth_m = folder.read(0);
  ASSERT_EQ(depth_m.type(), CV_32FC1);
  EXPECT_EQ(depth_m.at<float>(0, 0), 0);
  EXPECT_EQ(depth_m.at<float>(1, 2), 0);
  // 100 (8 y + x) steps of .2 mm.
  EXPECT_FLOAT_EQ(depth_m.at<float>(3, 5), 0.02f * 29);
}

// Half as many pixels cover two by two of the frame's; where three times as many do, the one in the
// middle counts. Nothing is mixed.
TEST(DepthImages, OtherSizesAreReadAtTheNearestPixel) {
  const DepthFolder folder;
  folder.write(0, numbered(kWidth / 2, kHeight / 2));
  folder.write(1, numbered(3 * kWidth, 3 * kHeight));
  const cv::Mat coarse = folder.read(0), fine = folder.read(1);
  ASSERT_EQ(coarse.size(), cv::Size(kWidth, kHeight));
  ASSERT_EQ(fine.size(), cv::Size(kWidth, kHeight));
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      EXPECT_FLOAT_EQ(coarse.at<float>(y, x),
                      0.1f * static_cast<float>(y / 2 * kWidth / 2 + x / 2));
      EXPECT_FLOAT_EQ(fine.at<float>(y, x),
                      0.1f * static_cast<float>((3 * y + 1) * 3 * kWidth + 3 * x + 1));
    }
  }
}

TEST(DepthImages, AreCountedFromTheirFirstNumber) {
  const DepthFolder folder;
  folder.write(1, numbered(kWidth, kHeight));
  folder.write(2, cv::Mat::ones(kHeight, kWidth, CV_16UC1));
  EXPECT_FLOAT_EQ(folder.read(1).at<float>(2, 3), 0.001f);
}

TEST(DepthImages, WhatIsMissingIsNamed) {
  const DepthFolder folder;
  expect_bad_input([&] { static_cast<void>(folder.read(0)); }, "0000.png", "no such image");
  folder.write(0, numbered(kWidth, kHeight));
  expect_bad_input([&] { static_cast<void>(folder.read(1)); }, "0001.png", "frame 1",
                   "session.json");
  folder.write(2, numbered(kWidth, kHeight));
  expect_bad_input([&] { static_cast<void>(folder.read(0)); }, "0001.png", "missing");
}

TEST(DepthImages, OtherPicturesAreRefused) {
  const DepthFolder folder;
  const auto refused = [&](const cv::Mat& image, const std::string& word) {
    folder.write(0, image);
    expect_bad_input([&] { static_cast<void>(folder.read(0)); }, "0000.png", word);
  };
  refused(cv::Mat::ones(kHeight, kWidth, CV_8UC1), "16 bits");
  refused(cv::Mat::ones(kHeight, kWidth, CV_16UC3), "16 bits");
  refused(cv::Mat::ones(kWidth, kHeight, CV_16UC1), "6 x 8 pixels");
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", cv::Mat::ones(kHeight, kWidth, CV_8UC1), jpeg);
  tests::write_file(folder.path(0), {jpeg.begin(), jpeg.end()});
  expect_bad_input([&] { static_cast<void>(folder.read(0)); }, "0000.png", "16 bits");
}

// Cut anywhere: refused on one line. Altered anywhere: read or refused.
TEST(DepthImages, DamagedFilesAreReadOrRefused) {
  const DepthFolder folder;
  folder.write(0, numbered(kWidth, kHeight));
  const std::string whole = tests::read_file(folder.path(0));
  for (std::size_t length = 0; length + 12 < whole.size(); ++length) {  // without its end mark, too
    tests::write_file(folder.path(0), whole.substr(0, length));
    expect_bad_input([&] { static_cast<void>(folder.read(0)); }, "0000.png");
  }
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const char byte : {'\0', '\x7f', '\xff'}) {
      std::string altered = whole;
      altered[at] = byte;
      tests::write_file(folder.path(0), altered);
      try {
        static_cast<void>(folder.read(0));
      } catch (const core::Error& error) {
        EXPECT_EQ(error.kind(), core::Error::Kind::bad_input);
      }
    }
  }
}

// Sides of 2^15 pixels in a hundred bytes.
TEST(DepthImages, TakeNoMemoryForWhatBytesCannotHold) {
  const DepthFolder folder;
  folder.write(0, numbered(kWidth, kHeight));
  std::string bytes = tests::read_file(folder.path(0));
  bytes.replace(16, 8, std::string("\0\0\x80\0\0\0\x60\0", 8));
  tests::write_file(folder.path(0), bytes);
  expect_bad_input([&] { static_cast<void>(folder.read(0)); }, "cut short");
}

// ---- what session.json says of them ----

TEST(DepthFiles, ComeBackFromSessionJson) {
  const tests::TemporaryFolder folder;
  write_camera(folder.path() / "camera.yaml", make_camera(64, 48, false));
  folder.write("poses.txt", "0 0 0 0 0 0 0 1\n");
  folder.write("object.ply", "ply\n");
  write_session_file(folder.path(), {.images = "images/%04d.png",
                                     .depth = DepthFiles{"depth/%d.png", 0.00025},
                                     .poses = "poses.txt"});
  const Session session = open_session(folder.path());
  EXPECT_TRUE(session.warnings.empty());
  EXPECT_EQ(session.depth.value().pattern, "depth/%d.png");
  EXPECT_EQ(session.depth->unit_m, 0.00025);

  // Spoilt.
  using nlohmann::json;
  const json whole = json::parse(tests::read_file(folder.path() / "session.json"));
  const auto refused = [&](const json& depth, const std::string& word) {
    json document = whole;
    document["depth"] = depth;
    folder.write("session.json", document.dump());
    expect_bad_input([&] { static_cast<void>(open_session(folder.path())); }, "session.json", word);
  };
  refused(7, "\"depth\"");
  refused(json::object(), "\"images\"");
  refused({{"images", "depth.png"}, {"unit_m", 0.001}}, "depth/%04d.png");
  refused({{"images", "../%04d.png"}, {"unit_m", 0.001}}, "leaves");
  refused({{"images", "depth/%s%04d.png"}, {"unit_m", 0.001}}, "pattern");
  refused({{"images", "depth/%04d.png"}}, "millimetres");
  for (const json& unit : {json(0), json(-1), json(1000), json("mm"), json(nullptr)}) {
    refused({{"images", "depth/%04d.png"}, {"unit_m", unit}}, "unit_m");
  }
}

}  // namespace
}  // namespace sheen::capture::test
