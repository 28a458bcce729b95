// SPDX-License-Identifier: MIT
#include "pipeline/shared_model.h"

namespace sheen::pipeline {

fitting::ModelUpdate SharedModel::collect_changes() {
  fitting::ModelUpdate update;
  for (std::size_t i = 0; i < is_changed_.size(); ++i) {
    if (is_changed_[i] == 0) continue;
    update.elements.push_back(static_cast<std::uint32_t>(i));
    is_changed_[i] = 0;
  }
  return update;
}

void SharedModel::note(const fitting::ModelUpdate& update) {
  if (update.elements.empty()) return;
  // Some light fields grow.
  if (update.elements.back() >= is_changed_.size()) is_changed_.resize(update.elements.back() + 1);
  for (const std::uint32_t element : update.elements) is_changed_[element] = 1;
}

}  // namespace sheen::pipeline
