// SPDX-License-Identifier: MIT
#include "capture/source/read_ahead_source.h"

#include "core/concurrency/bounded_queue.h"

#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <variant>

namespace sheen::capture {
namespace {

constexpr std::size_t kMostWaiting = 3;  // images in full size: enough to even out the decoder

class ReadAheadSource : public FrameSource {
 public:
  explicit ReadAheadSource(std::unique_ptr<FrameSource> source)
      : source_(std::move(source)),
        frame_count_(source_->frame_count()),
        reader_([this] { read_all(); }) {}

  ~ReadAheadSource() override { frames_.close(); }  // wakes the reader, which is then joined
  ReadAheadSource(const ReadAheadSource&) = delete;
  ReadAheadSource& operator=(const ReadAheadSource&) = delete;
  ReadAheadSource(ReadAheadSource&&) = delete;
  ReadAheadSource& operator=(ReadAheadSource&&) = delete;

  std::optional<Frame> next() override {
    auto item = frames_.pop();
    if (!item) return std::nullopt;
    if (const auto* failure = std::get_if<std::exception_ptr>(&*item)) {
      std::rethrow_exception(*failure);
    }
    return std::get<Frame>(std::move(*item));
  }

  [[nodiscard]] std::optional<int> frame_count() const override { return frame_count_; }

  [[nodiscard]] SourceReport report() const override {
    const std::scoped_lock lock(report_mutex_);
    return report_;
  }

 private:
  void note_report() {
    SourceReport report = source_->report();
    const std::scoped_lock lock(report_mutex_);
    report_ = std::move(report);
  }

  void read_all() {
    try {
      while (auto frame = source_->next()) {
        note_report();
        if (!frames_.push(std::move(*frame))) return;
      }
      note_report();
    } catch (...) {
      static_cast<void>(frames_.push(std::current_exception()));  // nobody listens any more
    }
    frames_.close();
  }

  std::unique_ptr<FrameSource> source_;
  std::optional<int> frame_count_;
  mutable std::mutex report_mutex_;
  SourceReport report_;  ///< of the source, by the frame read last
  /// Filled by `reader_`. A fault of the source stands in the queue behind the frames before it, so
  /// that those are delivered first; the end of the source closes it, and what waits is delivered.
  /// Whoever destroys this gives up what waits; the reader then ends with the frame it is reading.
  core::BoundedQueue<std::variant<Frame, std::exception_ptr>> frames_{kMostWaiting};
  std::jthread reader_;  ///< last: it uses all of the above
};

}  // namespace

std::unique_ptr<FrameSource> read_ahead(std::unique_ptr<FrameSource> source) {
  return std::make_unique<ReadAheadSource>(std::move(source));
}

}  // namespace sheen::capture
