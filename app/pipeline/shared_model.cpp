// SPDX-License-Identifier: MIT
#include "app/pipeline/shared_model.h"

namespace sheen::app {

fitting::ModelUpdate SharedModel::collect_changes() {
  fitting::ModelUpdate update;
  for (std::size_t i = 0; i < is_changed_.size(); ++i) {
    if (is_changed_[i] == 0) continue;
    update.patches.push_back(static_cast<std::uint32_t>(i));
    is_changed_[i] = 0;
  }
  return update;
}

}  // namespace sheen::app
