// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "reconstruction/live/live_walk.h"
#include "reconstruction/object/shape.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace sheen::reconstruction {

/// A coarse visual hull of the views that a walk has kept so far, one pass a step. Once views are a
/// third more, or the lens has changed, passes begin again from nothing, so that an early error
/// does not stay; what they find is not shown before it is as good as what was shown.
class GrowingHull {
 public:
  struct News {
    std::shared_ptr<const core::Mesh> hull;  ///< board frame; null: none yet
    std::string doubt;                       ///< why none is found, a sentence; empty: one is
    bool is_settled = false;                 ///< a third more views have hardly changed it
    std::size_t views = 0;  ///< of the last complete run of passes with the present lens; 0: none
  };

  /// `session` names the walk in doubts.
  explicit GrowingHull(std::filesystem::path session) : session_(std::move(session)) {}

  /// Takes a pass; false when there is nothing to do with these views.
  bool step(const WalkViews& walk);

  [[nodiscard]] const News& news() const { return news_; }

 private:
  [[nodiscard]] Shape next_shape(const WalkViews& walk) const;
  void show(const Shape& shape);

  std::filesystem::path session_;
  std::optional<Shape> shape_;  ///< of the last pass
  int pass_ = 0;                ///< the next one
  std::size_t began_with_ = 0;  ///< views
  int lenses_ = 0;
  double volume_m3_ = 0;  ///< when passes ended last; 0: they never have
  News news_;
};

}  // namespace sheen::reconstruction
