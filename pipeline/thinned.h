// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace sheen::pipeline {

/// Items of evenly spaced frames of a recording whose length is not known: every
/// `spacing`-th at first; whenever `most` are kept, every second one goes and the spacing doubles.
/// Between most / 2 and most items stay, and at most (1 + log2(frames / most)) * most frames are
/// ever looked at.
template <typename Item>
class Thinned {
 public:
  explicit Thinned(std::size_t most, std::size_t spacing = 1) : most_(most), spacing_(spacing) {}

  /// Whether the next frame is to be looked at. Asked once for every frame.
  bool is_due() { return frames_++ % spacing_ == 0; }

  /// The item of the frame that was due.
  void add(Item item) {
    items_.push_back(std::move(item));
    if (items_.size() < most_) return;
    for (std::size_t i = 0; 2 * i < items_.size(); ++i) items_[i] = std::move(items_[2 * i]);
    items_.resize((items_.size() + 1) / 2);
    spacing_ *= 2;
  }

  [[nodiscard]] const std::vector<Item>& items() const { return items_; }

 private:
  std::size_t most_, spacing_, frames_ = 0;
  std::vector<Item> items_;
};

}  // namespace sheen::pipeline
