// SPDX-License-Identifier: MIT
#include "capture/session/frame_stamps.h"

#include "capture/files/text_file.h"
#include "core/diagnostics/error.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>
#include <utility>

namespace sheen::capture {
namespace {

constexpr std::size_t kMaxStampBytes = std::size_t{1} << 28;
constexpr double kMicroseconds = 1e6;

/// The time in the line of frame `index`; nothing when it is no such line.
std::optional<double> parse_line(std::string_view line, std::size_t index) {
  std::size_t number = 0;
  const char* const end = line.data() + line.size();
  const auto [comma, status] = std::from_chars(line.data(), end, number);
  if (status != std::errc() || number != index || comma == end || *comma != ',') {
    return std::nullopt;
  }
  double time_s = 0;
  const auto [stop, time_status] = std::from_chars(comma + 1, end, time_s);
  const bool is_time = time_status == std::errc() && std::isfinite(time_s) && time_s >= 0;
  if (!is_time || stop == end || *stop != ',') return std::nullopt;
  return time_s;
}

class StampedSource : public FrameSource {
 public:
  StampedSource(std::unique_ptr<FrameSource> source, std::vector<double> times_s)
      : source_(std::move(source)), times_s_(std::move(times_s)) {}

  std::optional<Frame> next() override {
    auto frame = source_->next();
    if (!frame) return frame;
    const auto i = static_cast<std::size_t>(frame->index);
    frame->time_s = times_s_.at(i);
    const std::size_t next = std::min(i + 1, times_s_.size() - 1);
    frame->spacing_s = i > 0 ? times_s_[i] - times_s_[i - 1] : times_s_[next] - times_s_[0];
    return frame;
  }

  bool skip() override { return source_->skip(); }

  [[nodiscard]] std::optional<int> frame_count() const override { return source_->frame_count(); }

  [[nodiscard]] SourceReport report() const override { return source_->report(); }

 private:
  std::unique_ptr<FrameSource> source_;
  std::vector<double> times_s_;
};

}  // namespace

std::string stamps_heading() {
  return "frame,time_s,sequence\n";
}

std::string stamp_line(int index, std::int64_t time_us, std::uint32_t sequence) {
  std::array<char, 64> line{};
  const int length =
      std::snprintf(line.data(), line.size(), "%d,%" PRId64 ".%06" PRId64 ",%" PRIu32 "\n", index,
                    time_us / 1'000'000, time_us % 1'000'000, sequence);
  return {line.data(), static_cast<std::size_t>(length)};
}

double stamp_seconds(std::int64_t time_us) {
  return static_cast<double>(time_us) / kMicroseconds;  // rounded once, as the text is when read
}

std::vector<double> read_stamps(const std::filesystem::path& path) {
  const std::string text = read_text_file(path, kMaxStampBytes);
  const auto fail = [&](const std::string& fault) {
    return core::bad_input(path, fault, "see docs/session-format.md");
  };
  if (!text.starts_with(stamps_heading())) throw fail("does not begin with frame,time_s,sequence");

  std::vector<double> times_s;
  std::size_t begin = stamps_heading().size();
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) break;
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    // What a crash leaves: a line without an end, or zeros where a block has not come to the disk.
    if (line.find('\0') != std::string_view::npos) break;
    const auto time_s = parse_line(line, times_s.size());
    if (!time_s) throw fail("line " + std::to_string(times_s.size() + 2) + " is no time stamp");
    if (!times_s.empty() && *time_s < times_s.back()) {
      throw fail("line " + std::to_string(times_s.size() + 2) + " goes back in time");
    }
    times_s.push_back(*time_s);
    begin = end + 1;
  }
  return times_s;
}

std::unique_ptr<FrameSource> with_stamps(std::unique_ptr<FrameSource> source,
                                         std::vector<double> times_s) {
  return std::make_unique<StampedSource>(std::move(source), std::move(times_s));
}

}  // namespace sheen::capture
