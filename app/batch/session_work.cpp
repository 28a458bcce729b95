// SPDX-License-Identifier: MIT
#include "app/batch/session_work.h"

#include "app/batch/session_links.h"
#include "capture/session/session.h"
#include "core/diagnostics/error.h"
#include "core/files/read_file.h"
#include "core/files/write_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace sheen::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kStepRecord = "step.json";
constexpr const char* kSession = "session";
constexpr const char* kModel = "model.glb";
constexpr const char* kState = "part.state";
constexpr const char* kPoses = "poses.txt";
constexpr std::size_t kMostRecordBytes = std::size_t{1} << 20;

/// FNV-1a, 64 bits: tells changed input from unchanged, nobody forges it.
std::string hash_of(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return fmt::format("{:016x}", hash);
}

/// Names, sizes and times of all files of a recording, in the order of their names.
std::string state_of(const fs::path& folder) {
  std::vector<std::string> lines;
  std::error_code failure;
  for (fs::recursive_directory_iterator entry(folder, failure), end; entry != end;
       entry.increment(failure)) {
    if (failure) break;
    if (entry->path().filename().string().starts_with('.') || !entry->is_regular_file(failure)) {
      continue;
    }
    lines.push_back(fmt::format("{} {} {}\n", entry->path().lexically_relative(folder).string(),
                                entry->file_size(failure),
                                entry->last_write_time(failure).time_since_epoch().count()));
  }
  std::sort(lines.begin(), lines.end());
  std::string state;
  for (const std::string& line : lines) state += line;
  return state;
}

/// Whether tags place the frames of a session, so that it matters where they lie. A session that
/// cannot be opened counts: the command will say what is wrong with it.
bool is_posed_by_tags(const fs::path& folder) {
  try {
    const capture::Session session = capture::open_session(folder);
    return session.board.has_value() && !session.poses;
  } catch (const core::Error&) {
    return true;
  }
}

std::string fingerprint_in(const fs::path& folder) {
  try {
    const auto record = ordered_json::parse(core::read_file(folder / kStepRecord, kMostRecordBytes),
                                            nullptr, false);
    const auto found = record.is_object() ? record.find("made_from") : record.end();
    return record.is_object() && found != record.end() && found->is_string()
               ? found->get<std::string>()
               : std::string();
  } catch (const core::Error&) {
    return {};
  }
}

}  // namespace

SessionWork::SessionWork(const Jobs& jobs, const Job& job, std::filesystem::path folder)
    : job_(job), folder_(std::move(folder)), hold_out_(jobs.hold_out), format_(jobs.format) {
  steps_ = job_.steps;
  const bool surveys = std::find(steps_.begin(), steps_.end(), Step::survey) != steps_.end();
  if (surveys && !is_posed_by_tags(job_.folder)) std::erase(steps_, Step::survey);
}

fs::path SessionWork::folder() const {
  return part_ ? folder_ / fmt::format("part-{}", *part_) : folder_;
}

fs::path SessionWork::folder_of(Step step) const {
  return (step == Step::replay ? folder() : folder_) / name_of(step);
}

std::vector<SessionWork> SessionWork::parts() const {
  std::vector<SessionWork> works;
  for (int number = 1; is_merged() && number <= job_.parts; ++number) {
    works.push_back(*this);
    works.back().part_ = number;
  }
  return works;
}

fs::path SessionWork::session_before(Step step) const {
  fs::path session = job_.folder;
  for (const Step earlier : steps_) {
    if (earlier >= step || earlier > Step::register_mesh) break;
    session = folder_of(earlier) / kSession;
  }
  return session;
}

std::string SessionWork::fingerprint(Step step, const std::string& recording) const {
  // A step depends on those before it; only nothing comes of an evaluation.
  std::string text = recording;
  for (const Step earlier : steps_) {
    if (earlier >= step) break;
    if (earlier != Step::evaluate) text = fingerprint(earlier, recording);
  }
  text += fmt::format("{} {} {}\n", SHEEN_VERSION, name_of(step), hold_out_);
  if (step == Step::export_model) text += format_ + "\n";
  if (step == Step::replay && job_.parts > 1) {
    text += part_ ? fmt::format("part {} of {}\n", *part_, job_.parts) : "merged\n";
  }
  if (const auto words = job_.words.find(step); words != job_.words.end()) {
    for (const std::string& word : words->second) text += word + "\n";
  }
  return hash_of(text);
}

std::vector<Step> SessionWork::out_of_date() const {
  const std::string recording = state_of(job_.folder);
  const auto is_missing = [&recording](const SessionWork& work, Step step) {
    return fingerprint_in(work.folder_of(step)) != work.fingerprint(step, recording);
  };
  if (part_) {
    SessionWork whole = *this;
    whole.part_.reset();
    const bool is_needed = is_missing(whole, Step::replay) && is_missing(*this, Step::replay);
    return is_needed ? std::vector{Step::replay} : std::vector<Step>{};
  }
  std::vector<Step> missing;
  for (const Step step : steps_) {
    if (is_missing(*this, step)) missing.push_back(step);
  }
  return missing;
}

std::vector<std::string> SessionWork::merge(const fs::path& output) const {
  std::vector<std::string> words{"merge", "-o", output / kModel};
  for (const SessionWork& part : parts()) {
    if (!part.out_of_date().empty()) {
      throw core::Error(core::Error::Kind::run_failed, part.folder(), "is missing",
                        "run the batch again without --part");
    }
    words.push_back(part.folder_of(Step::replay) / kState);
  }
  // Every part poses all frames, and alike.
  fs::copy_file(parts().front().folder_of(Step::replay) / kPoses, output / kPoses);
  return words;
}

std::vector<std::string> SessionWork::prepare(Step step, const fs::path& output,
                                              int threads) const {
  const fs::path session = session_before(step);
  const fs::path model = folder_of(Step::replay) / kModel;
  const fs::path links = output / kSession;
  const std::string held_out = std::to_string(hold_out_);
  std::vector<std::string> words{std::string(name_of(step))};
  const auto add = [&words](std::initializer_list<std::string> more) {
    words.insert(words.end(), more);
  };
  switch (step) {
    case Step::survey: {
      const auto board = capture::open_session(session).board;
      if (!board) throw core::bad_input(session, "has no board", "leave survey out of its steps");
      const fs::path name = board->lexically_relative(session);
      link_session(session, links, name);
      add({session, "-o", links / name, "--picture", output / "board.png"});
      break;
    }
    case Step::register_mesh:
      link_session(session, links, "session.json");
      add({session, "-o", links / "session.json", "--picture", output / "outline.png"});
      break;
    case Step::replay:
      if (is_merged()) {
        words = merge(output);
        break;
      }
      add({session, "-o", output / kModel, "--hold-out", held_out, "--poses-out", output / kPoses});
      if (part_) {
        add({"--part", fmt::format("{}/{}", *part_, job_.parts), "--state", output / kState});
      }
      break;
    case Step::evaluate:
      add({model, session, "--hold-out", held_out, "--contact-sheet", output / "sheet.png"});
      break;
    case Step::export_model:
      add({model, "-o", output / ("model." + format_)});
      break;
  }
  add({"--report", output / "report.json", "--threads", std::to_string(threads)});
  const auto more = job_.words.find(step);
  const bool is_merge = step == Step::replay && is_merged();  // its parts got the replay's words
  if (more != job_.words.end() && !is_merge) {
    words.insert(words.end(), more->second.begin(), more->second.end());
  }
  return words;
}

std::string SessionWork::fingerprint(Step step) const {
  return fingerprint(step, state_of(job_.folder));
}

void SessionWork::record(Step step, const fs::path& output, const std::string& made_from,
                         double seconds) {
  const ordered_json record{{"step", name_of(step)},
                            {"made_from", made_from},
                            {"version", SHEEN_VERSION},
                            {"seconds", seconds}};
  core::write_file(output / kStepRecord, record.dump(2) + "\n");
}

}  // namespace sheen::app
