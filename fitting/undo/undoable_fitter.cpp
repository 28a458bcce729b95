// SPDX-License-Identifier: MIT
#include "fitting/undo/undoable_fitter.h"

#include "core/diagnostics/error.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace sheen::fitting {
namespace {

/// What a fitter sees that looks at the samples only.
core::Observation observation_of(const core::SampleBatch& samples) {
  static const cv::Mat no_image;
  static const core::CameraModel no_camera;
  static const core::VertexView no_view;
  return {0, no_image, no_camera, Eigen::Isometry3d::Identity(), no_view, samples};
}

}  // namespace

UndoableFitter::UndoableFitter(Factory make, Replay replay)
    : make_(std::move(make)), replay_(std::move(replay)), inner_(make_()) {
  if (!inner_->needs_images()) samples_.emplace();
}

bool UndoableFitter::can_undo() const {
  return needs_images() ? replay_ != nullptr : samples_.has_value();
}

const ModelUpdate& UndoableFitter::integrate(const core::Observation& observation) {
  remember(observation);
  return inner_->integrate(observation);
}

void UndoableFitter::remember(const core::Observation& observation) {
  if (needs_images()) {
    frames_.push_back(observation.frame_index);
    return;
  }
  if (!samples_) return;
  try {
    samples_->append(observation.samples);
  } catch (const core::Error&) {
    samples_.reset();  // a full disk must not end the fit
  }
}

void UndoableFitter::undo(std::size_t views, const BeforeView& before_view) {
  assert(can_undo());
  inner_ = make_();
  ++undos_;
  if (samples_) {
    samples_->truncate(samples_->size() - std::min(views, samples_->size()));
    replay_samples(before_view);
    return;
  }
  frames_.resize(frames_.size() - std::min(views, frames_.size()));
  replay_(frames_, [&](const core::Observation& observation) {
    before_view(observation.samples, inner_->light_field());
    inner_->integrate(observation);
  });
}

void UndoableFitter::replay_samples(const BeforeView& before_view) {
  core::SampleBatch batch;
  for (std::size_t i = 0; i < samples_->size(); ++i) {
    samples_->read(i, batch);
    before_view(batch, inner_->light_field());
    inner_->integrate(observation_of(batch));
  }
}

}  // namespace sheen::fitting
