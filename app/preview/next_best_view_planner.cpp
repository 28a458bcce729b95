// SPDX-License-Identifier: MIT
#include "app/preview/next_best_view_planner.h"

#include "core/mesh/bounds.h"
#include "core/visibility/ray_caster.h"
#include "fitting/guidance/candidate_views.h"
#include "render/preview/score_shader.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace sheen::app {
namespace {

namespace guidance = fitting::guidance;
using Clock = std::chrono::steady_clock;

constexpr int kPlaces = 96;
constexpr std::chrono::milliseconds kShortestRest{400};
constexpr int kRestPerThought = 9;
constexpr int kRestPerLook = 2;  // nothing can be said before all places have been looked from
// Root mean square error in directions seen before that paints a patch in full colour, sRGB.
constexpr float kFullMisfit = 0.12f;

/// Scores in [0, 1] of the patches that were seen. Views: deviation to expect from missing views,
/// as a share of what a patch that nobody has seen has. Misfit: deviation in directions that were
/// seen.
PatchScores scores_of(const guidance::ViewUtility& utility,
                      const std::vector<float>& unseen_direction_error,
                      const std::vector<guidance::DirectionCells>& reachable) {
  PatchScores scores;
  const std::size_t count = reachable.size();
  scores.needs_views.assign(count, render::kUnseenScore);
  scores.misfit.assign(count, render::kUnseenScore);
  const float typical = utility.typical_unseen_direction_error();
  for (std::size_t i = 0; i < count; ++i) {
    const guidance::PatchKnowledge& patch = utility.patches()[i];
    if (patch.samples == 0) continue;
    const float missing =
        guidance::missing_variance(patch.seen, reachable[i], unseen_direction_error[i]);
    scores.needs_views[i] = std::min(1.0f, std::sqrt(missing / typical));
    scores.misfit[i] = std::min(1.0f, std::sqrt(utility.seen_direction_error(i)) / kFullMisfit);
  }
  return scores;
}

}  // namespace

NextBestViewPlanner::NextBestViewPlanner(Parts parts)
    : parts_(std::move(parts)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

bool NextBestViewPlanner::rest(const std::stop_token& stop, std::chrono::nanoseconds length) {
  std::unique_lock lock(mutex_);
  wake_.wait_for(lock, stop, length, [] { return false; });
  return !stop.stop_requested();
}

void NextBestViewPlanner::run(const std::stop_token& stop) {
  // Wait for the first camera: it says how far away cameras stand.
  std::optional<PlannerInput> input;
  while (!(input = parts_.ask())) {
    if (!rest(stop, kShortestRest)) return;
  }
  const Eigen::Vector3f centre = core::bounds_of(parts_.mesh).center();
  const float distance_m = (input->eye - centre).norm();

  // Look once from everywhere.
  const std::vector<float> area = guidance::vertex_areas(parts_.mesh);
  const core::VertexNeighbours neighbours = core::vertex_neighbours(parts_.mesh);
  const core::RayCaster caster(parts_.mesh);
  const guidance::CandidateViews views(
      parts_.mesh, caster, parts_.limits,
      guidance::candidate_places(centre, distance_m, parts_.up, kPlaces),
      [&, last = Clock::now()]() mutable {
        const bool stopped = !rest(stop, kRestPerLook * (Clock::now() - last));
        last = Clock::now();
        return stopped;
      });
  const auto reachable =
      std::make_shared<const std::vector<guidance::DirectionCells>>(views.reachable());

  // Then think again and again about what is missing.
  do {
    const auto begin = Clock::now();
    if (!(input = parts_.ask())) {  // everything has been taken back
      rest(stop, kShortestRest);
      continue;
    }
    const auto unseen_direction_error =
        guidance::smooth_unseen_direction_errors(input->utility, neighbours);
    const auto gains = views.gains(input->utility.patches(), unseen_direction_error, area);
    const auto next = guidance::next_best_view(views.places(), gains, centre, input->eye);
    PlannerAdvice advice{scores_of(input->utility, unseen_direction_error, *reachable),
                         guidance::coverage(input->utility.patches(), *reachable, area),
                         std::nullopt, reachable};
    if (next) advice.next_best_view = views.places()[*next];
    parts_.tell(std::move(advice));
    rest(stop, std::max<std::chrono::nanoseconds>(kRestPerThought * (Clock::now() - begin),
                                                  kShortestRest));
  } while (!stop.stop_requested());
}

}  // namespace sheen::app
