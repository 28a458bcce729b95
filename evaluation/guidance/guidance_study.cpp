// SPDX-License-Identifier: MIT
#include "evaluation/guidance/guidance_study.h"

#include "core/mesh/neighbours.h"
#include "evaluation/guidance/walk_scene.h"
#include "evaluation/study/random.h"
#include "evaluation/study/rank_correlation.h"
#include "fitting/guidance/candidate_views.h"
#include "fitting/guidance/capture_score.h"
#include "fitting/sparse/sparse_fitter.h"

#include <Eigen/Geometry>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

namespace sheen::evaluation {
namespace {

namespace guidance = fitting::guidance;

constexpr float kDistance_m = 5;
constexpr float kStep_rad = 1.5f * std::numbers::pi_v<float> / 180;  // a frame
constexpr int kCandidates = 96;
constexpr int kJudges = 61;      // held-out views, elsewhere than the candidates
constexpr int kJudgeEvery = 20;  // frames
constexpr int kThinkEvery = 15;  // frames: half a second

Eigen::Vector3f on_dome(float azimuth, float elevation) {
  return kDistance_m * Eigen::Vector3f(std::cos(elevation) * std::cos(azimuth),
                                       std::cos(elevation) * std::sin(azimuth),
                                       std::sin(elevation));
}

/// A model under construction and what guidance knows of it.
struct Walk {
  const WalkScene& scene;
  std::unique_ptr<fitting::PatchFitter> model;
  guidance::CaptureScore score;
  std::uint64_t noise;

  Walk(const WalkScene& walked, std::uint64_t key)
      : scene(walked),
        model(fitting::sparse::make_sparse_fitter(core::vertex_neighbours(walked.mesh()), {}, 1)),
        score(walked.mesh().positions.size()),
        noise(key) {}

  void take(const Eigen::Vector3f& eye) {
    const auto batch = scene.look(eye, noise = hash_of({noise}));
    score.judge(batch, model->light_field());
    score.note(batch, 0);
    model->integrate(batch);
  }

  [[nodiscard]] double psnr_db(const std::vector<Eigen::Vector3f>& judges) const {
    double sum = 0;
    std::size_t count = 0;
    for (const Eigen::Vector3f& eye : judges) {
      for (const auto& error : scene.errors(model->light_field(), eye)) {
        sum += error.squared;
        ++count;
      }
    }
    return -10 * std::log10(sum / static_cast<double>(count));
  }
};

/// Three rounds that rise from 15 to 70 degrees, at the walker's pace.
std::vector<Eigen::Vector3f> sweep(int frames) {
  constexpr float turns = 3;
  constexpr float low = 0.26f;
  constexpr float high = 1.22f;
  std::vector<Eigen::Vector3f> path;
  float t = 0;
  while (static_cast<int>(path.size()) < frames && t < 1) {
    const float elevation = low + (high - low) * t;
    path.push_back(on_dome(2 * std::numbers::pi_v<float> * turns * t, elevation));
    const float pace =
        std::hypot(2 * std::numbers::pi_v<float> * turns * std::cos(elevation), high - low);
    t += kStep_rad / pace;
  }
  return path;
}

guidance::CandidateViews candidates(const WalkScene& scene) {
  return {scene.mesh(),
          scene.caster(),
          {},
          guidance::candidate_places({0, 0, 0}, kDistance_m, {0, 0, 1}, kCandidates),
          [] { return false; }};
}

/// One step from a place towards another along the dome.
Eigen::Vector3f step_towards(const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
  const Eigen::Quaternionf turn = Eigen::Quaternionf::FromTwoVectors(from, to);
  const float angle = Eigen::AngleAxisf(turn).angle();
  if (angle <= kStep_rad) return to;
  return kDistance_m *
         (Eigen::Quaternionf::Identity().slerp(kStep_rad / angle, turn) * from).normalized();
}

/// The place after `eye` for somebody who goes where `choose` says; it is asked now and then.
class Follower {
 public:
  using Choose = std::function<std::optional<Eigen::Vector3f>(const Eigen::Vector3f&)>;
  explicit Follower(Choose choose) : choose_(std::move(choose)) {}

  Eigen::Vector3f after(const Eigen::Vector3f& eye) {
    if (frame_++ % kThinkEvery == 0 || !goal_ || (*goal_ - eye).norm() < 1e-3f) {
      goal_ = choose_(eye);
    }
    return goal_ ? step_towards(eye, *goal_) : eye;
  }

 private:
  Choose choose_;
  std::optional<Eigen::Vector3f> goal_;
  int frame_ = 0;
};

/// PSNR on the judges' views after every tenth frame.
using Curve = std::vector<double>;

Curve plain_walk(const WalkScene& scene, const std::vector<Eigen::Vector3f>& judges,
                 const GuidanceStudyOptions& options, std::uint64_t key) {
  Walk walk(scene, key);
  Curve curve;
  int frame = 0;
  for (const Eigen::Vector3f& eye : sweep(options.frames)) {
    walk.take(eye);
    if (++frame % kJudgeEvery == 0) curve.push_back(walk.psnr_db(judges));
  }
  return curve;
}

Curve guided_walk(const WalkScene& scene, const std::vector<Eigen::Vector3f>& judges,
                  const GuidanceStudyOptions& options, std::uint64_t key) {
  Walk walk(scene, key);
  const guidance::CandidateViews views = candidates(scene);
  const auto area = guidance::vertex_areas(scene.mesh());
  const auto neighbours = core::vertex_neighbours(scene.mesh());
  Follower follower([&](const Eigen::Vector3f& eye) -> std::optional<Eigen::Vector3f> {
    const auto& utility = walk.score.utility;
    const auto gains = views.gains(
        utility.patches(), guidance::smooth_unseen_direction_errors(utility, neighbours), area);
    const auto next = guidance::next_best_view(views.places(), gains, {0, 0, 0}, eye);
    if (!next) return std::nullopt;
    return views.places()[*next];
  });
  Curve curve;
  Eigen::Vector3f eye = sweep(1).front();
  for (int frame = 1; frame <= options.frames; ++frame) {
    walk.take(eye);
    eye = follower.after(eye);
    if (frame % kJudgeEvery == 0) curve.push_back(walk.psnr_db(judges));
  }
  return curve;
}

/// First frame from which the curve is at or above a goal; nothing when never.
std::optional<int> frames_to(const Curve& curve, double goal_db) {
  for (std::size_t i = 0; i < curve.size(); ++i) {
    if (curve[i] >= goal_db) return static_cast<int>(i + 1) * kJudgeEvery;
  }
  return std::nullopt;
}

std::string cell(std::optional<int> frames) {
  return frames ? fmt::format("{}", *frames) : "never";
}

using Scores = std::map<std::string, std::vector<double>>;

/// Scores of patches and their true errors over all views of the judges.
void rank_patches(const Walk& walk, const guidance::CandidateViews& views,
                  const std::vector<Eigen::Vector3f>& judges, Scores& scores) {
  const std::size_t count = walk.scene.mesh().positions.size();
  std::vector<double> squared(count, 0);
  std::vector<double> predicted(count, 0);
  std::vector<int> seen(count, 0);
  for (const Eigen::Vector3f& eye : judges) {
    for (const auto& error : walk.scene.errors(walk.model->light_field(), eye)) {
      squared[error.vertex_idx] += error.squared;
      predicted[error.vertex_idx] += static_cast<double>(
          walk.model->predicted_error(error.vertex_idx, error.uv).value_or(1.0f));
      ++seen[error.vertex_idx];
    }
  }
  const auto unseen_direction_error = guidance::smooth_unseen_direction_errors(
      walk.score.utility, core::vertex_neighbours(walk.scene.mesh()));
  for (std::size_t i = 0; i < count; ++i) {
    const auto& known = walk.score.utility.patches()[i];
    if (seen[i] == 0 || known.samples == 0) continue;
    const auto reachable = views.reachable()[i];
    scores["true"].push_back(squared[i] / seen[i]);
    scores["fewest samples"].push_back(-static_cast<double>(known.samples));
    scores["predicted variance"].push_back(
        static_cast<double>(guidance::variance_sum(known.seen, reachable)));
    scores["needs views"].push_back(static_cast<double>(
        guidance::missing_variance(known.seen, reachable, unseen_direction_error[i])));
    scores["does not fit"].push_back(
        static_cast<double>(walk.score.utility.seen_direction_error(i)));
    scores["predicted error of the fitter"].push_back(predicted[i] / seen[i]);
  }
}

/// The same for single directions.
void rank_directions(const Walk& walk, const std::vector<Eigen::Vector3f>& judges, Scores& scores) {
  const auto unseen_direction_error = guidance::smooth_unseen_direction_errors(
      walk.score.utility, core::vertex_neighbours(walk.scene.mesh()));
  for (const Eigen::Vector3f& eye : judges) {
    for (const auto& error : walk.scene.errors(walk.model->light_field(), eye)) {
      const auto& known = walk.score.utility.patches()[error.vertex_idx];
      if (known.samples == 0) continue;
      const float variance = guidance::predicted_variance(known.seen, guidance::cell_of(error.uv));
      scores["true"].push_back(error.squared);
      scores["fewest samples"].push_back(-static_cast<double>(known.samples));
      scores["predicted variance"].push_back(static_cast<double>(variance));
      scores["needs views"].push_back(
          static_cast<double>(variance * unseen_direction_error[error.vertex_idx]));
      scores["does not fit"].push_back(
          static_cast<double>(walk.score.utility.seen_direction_error(error.vertex_idx)));
      scores["predicted error of the fitter"].push_back(static_cast<double>(
          walk.model->predicted_error(error.vertex_idx, error.uv).value_or(1.0f)));
    }
  }
}

std::vector<Eigen::Vector3f> judges_of() {
  return guidance::candidate_places({0, 0, 0}, kDistance_m, {0, 0, 1}, kJudges);
}

}  // namespace

Table ranking_table(const GuidanceStudyOptions& options, const Progress& progress) {
  const auto judges = judges_of();
  Scores patches;
  Scores directions;
  for (int scene_idx = 0; scene_idx < options.scenes; ++scene_idx) {
    progress(fmt::format("ranking: scene {}", scene_idx + 1));
    const std::uint64_t key = options.seed + static_cast<std::uint64_t>(scene_idx);
    const WalkScene scene(key);
    Walk walk(scene, key);
    for (const Eigen::Vector3f& eye : sweep(options.frames)) {
      if (eye.x() > -0.5f * kDistance_m) walk.take(eye);  // nobody stands on one side
    }
    rank_patches(walk, candidates(scene), judges, patches);
    rank_directions(walk, judges, directions);
  }
  Table table{"Rank correlation (Spearman) with the true squared error after a sweep with a gap",
              {"score", "patches", "patches and directions"},
              {}};
  for (const auto& [name, values] : patches) {
    if (name == "true") continue;
    table.rows.push_back({name, decimals(spearman(values, patches["true"]), 2),
                          decimals(spearman(directions[name], directions["true"]), 2)});
  }
  return table;
}

Table walk_table(const GuidanceStudyOptions& options, const Progress& progress) {
  Table table{fmt::format("Frames until views from everywhere reach a PSNR, of {} at most: sweep / "
                          "following the hint",
                          options.frames),
              {"scene", "end of the sweep less 2 dB", "less 1 dB", "end of the sweep",
               "sweep at its end", "hint at that time"},
              {}};
  const auto judges = judges_of();
  for (int scene_idx = 0; scene_idx < options.scenes; ++scene_idx) {
    progress(fmt::format("walks: scene {}", scene_idx + 1));
    const std::uint64_t key = options.seed + static_cast<std::uint64_t>(scene_idx);
    const WalkScene scene(key);
    const Curve plain = plain_walk(scene, judges, options, key);
    const Curve guided = guided_walk(scene, judges, options, key);
    const double end_db = plain.back();
    std::vector<std::string> row{fmt::format("{}", key)};
    for (const double goal_db : {end_db - 2, end_db - 1, end_db}) {
      row.push_back(cell(frames_to(plain, goal_db)) + " / " + cell(frames_to(guided, goal_db)));
    }
    row.push_back(decimals(end_db, 2) + " dB");
    row.push_back(decimals(guided[std::min(plain.size(), guided.size()) - 1], 2) + " dB");
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace sheen::evaluation
