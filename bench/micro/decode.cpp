// SPDX-License-Identifier: MIT
// From recorded bytes to pixels: our reader against FFmpeg and OpenCV on the same 1280x720
// recording, the ways to get a grey plane besides, and what packing a raw image costs.
#include "capture/session/avi_writer.h"
#include "capture/source/jpeg_decoder.h"
#include "capture/source/jpeg_encoder.h"
#include "capture/source/video_source.h"

#include <benchmark/benchmark.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <turbojpeg.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <vector>

namespace {

using namespace sheen::capture;
using Bytes = std::vector<std::uint8_t>;

constexpr ImageSize kSize{1280, 720};
constexpr int kFrames = 60;
constexpr int kQuality = 88;  // gives images of the size that cameras deliver

/// The sample recording at a camera's size, 4:2:0.
class Recording {
 public:
  Recording() {
    std::string folder = (std::filesystem::temp_directory_path() / "sheen-XXXXXX").string();
    folder_ = mkdtemp(folder.data());
    cv::VideoCapture sample(SHEEN_SOURCE_DIR "/sample_data/glossy/frames.avi");
    AviWriter writer(path(), kSize, 30);
    cv::Mat image;
    for (int i = 0; i < kFrames && sample.read(image); ++i) {
      cv::resize(image, image, {kSize.width_px, kSize.height_px}, 0, 0, cv::INTER_CUBIC);
      cv::randn(noise_, 0, 3);
      image += noise_;
      cv::imencode(".jpg", image, jpegs_.emplace_back(), {cv::IMWRITE_JPEG_QUALITY, kQuality});
      if (writer.append(jpegs_.back()) != 0) std::abort();
    }
    if (writer.close() != 0) std::abort();
    last_ = image;
  }
  ~Recording() { std::filesystem::remove_all(folder_); }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  Recording(Recording&&) = delete;
  Recording& operator=(Recording&&) = delete;

  [[nodiscard]] std::filesystem::path path() const { return folder_ / "frames.avi"; }
  [[nodiscard]] const Bytes& jpeg(std::size_t i) const { return jpegs_[i % jpegs_.size()]; }
  [[nodiscard]] const cv::Mat& image() const { return last_; }
  [[nodiscard]] double mean_kilobytes() const {
    double sum = 0;
    for (const Bytes& jpeg : jpegs_) sum += static_cast<double>(jpeg.size());
    return sum / static_cast<double>(jpegs_.size()) / 1000;
  }

 private:
  std::filesystem::path folder_;
  std::vector<Bytes> jpegs_;
  cv::Mat noise_ = cv::Mat(kSize.height_px, kSize.width_px, CV_8UC3);
  cv::Mat last_;
};

const Recording& recording() {
  static const Recording instance;
  return instance;
}

void name_size(benchmark::State& state) {
  state.counters["kB"] = recording().mean_kilobytes();
}

void our_reader(benchmark::State& state) {
  const auto open = [] { return open_video(recording().path(), kSize, {}, std::nullopt); };
  auto source = open();
  for (auto _ : state) {
    auto frame = source->next();
    if (!frame) {
      source = open();
      frame = source->next();
    }
    benchmark::DoNotOptimize(frame->image.data);
  }
  name_size(state);
}

void ffmpeg_reader(benchmark::State& state) {
  cv::VideoCapture capture(recording().path().string(), cv::CAP_FFMPEG);
  cv::Mat image;
  for (auto _ : state) {
    if (!capture.read(image)) {
      capture.open(recording().path().string(), cv::CAP_FFMPEG);
      capture.read(image);
    }
    benchmark::DoNotOptimize(image.data);
  }
  name_size(state);
}

void opencv_decode(benchmark::State& state) {
  std::size_t i = 0;
  for (auto _ : state) {
    const cv::Mat image = cv::imdecode(recording().jpeg(i++), cv::IMREAD_COLOR);
    benchmark::DoNotOptimize(image.data);
  }
  name_size(state);
}

void our_decode(benchmark::State& state) {
  std::size_t i = 0;
  cv::Mat image;
  for (auto _ : state) benchmark::DoNotOptimize(decode_jpeg(recording().jpeg(i++), kSize, image));
  name_size(state);
}

void our_decode_then_grey(benchmark::State& state) {
  std::size_t i = 0;
  cv::Mat image, grey;
  for (auto _ : state) {
    benchmark::DoNotOptimize(decode_jpeg(recording().jpeg(i++), kSize, image));
    cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  }
  name_size(state);
}

/// The luma plane comes for free, but chroma is no longer interpolated between its samples.
void planes_then_colour(benchmark::State& state) {
  const int width = kSize.width_px, height = kSize.height_px;
  cv::Mat image(height, width, CV_8UC3);
  std::array<Bytes, 3> planes{Bytes(static_cast<std::size_t>(width * height)),
                              Bytes(static_cast<std::size_t>(width * height / 4)),
                              Bytes(static_cast<std::size_t>(width * height / 4))};
  std::array<unsigned char*, 3> out{planes[0].data(), planes[1].data(), planes[2].data()};
  std::array<const unsigned char*, 3> in{out[0], out[1], out[2]};
  const tjhandle codec = tjInitDecompress();
  std::size_t i = 0;
  for (auto _ : state) {
    const Bytes& jpeg = recording().jpeg(i++);
    tjDecompressToYUVPlanes(codec, jpeg.data(), jpeg.size(), out.data(), width, nullptr, height, 0);
    tjDecodeYUVPlanes(codec, in.data(), nullptr, TJSAMP_420, image.data, width, 0, height, TJPF_BGR,
                      0);
  }
  tjDestroy(codec);
  name_size(state);
}

/// A raw image as a camera delivers it; what its values are does not matter.
void pack_yuyv(benchmark::State& state) {
  cv::Mat yuv;
  cv::cvtColor(recording().image(), yuv, cv::COLOR_BGR2YUV);
  Bytes raw;
  for (int y = 0; y < yuv.rows; ++y) {
    for (int x = 0; x < yuv.cols; ++x) {
      const auto& pixel = yuv.at<cv::Vec3b>(y, x);
      raw.push_back(pixel[0]);
      raw.push_back(pixel[x % 2 == 0 ? 1 : 2]);
    }
  }
  const CameraBuffer buffer{PixelFormat::yuyv, raw, kSize.width_px, kSize.height_px, 0, 0, 0};
  JpegEncoder encoder;
  std::size_t bytes = 0;
  for (auto _ : state) bytes = encoder.encode(buffer).size();
  state.counters["kB"] = static_cast<double>(bytes) / 1000;
  state.counters["raw kB"] = static_cast<double>(raw.size()) / 1000;
}

BENCHMARK(our_reader)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(ffmpeg_reader)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(opencv_decode)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(our_decode)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(our_decode_then_grey)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(planes_then_colour)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(pack_yuyv)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

}  // namespace
