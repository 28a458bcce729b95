// SPDX-License-Identifier: MIT
#include "render/surface/budgeted_upload.h"

#include <cassert>

namespace sheen::render {
namespace {

// Patches handed over at once: long enough to join neighbours, short enough to keep to a budget.
constexpr std::size_t kPiece = 64;

}  // namespace

BudgetedUpload::BudgetedUpload(PatchShader& shader, std::size_t patch_count)
    : shader_(shader), waits_(patch_count, 0) {
  piece_.reserve(kPiece);
}

void BudgetedUpload::add(std::span<const std::uint32_t> patches) {
  for (const std::uint32_t patch : patches) {
    assert(patch < waits_.size());
    waiting_ += waits_[patch] == 0 ? 1 : 0;
    waits_[patch] = 1;
  }
  newest_.assign(patches.begin(), patches.end());
  newest_done_ = 0;
}

std::size_t BudgetedUpload::send(std::size_t budget_bytes) {
  std::size_t sent = 0;
  while (waiting_ > 0 && sent < budget_bytes) {
    piece_.clear();
    take_newest();
    if (piece_.empty()) take_next();
    sent += shader_.upload(piece_);
  }
  return sent;
}

void BudgetedUpload::take_newest() {
  while (newest_done_ < newest_.size() && piece_.size() < kPiece) take(newest_[newest_done_++]);
}

void BudgetedUpload::take_next() {
  // One round at most; pieces stay ascending, so a round's end closes one.
  for (std::size_t i = 0; i < waits_.size() && piece_.size() < kPiece; ++i) {
    if (turn_ == waits_.size()) {
      turn_ = 0;
      if (!piece_.empty()) return;
    }
    take(turn_++);
  }
}

void BudgetedUpload::take(std::uint32_t patch_idx) {
  if (waits_[patch_idx] == 0) return;
  waits_[patch_idx] = 0;
  --waiting_;
  piece_.push_back(patch_idx);
}

}  // namespace sheen::render
