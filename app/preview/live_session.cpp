// SPDX-License-Identifier: MIT
#include "app/preview/live_session.h"

#include "app/preview/reasons.h"
#include "core/diagnostics/error.h"
#include "core/numerics/median.h"

#include <algorithm>
#include <utility>

namespace sheen::app {
namespace {

namespace guidance = fitting::guidance;

constexpr std::size_t kRecentFrames = 60;

Eigen::Vector3f up_in_object(const Eigen::Isometry3d& board_from_object) {
  return board_from_object.linear().row(2).transpose().cast<float>();
}

}  // namespace

LiveSession::LiveSession(Parts parts)
    : parts_(std::move(parts)), score_(parts_.mesh.positions.size()) {
  planner_.emplace(NextBestViewPlanner::Parts{
      .mesh = parts_.mesh,
      .up = up_in_object(parts_.board_from_object),
      .limits = parts_.limits,
      .ask = [this] { return what_is_known(); },
      .tell = [this](PlannerAdvice advice) { take(std::move(advice)); }});
}

bool LiveSession::admit(const core::SampleBatch& batch) {
  {
    const std::lock_guard lock(mutex_);
    if (parts_.is_camera && requests_.paused) return false;
  }
  // Only patches can be compared with samples; other light fields take every view.
  const auto verdict = parts_.model.with([&](const fitting::Fitter& fitter) {
    const auto* const patches = fitting::as_patches(fitter.light_field());
    const std::lock_guard lock(mutex_);
    return patches != nullptr ? score_.judge(batch, *patches) : guidance::FrameVerdict::fine;
  });
  const std::lock_guard lock(mutex_);
  const bool doubted = verdict != guidance::FrameVerdict::fine;
  verdict_ = doubted ? reason_in_words(name_of(verdict)) : "";
  if (doubted) ++doubts_[verdict_];
  admitted_ = !doubted || !parts_.refuse_faults;
  if (admitted_) score_.note(batch, status_.coverage);
  return admitted_;
}

void LiveSession::on_frame(const pipeline::TrackedFrame& tracked,
                           const pipeline::FrameStatistics& statistics) {
  publish(tracked, statistics);
  wake();
  obey();
}

void LiveSession::publish(const pipeline::TrackedFrame& tracked,
                          const pipeline::FrameStatistics& statistics) {
  const std::lock_guard lock(mutex_);
  status_.frames_read = statistics.frames_read;
  status_.frames_fitted = static_cast<int>(views_.size()) + (admitted_ ? 1 : 0);
  tracked.frame.image.copyTo(status_.image = cv::Mat());
  status_.trouble = std::exchange(verdict_, {});
  status_.camera_from_object.reset();
  if (const auto* rejection = std::get_if<capture::PoseRejection>(&tracked.pose)) {
    status_.trouble = reason_in_words(name_of(*rejection));
  } else {
    // The pose that was fitted with: refinement may have moved it.
    const pipeline::PosedFrame& posed = statistics.posed.back();
    status_.camera_from_object = posed.camera_from_board * parts_.board_from_object;
    if (std::exchange(admitted_, false)) {
      views_.push_back({posed.time_s, *status_.camera_from_object});
    }
  }
  status_.refusals.clear();
  for (const auto& [name, count] : statistics.pose_rejections) {
    status_.refusals.emplace_back(reason_in_words(name), count);
  }
  status_.refusals.insert(status_.refusals.end(), doubts_.begin(), doubts_.end());
  std::ranges::stable_sort(status_.refusals, std::greater<>(),
                           [](const auto& r) { return r.second; });
  status_.psnr_db = score_.curve.psnr_db();
  status_.is_flat = score_.curve.is_flat();
  note_times(tracked.times);
}

void LiveSession::note_times(const core::StageTimes& times) {
  status_.stage_ms.clear();
  for (const auto& [stage, ms] : times.ms()) {
    std::deque<double>& recent = recent_ms_[stage];
    recent.push_back(ms);
    if (recent.size() > kRecentFrames) recent.pop_front();
  }
  for (const char* const stage : {"decode", "pose", "align", "visibility", "sample", "fit"}) {
    const auto recent = recent_ms_.find(stage);
    if (recent == recent_ms_.end()) continue;
    std::vector<double> values(recent->second.begin(), recent->second.end());
    status_.stage_ms.emplace_back(stage, core::upper_median(values));
  }
}

void LiveSession::obey() {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (const double seconds = std::exchange(requests_.undo_s, 0); seconds > 0) {
      lock.unlock();
      undo(seconds);
      wake();
      lock.lock();
      continue;
    }
    if (std::exchange(requests_.save, false)) {
      lock.unlock();
      save();
      wake();
      lock.lock();
      continue;
    }
    const bool paused = requests_.paused && !requests_.closed;
    const auto phase = paused ? LiveStatus::Phase::paused : LiveStatus::Phase::running;
    if (std::exchange(status_.phase, phase) != phase) {
      lock.unlock();
      wake();
      lock.lock();
      continue;  // something may have been asked for meanwhile
    }
    if (!paused || parts_.is_camera) return;
    asked_.wait(lock);
  }
}

void LiveSession::undo(double seconds) {
  // Say so, and find how far back that is.
  std::size_t views = 0;
  {
    const std::lock_guard lock(mutex_);
    if (parts_.history == nullptr) return;
    if (!parts_.history->can_undo()) {
      status_.note = "Nothing can be taken back: the disk for temporary files is full";
      return;
    }
    status_.phase = LiveStatus::Phase::undoing;
    while (views < views_.size() &&
           views_[views_.size() - 1 - views].time_s > views_.back().time_s - seconds) {
      ++views;
    }
  }
  wake();

  // Build everything anew without those views.
  guidance::CaptureScore score(parts_.mesh.positions.size());
  parts_.model.with([&](const fitting::Fitter&) {
    parts_.history->undo(views,
                         [&](const core::SampleBatch& batch, const fitting::LightField& model) {
                           if (const auto* const patches = fitting::as_patches(model)) {
                             score.judge(batch, *patches);
                           }
                           score.note(batch, 0);
                         });
    if (parts_.baseline != nullptr) {
      parts_.baseline->undo(views, [](const core::SampleBatch&, const fitting::LightField&) {});
    }
  });

  const std::lock_guard lock(mutex_);
  score_ = std::move(score);
  views_.resize(views_.size() - views);
  ++generation_;
  status_.frames_undone += static_cast<int>(views);
  status_.frames_fitted = static_cast<int>(views_.size());
  status_.psnr_db = score_.curve.psnr_db();
  status_.is_flat = false;
  status_.note = "Took back " + std::to_string(views) + " frames";
}

void LiveSession::save() {
  if (!parts_.save) return;
  std::string told;
  try {
    told = parts_.model.with(
        [&](const fitting::Fitter& fitter) { return parts_.save(fitter.light_field()); });
  } catch (const core::Error& error) {
    told = error.what();  // the capture goes on
  }
  const std::lock_guard lock(mutex_);
  status_.note = told;
}

void LiveSession::finish() {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(requests_.undo_s, 0) > 0) {
      status_.note = "Nothing was taken back: the recording was over";
    }
    status_.phase = LiveStatus::Phase::finished;
  }
  wake();
}

LiveStatus LiveSession::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

LiveSession::PathNews LiveSession::path_since(std::size_t known, std::size_t generation) const {
  const std::lock_guard lock(mutex_);
  PathNews news{{}, generation_};
  const std::size_t first = generation == generation_ ? std::min(known, views_.size()) : 0;
  for (std::size_t i = first; i < views_.size(); ++i) {
    news.poses.push_back(views_[i].camera_from_object);
  }
  return news;
}

std::optional<PlannerAdvice> LiveSession::take_advice() {
  const std::lock_guard lock(mutex_);
  return std::exchange(advice_, std::nullopt);
}

guidance::PatchKnowledge LiveSession::knowledge_of(std::size_t patch_idx) const {
  const std::lock_guard lock(mutex_);
  return score_.utility.patches()[patch_idx];
}

std::optional<PlannerInput> LiveSession::what_is_known() const {
  const std::lock_guard lock(mutex_);
  if (views_.empty()) return std::nullopt;
  return PlannerInput{score_.utility, core::eye_in_object(views_.back().camera_from_object)};
}

void LiveSession::take(PlannerAdvice advice) {
  {
    const std::lock_guard lock(mutex_);
    status_.coverage = advice.coverage;
    status_.hint.reset();
    if (advice.next_best_view) status_.hint = advice.next_best_view->cast<double>();
    advice_ = std::move(advice);
  }
  wake();
}

bool LiveSession::try_look(const Look& look) {
  return parts_.model.try_look(
      [&](const fitting::Fitter& fitter, const fitting::ModelUpdate& changes) {
        const std::size_t undos = parts_.history == nullptr ? 0 : parts_.history->undos();
        look(fitter.light_field(), changes, undos);
      });
}

void LiveSession::set_paused(bool paused) {
  {
    const std::lock_guard lock(mutex_);
    requests_.paused = paused;
  }
  asked_.notify_all();
}

void LiveSession::request_undo(double seconds) {
  {
    const std::lock_guard lock(mutex_);
    requests_.undo_s += seconds;
  }
  asked_.notify_all();
}

void LiveSession::request_save() {
  {
    const std::lock_guard lock(mutex_);
    requests_.save = true;
  }
  asked_.notify_all();
}

void LiveSession::close() {
  {
    const std::lock_guard lock(mutex_);
    requests_.closed = true;
    requests_.paused = false;
    wake_ = {};
  }
  asked_.notify_all();
}

void LiveSession::set_wake(std::function<void()> wake) {
  const std::lock_guard lock(mutex_);
  wake_ = std::move(wake);
}

void LiveSession::wake() const {
  const std::lock_guard lock(mutex_);
  if (wake_) wake_();
}

}  // namespace sheen::app
