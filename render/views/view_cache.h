// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <list>
#include <utility>

namespace sheen::render {

/// What was made of the views that were drawn last, within a budget of bytes. What has not been
/// asked for the longest goes first; the one asked for last always stays. `Value` has a
/// `byte_size()`.
template <typename Value>
class ViewCache {
 public:
  explicit ViewCache(std::size_t budget_bytes) : budget_bytes_(budget_bytes) {}

  /// The view's value, from `make()` where it is not held. Valid until the next call.
  template <typename Make>
  const Value& get(std::size_t view_idx, const Make& make) {
    for (auto held = held_.begin(); held != held_.end(); ++held) {
      if (held->first != view_idx) continue;
      held_.splice(held_.begin(), held_, held);
      return held_.front().second;
    }
    held_.emplace_front(view_idx, make());
    bytes_ += held_.front().second.byte_size();
    while (bytes_ > budget_bytes_ && held_.size() > 1) {
      bytes_ -= held_.back().second.byte_size();
      held_.pop_back();
    }
    return held_.front().second;
  }

  void clear() {
    held_.clear();
    bytes_ = 0;
  }

  /// Of all values held.
  [[nodiscard]] std::size_t byte_size() const { return bytes_; }
  [[nodiscard]] std::size_t size() const { return held_.size(); }

 private:
  std::size_t budget_bytes_;
  std::size_t bytes_ = 0;
  std::list<std::pair<std::size_t, Value>> held_;  ///< the one asked for last is the first
};

}  // namespace sheen::render
