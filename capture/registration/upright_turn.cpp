// SPDX-License-Identifier: MIT
#include "capture/registration/upright_turn.h"

#include "capture/registration/placement.h"
#include "core/mesh/bounds.h"

#include <numbers>

namespace sheen::capture {
namespace {

constexpr std::size_t kTrialViews = 10;
constexpr int kTurns = 12;             // first guesses about z
constexpr double kTrialSearch = 0.35;  // of the radius: half-way to the next guess, and more

}  // namespace

Eigen::Isometry3d find_upright_turn(const core::Mesh& mesh, const core::CameraModel& camera,
                                    const std::vector<RegistrationView>& views,
                                    const std::function<void()>& on_guess) {
  const auto some = thinned_out(views, kTrialViews);
  const double search_m = kTrialSearch * core::bounds_of(mesh).cast<double>().diagonal().norm() / 2;
  Eigen::Isometry3d best = place_upright(mesh, 0);
  double best_score = 0;
  for (int turn = 0; turn < kTurns; ++turn) {
    on_guess();
    const auto guess = place_upright(mesh, 2 * std::numbers::pi * turn / kTurns);
    const auto found = register_object(mesh, camera, some, guess, {.search_m = search_m});
    if (!found) continue;
    const double score = found->matched_share / (1 + found->residual_px);
    if (score <= best_score) continue;
    best_score = score;
    best = found->board_from_object;
  }
  return best;
}

}  // namespace sheen::capture
