// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/fitter.h"
#include "fitting/undo/sample_log.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace sheen::fitting {

/// A fitter that can forget its last views exactly: it remembers every view and, asked to forget,
/// builds itself anew from those that stay. So undo is as right as the fit itself, whatever the
/// representation, and takes as long as the fit of what stays. A fitter of samples remembers its
/// samples (where there is no room for them the fit goes on and only forgetting is over), one of
/// images the numbers of its frames, which are then read again.
class UndoableFitter final : public Fitter {
 public:
  using Factory = std::function<std::unique_ptr<Fitter>()>;
  /// Observes frames of these numbers (ascending) once more, exactly as the first time.
  using Replay = std::function<void(std::span<const int> frames,
                                    const std::function<void(const core::Observation&)>& observe)>;
  /// Gets an observation's samples and the light field just before it is integrated.
  using BeforeView = std::function<void(const core::SampleBatch&, const LightField&)>;

  /// `make` gives an empty fitter, the same every time; `replay` may be empty for fitters that need
  /// no images.
  explicit UndoableFitter(Factory make, Replay replay = {});

  [[nodiscard]] bool needs_images() const override { return inner_->needs_images(); }
  [[nodiscard]] bool needs_depth() const override { return inner_->needs_depth(); }
  const ModelUpdate& integrate(const core::Observation& observation) override;
  const ModelUpdate& finish() override { return inner_->finish(); }
  /// Another object after `undo`.
  [[nodiscard]] const LightField& light_field() const override { return inner_->light_field(); }
  [[nodiscard]] FitStatistics statistics() const override { return inner_->statistics(); }

  /// Times that `undo` has been called.
  [[nodiscard]] std::size_t undos() const { return undos_; }

  /// False once samples could not be kept, or when frames cannot be read again.
  [[nodiscard]] bool can_undo() const;

  /// Becomes what it would be had it never seen the last `views`, at most all, and never been asked
  /// to `finish`. Every element may have changed. Only while `can_undo`. Throws core::Error
  /// (run_failed) when views cannot be read back.
  void undo(std::size_t views, const BeforeView& before_view);

 private:
  void remember(const core::Observation& observation);
  void replay_samples(const BeforeView& before_view);

  Factory make_;
  Replay replay_;
  std::unique_ptr<Fitter> inner_;
  std::optional<SampleLog> samples_;  ///< of a fitter that needs no images
  std::vector<int> frames_;           ///< of one that does
  std::size_t undos_ = 0;
};

}  // namespace sheen::fitting
