// SPDX-License-Identifier: MIT
#include "fitting/undo/undoable_fitter.h"

#include "core/diagnostics/error.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace sheen::fitting {

UndoableFitter::UndoableFitter(Factory make)
    : make_(std::move(make)), inner_(make_()), log_(std::in_place) {}

const ModelUpdate& UndoableFitter::integrate(const core::SampleBatch& batch) {
  if (log_) {
    try {
      log_->append(batch);
    } catch (const core::Error&) {
      log_.reset();  // a full disk must not end the fit
    }
  }
  return inner_->integrate(batch);
}

void UndoableFitter::undo(std::size_t views, const BeforeView& before_view) {
  assert(log_);
  log_->truncate(log_->size() - std::min(views, log_->size()));
  inner_ = make_();
  ++undos_;
  core::SampleBatch batch;
  for (std::size_t i = 0; i < log_->size(); ++i) {
    log_->read(i, batch);
    before_view(batch, inner_->light_field());
    inner_->integrate(batch);
  }
}

}  // namespace sheen::fitting
