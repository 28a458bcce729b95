// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/fitter.h"
#include "fitting/undo/sample_log.h"

#include <functional>
#include <memory>
#include <optional>

namespace sheen::fitting {

/// A representation that can forget its last views exactly: it keeps every batch and, asked to
/// forget, builds itself anew from those that stay. So undo is as right as the fit itself, whatever
/// the representation, and takes as long as the fit of what stays. Where there is no room for the
/// batches the fit goes on and only forgetting is over.
class UndoableFitter final : public Fitter {
 public:
  using Factory = std::function<std::unique_ptr<Fitter>()>;
  /// Gets a batch and the light field just before it is integrated.
  using BeforeView = std::function<void(const core::SampleBatch&, const LightField&)>;

  /// `make` gives an empty representation, the same every time.
  explicit UndoableFitter(Factory make);

  const ModelUpdate& integrate(const core::SampleBatch& batch) override;
  const ModelUpdate& finish() override { return inner_->finish(); }
  /// Another object after `undo`.
  [[nodiscard]] const LightField& light_field() const override { return inner_->light_field(); }
  [[nodiscard]] FitStatistics statistics() const override { return inner_->statistics(); }
  [[nodiscard]] std::optional<float> predicted_error(std::size_t patch_idx,
                                                     const Eigen::Vector2f& uv) const override {
    return inner_->predicted_error(patch_idx, uv);
  }

  /// Times that `undo` has been called.
  [[nodiscard]] std::size_t undos() const { return undos_; }

  /// False once a batch could not be kept.
  [[nodiscard]] bool can_undo() const { return log_.has_value(); }

  /// Becomes what it would be had it never seen the last `views`, at most all, and never been asked
  /// to `finish`. All patches may have changed. Only while `can_undo`. Throws core::Error
  /// (run_failed) when the batches cannot be read back.
  void undo(std::size_t views, const BeforeView& before_view);

 private:
  Factory make_;
  std::unique_ptr<Fitter> inner_;
  std::optional<SampleLog> log_;
  std::size_t undos_ = 0;
};

}  // namespace sheen::fitting
