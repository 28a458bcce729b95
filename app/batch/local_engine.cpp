// SPDX-License-Identifier: MIT
#include "app/batch/local_engine.h"

#include "app/batch/step_run.h"
#include "app/interrupt.h"
#include "core/diagnostics/error.h"
#include "core/files/folder_lock.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <deque>
#include <list>

namespace sheen::app {
namespace {

namespace fs = std::filesystem;

constexpr int kLookForInterrupts_ms = 500;

/// What runs that were killed left behind. Only for whoever holds the folder's lock.
void remove_unfinished(const fs::path& folder) {
  std::vector<fs::path> unfinished;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with('.') &&
        (name.find(".partial-") != std::string::npos || name.find(".old-") != std::string::npos)) {
      unfinished.push_back(entry.path());
    }
  }
  for (const fs::path& path : unfinished) fs::remove_all(path);
}

/// What a process is started for: a step of a session or of one of its parts.
struct Run {
  const SessionWork* work;
  Step step;
};

std::deque<Run> runs_left(const SessionWork& work, std::span<const SessionWork> parts, Step until) {
  std::deque<Run> left;
  for (const Step step : work.out_of_date()) {
    if (step > until) break;
    for (const SessionWork& part : parts) {
      if (step == Step::replay && !part.out_of_date().empty()) left.push_back({&part, step});
    }
    left.push_back({&work, step});
  }
  return left;
}

std::size_t count_runs(const SessionWork& work, Step until) {
  const auto parts = work.parts();
  return runs_left(work, parts, until).size();
}

/// A session whose steps are run one after the other, and so are the parts of its replay: here they
/// save memory. No other process works on it meanwhile.
class RunningSession {
 public:
  RunningSession(const SessionWork& work, Step until, int threads)
      : work_(work), parts_(work.parts()), lock_(work.folder()), threads_(threads) {
    remove_unfinished(work.folder());
    left_ = runs_left(work_, parts_, until);
    start_next();
  }

  [[nodiscard]] const SessionWork& work() const { return work_; }
  [[nodiscard]] bool is_done() const { return !now_; }
  [[nodiscard]] std::size_t steps_left_to_do() const { return left_.size(); }
  [[nodiscard]] StepRun& now() { return *now_; }

  void start_next() {
    now_.reset();
    part_lock_.reset();
    if (left_.empty()) return;
    const auto [work, step] = left_.front();
    try {
      if (work != &work_) {
        part_lock_.emplace(work->folder());
        remove_unfinished(work->folder());
      }
      now_.emplace(*work, step, threads_);
    } catch (const core::Error& error) {
      write_failure(work_.folder(), {std::string(name_of(step)), error.what()}, {});
      throw;
    }
  }
  void take_done() {
    left_.pop_front();
    start_next();
  }

 private:
  const SessionWork& work_;
  std::vector<SessionWork> parts_;
  core::FolderLock lock_;
  std::optional<core::FolderLock> part_lock_;  ///< of the part at hand: on a cluster they have one
  int threads_;
  std::deque<Run> left_;  ///< the one at hand included
  std::optional<StepRun> now_;
};

class Engine {
 public:
  Engine(std::span<const SessionWork> sessions, const LocalEngine& options,
         const CommandContext& context)
      : options_(options),
        threads_(std::max(1, context.threads / options.sessions_at_once)),
        waiting_(to_do(sessions, options.until)),
        total_(count_steps(waiting_, options.until)),
        bar_(context.progress("steps", total_)) {}

  Failures run() {
    while (!waiting_.empty() || !running_.empty()) {
      throw_if_interrupted();
      fill();
      wait();
      for (auto session = running_.begin(); session != running_.end();) {
        session = goes_on(*session) ? std::next(session) : running_.erase(session);
      }
    }
    return std::move(failures_);
  }

 private:
  static std::deque<const SessionWork*> to_do(std::span<const SessionWork> sessions, Step until) {
    std::deque<const SessionWork*> result;
    for (const SessionWork& work : sessions) {
      if (count_runs(work, until) > 0) result.push_back(&work);
    }
    return result;
  }

  static int count_steps(const std::deque<const SessionWork*>& sessions, Step until) {
    std::size_t steps = 0;
    for (const SessionWork* work : sessions) steps += count_runs(*work, until);
    return static_cast<int>(steps);
  }

  /// Begins with sessions until as many run as may.
  void fill() {
    while (!waiting_.empty() &&
           running_.size() < static_cast<std::size_t>(options_.sessions_at_once)) {
      const SessionWork& work = *waiting_.front();
      waiting_.pop_front();
      attempt(work, count_runs(work, options_.until), [&] {
        running_.emplace_back(work, options_.until, threads_);
        return true;
      });
    }
  }

  /// Until a step has ended or somebody may have interrupted.
  void wait() {
    std::vector<pollfd> handles;
    for (RunningSession& session : running_) {
      if (!session.is_done()) handles.push_back({session.now().handle(), POLLIN, 0});
    }
    if (handles.size() == running_.size()) {
      poll(handles.data(), handles.size(), kLookForInterrupts_ms);
    }
  }

  /// Sees to a session; false when there is nothing left to do for it.
  bool goes_on(RunningSession& session) {
    return attempt(session.work(), session.steps_left_to_do(), [&] {
      if (session.is_done()) return false;
      switch (session.now().state()) {
        case StepRun::State::running:
          return true;
        case StepRun::State::failed:
          fail(session.work(), session.now().failure(), session.steps_left_to_do());
          return false;
        case StepRun::State::done:
          show(session.work(), session.now().step(), 1);
          session.take_done();
          return !session.is_done();
      }
      return false;
    });
  }

  /// What `action` throws is this session's failure and no other's.
  template <typename Action>
  bool attempt(const SessionWork& work, std::size_t steps_lost, const Action& action) {
    try {
      return action();
    } catch (const core::Error& error) {
      fail(work, {"", error.what()}, steps_lost);
    } catch (const fs::filesystem_error& error) {
      fail(work, {"", error.what()}, steps_lost);
    }
    return false;
  }

  void fail(const SessionWork& work, Failure failure, std::size_t steps_lost) {
    failures_[work.job().name] = std::move(failure);
    show(work, {}, steps_lost);
  }

  void show(const SessionWork& work, std::optional<Step> step, std::size_t steps) {
    done_ += static_cast<int>(steps);
    bar_.show(done_, fmt::format("{} {}", work.job().name, step ? name_of(*step) : "failed"));
  }

  LocalEngine options_;
  int threads_;
  std::deque<const SessionWork*> waiting_;
  std::list<RunningSession> running_;
  Failures failures_;
  int total_;
  Progress bar_;
  int done_ = 0;
};

}  // namespace

Failures run_locally(std::span<const SessionWork> sessions, const LocalEngine& engine,
                     const CommandContext& context) {
  return Engine(sessions, engine, context).run();
}

}  // namespace sheen::app
