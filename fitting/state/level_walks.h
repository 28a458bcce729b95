// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/state/join_states.h"
#include "fitting/state/walk_gains.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sheen::fitting {

/// A recording of a session, and what its exposure and white balance multiply light with.
struct LevelledWalk {
  std::string session;
  std::uint64_t recording = 0;
  std::size_t views = 0;
  Gain gain = kNoGain;  ///< against the walk with the most views
};

/// What the walks of a fit differ by.
struct WalkLevels {
  std::vector<LevelledWalk> walks;  ///< in the order of the views
  /// Root mean square errors of held-out views, sRGB, as they are and levelled; nothing where there
  /// was nothing to try: one walk, no overlap, equal walks.
  struct Trial {
    double as_is = 0;
    double levelled = 0;
  };
  std::optional<Trial> trial;
  bool is_used = false;  ///< levelled views were predicted better

  /// Brings a view into the light of the walk with the most views, where that is used.
  void level(const StateView& view, core::SampleBatch& batch) const;
};

/// Finds gains from what walks show in common and tries them: some patches are fitted to seven of
/// eight views as they are and levelled, and both fits predict the eighth in its own light. Levels
/// are used if that error falls by a hundredth. They follow from the views alone, whatever states
/// these come from, so joining stays associative and commutative to the last bit.
WalkLevels level_walks(std::span<const std::unique_ptr<StateReader>> states,
                       std::span<const JoinedView> views, int threads, const ViewsDone& done);

}  // namespace sheen::fitting
