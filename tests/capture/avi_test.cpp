// SPDX-License-Identifier: MIT
#include "capture/session/avi_writer.h"
#include "capture/source/avi_reader.h"
#include "capture/source/video_source.h"
#include "tests/capture/expect_bad_input.h"
#include "tests/capture/power_cut.h"
#include "tests/capture/recording_frames.h"

#include <gtest/gtest.h>
#include <opencv2/videoio.hpp>

#include <fstream>
#include <random>

namespace sheen::capture::test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using tests::TemporaryFolder;

std::vector<Bytes> images(int count) {
  std::vector<Bytes> result;
  for (int i = 0; i < count; ++i) result.push_back(recorded_jpeg(i));
  return result;
}

std::vector<Bytes> read_all(const std::filesystem::path& path) {
  std::vector<Bytes> result;
  auto reader = AviReader::open(path);
  while (reader && reader->advance()) {
    const auto bytes = reader->read();
    result.emplace_back(bytes.begin(), bytes.end());
  }
  return result;
}

Bytes file_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const std::filesystem::path& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
}

/// Small segments, so that a short recording has several; large ones are of the same kind.
class AviOfSegments : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Bytes, AviOfSegments,
                         testing::Values(AviWriter::kSegmentBytes, std::uint64_t{6000}));

TEST_P(AviOfSegments, ComesBackBitForBit) {
  const TemporaryFolder scratch;
  const auto path = scratch.path() / "v.avi";
  const auto expected = images(40);
  AviWriter writer(path, kRecordedSize, 30, GetParam());
  for (const Bytes& image : expected) ASSERT_EQ(writer.append(image), 0);
  EXPECT_EQ(read_all(path), expected) << "open";
  EXPECT_FALSE(AviReader::open(path)->header().frames);
  ASSERT_EQ(writer.close(), 0);
  EXPECT_EQ(read_all(path), expected) << "closed";
  const AviHeader header = AviReader::open(path)->header();
  EXPECT_EQ(header.codec, "MJPG");
  EXPECT_EQ(header.size, kRecordedSize);
  EXPECT_EQ(header.fps, 30);
  EXPECT_EQ(header.frames, 40);
}

TEST_P(AviOfSegments, IsReadByFfmpeg) {
  const TemporaryFolder scratch;
  const auto path = scratch.path() / "v.avi";
  AviWriter writer(path, kRecordedSize, 25, GetParam());
  for (const Bytes& image : images(40)) ASSERT_EQ(writer.append(image), 0);
  const auto expect_frames = [&] {
    cv::VideoCapture capture(path.string(), cv::CAP_FFMPEG);
    cv::Mat image;
    int frames = 0;
    for (; capture.read(image); ++frames) EXPECT_EQ(recorded_index(image), frames);
    EXPECT_EQ(frames, 40);
    EXPECT_EQ(capture.get(cv::CAP_PROP_FPS), 25);
  };
  expect_frames();  // as after a crash
  ASSERT_EQ(writer.close(), 0);
  expect_frames();
}

TEST(Avi, OfFfmpegIsReadAsFfmpegReadsIt) {
  const TemporaryFolder scratch;
  const auto path = scratch.path() / "v.avi";
  {
    cv::VideoWriter writer(path.string(), cv::CAP_FFMPEG,
                           cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25,
                           {kRecordedSize.width_px, kRecordedSize.height_px});
    ASSERT_TRUE(writer.isOpened());
    for (int i = 0; i < 40; ++i) {
      writer.write(cv::Mat(kRecordedSize.height_px, kRecordedSize.width_px, CV_8UC3,
                           cv::Scalar::all(20 + 5 * i)));
    }
  }
  cv::VideoCapture reference(path.string(), cv::CAP_FFMPEG);
  const auto source = open_video(path, kRecordedSize, {}, std::nullopt);
  EXPECT_EQ(source->frame_count(), 40);
  cv::Mat expected;
  while (reference.read(expected)) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    // Flat grey: two roundings of one transform.
    EXPECT_LE(cv::norm(frame->image, expected, cv::NORM_INF), 2);
    EXPECT_NEAR(frame->time_s, frame->index / 25.0, 1e-9);
  }
  EXPECT_FALSE(source->next());
}

TEST(Avi, CutAnywhereGivesTheImagesBeforeTheCut) {
  const TemporaryFolder scratch;
  const auto path = scratch.path() / "v.avi";
  const auto expected = images(20);
  AviWriter writer(path, kRecordedSize, 30);
  std::vector<std::uint64_t> ends;  // of the file after each image
  for (const Bytes& image : expected) {
    ASSERT_EQ(writer.append(image), 0);
    ends.push_back(std::filesystem::file_size(path));
  }
  const Bytes whole = file_bytes(path);
  std::mt19937 random(3);
  const auto cut_path = scratch.path() / "cut.avi";
  for (int i = 0; i < 200; ++i) {
    const std::size_t length = random() % (whole.size() + 1);
    Bytes bytes(whole.begin(), whole.begin() + static_cast<long>(length));
    // What a crash may leave behind the cut: nothing, zeros, or whatever was on the disk. The last
    // image's padding byte is not missed.
    if (i % 3 == 1) bytes.resize(bytes.size() + 300, 0);
    if (i % 3 == 2) {
      for (int k = 0; k < 300; ++k)
        bytes.push_back(static_cast<std::uint8_t>(128 + random() % 128));
    }
    write_bytes(cut_path, bytes);
    const auto found = read_all(cut_path);
    std::size_t complete = 0;
    while (complete < ends.size() && ends[complete] <= length) ++complete;
    ASSERT_GE(found.size(), complete) << "cut at " << length;
    for (std::size_t k = 0; k < complete; ++k) EXPECT_EQ(found[k], expected[k]);
    // The one that was cut may be filled up by what follows; the decoder refuses it.
    EXPECT_LE(found.size(), complete + 1) << "cut at " << length;
  }
}

// What was flushed is there bit for bit, whatever of later writes came to the disk: those of more
// images, of a segment's end and of closing, which changes the beginnings of file and segments,
// too.
TEST_P(AviOfSegments, LosesNothingFlushedToAPowerCut) {
  const TemporaryFolder scratch;
  const auto path = scratch.path() / "v.avi";
  const auto sent = images(40);
  AviWriter writer(path, kRecordedSize, 30, GetParam());
  std::vector<std::string> after;  // each image
  for (const Bytes& image : sent) {
    ASSERT_EQ(writer.append(image), 0);
    after.push_back(tests::read_file(path));
  }
  ASSERT_EQ(writer.close(), 0);
  const std::string closed = tests::read_file(path);
  std::mt19937 random(7);
  for (int attempt = 0; attempt < 200; ++attempt) {
    const std::size_t flushed = 1 + random() % (sent.size() - 1);  // images
    const std::size_t last = flushed + random() % (sent.size() - flushed);
    const bool is_closing = attempt % 2 == 0;
    const auto cut = scratch.write(
        "cut.avi", after_power_cut(after[flushed - 1], is_closing ? closed : after[last], random));
    const auto left = read_all(cut);
    ASSERT_GE(left.size(), flushed) << attempt;
    EXPECT_TRUE(std::equal(sent.begin(), sent.begin() + static_cast<long>(flushed), left.begin()))
        << "attempt " << attempt;
  }
}

TEST(Avi, SurvivesAnyBytes) {
  const TemporaryFolder scratch;
  const auto path = scratch.path() / "v.avi";
  {
    AviWriter writer(path, kRecordedSize, 30, 6000);
    for (const Bytes& image : images(20)) ASSERT_EQ(writer.append(image), 0);
    ASSERT_EQ(writer.close(), 0);
  }
  const Bytes whole = file_bytes(path);
  std::mt19937 random(5);
  const auto spoilt_path = scratch.path() / "spoilt.avi";
  for (int i = 0; i < 300; ++i) {
    Bytes bytes = whole;
    for (int k = 0; k < 6; ++k) {
      // Mostly in the headers and chunk heads, where it matters.
      const std::size_t place = random() % (i % 2 == 0 ? std::size_t{400} : bytes.size());
      bytes[place] = static_cast<std::uint8_t>(random());
    }
    write_bytes(spoilt_path, bytes);
    std::size_t total = 0;
    for (const Bytes& image : read_all(spoilt_path)) total += image.size();
    EXPECT_LE(total, bytes.size());  // nothing is read twice or made up
  }
}

TEST(Avi, IsNotWrittenOverAnother) {
  const TemporaryFolder scratch;
  const auto path = scratch.write("v.avi", "precious");
  expect_bad_input([&] { AviWriter(path, kRecordedSize, 30); }, "v.avi", "cannot be made");
  EXPECT_EQ(file_bytes(path).size(), 8U);
}

TEST(MotionJpeg, LeavesDamagedImagesOut) {
  const TemporaryFolder scratch;
  const auto path = scratch.path() / "v.avi";
  AviWriter writer(path, kRecordedSize, 30);
  for (int i = 0; i < 10; ++i) {
    Bytes image = recorded_jpeg(i);
    if (i % 3 == 0) image.resize(image.size() / 2);
    ASSERT_EQ(writer.append(image), 0);
  }
  ASSERT_EQ(writer.close(), 0);
  const auto source = open_video(path, kRecordedSize, {}, std::nullopt);
  for (const int index : {1, 2, 4, 5, 7, 8}) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, index);
    EXPECT_EQ(recorded_index(frame->image), index);
    EXPECT_DOUBLE_EQ(frame->time_s, index / 30.0);
  }
  EXPECT_FALSE(source->next());
}

}  // namespace
}  // namespace sheen::capture::test
