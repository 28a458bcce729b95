// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "reconstruction/stage/stage_map.h"

#include <vector>

namespace sheen::reconstruction {

/// Learns texels that the object found so far hides from most views, if several views agree that
/// there is paper in some shade: the same shade of the same hue through different parts of an
/// object is no chance, so the object must be open there. What agrees becomes `seen`. A patch of
/// the object that looks like paper passes for it only where it lies almost on the sheet.
void learn_hidden_paper(const capture::Board& board, const ViewSet& views,
                        const std::vector<ViewGain>& gains, StageMap& map, int threads);

}  // namespace sheen::reconstruction
