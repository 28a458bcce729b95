// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/tag_detector.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace sheen::pipeline {

/// The tags of at most so many views, spread evenly over a recording of unknown length: when there
/// are too many every second one is dropped, and from then on every second one is left out.
class SpreadViews {
 public:
  using Tags = std::vector<capture::TagDetection>;

  explicit SpreadViews(std::size_t most) : most_(most) {}

  /// To be asked once for every frame in order.
  [[nodiscard]] bool wants_next() { return frames_++ % stride_ == 0; }

  void add(Tags tags) {
    views_.push_back(std::move(tags));
    if (views_.size() < most_) return;
    for (std::size_t i = 0; 2 * i < views_.size(); ++i) views_[i] = std::move(views_[2 * i]);
    views_.resize((views_.size() + 1) / 2);
    stride_ *= 2;
  }

  [[nodiscard]] const std::vector<Tags>& views() const { return views_; }

 private:
  std::size_t most_;
  std::size_t frames_ = 0;
  std::size_t stride_ = 1;
  std::vector<Tags> views_;
};

}  // namespace sheen::pipeline
