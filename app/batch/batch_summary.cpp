// SPDX-License-Identifier: MIT
#include "app/batch/batch_summary.h"

#include "core/diagnostics/error.h"
#include "core/files/read_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sheen::app {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostReportBytes = std::size_t{64} << 20;
constexpr double kTrustedOutline = 0.75;  // as `sheen register` says
// Below the mean of all views, before a direction is named: what all share no walk mends.
constexpr double kWorseThere_db = 2;
// A sector with less of the object than this is a rim, not a side.
constexpr double kLeastShareOfPatches = 0.01;

/// A JSON file of a step; null when it is missing or broken.
ordered_json read_json(const std::filesystem::path& path) {
  std::error_code failure;
  if (!std::filesystem::exists(path, failure)) return nullptr;
  try {
    auto document = ordered_json::parse(core::read_file(path, kMostReportBytes), nullptr, false);
    return document.is_discarded() ? ordered_json(nullptr) : document;
  } catch (const core::Error&) {
    return nullptr;
  }
}

/// The number at a JSON pointer; nothing where there is none.
std::optional<double> number(const ordered_json& document, const char* pointer) {
  const ordered_json::json_pointer place(pointer);
  if (!document.is_object() || !document.contains(place)) return std::nullopt;
  const ordered_json& value = document.at(place);
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

ordered_json json_or_null(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

/// Adds the number at a JSON pointer of `from` to that of `to`.
void add_number(const ordered_json& from, ordered_json& to, const std::string& pointer) {
  const auto a = number(from, pointer.c_str());
  const auto b = number(to, pointer.c_str());
  if (a && b) to[ordered_json::json_pointer(pointer)] = static_cast<std::int64_t>(*a + *b);
}

/// What the reports of all parts say together: each has seen its share of the patches, and all have
/// seen all frames. Null where one is missing.
ordered_json sum_of_parts(std::span<const SessionWork> parts) {
  ordered_json sum;
  for (const SessionWork& part : parts) {
    ordered_json report = read_json(part.folder_of(Step::replay) / "report.json");
    if (!report.is_object()) return nullptr;
    if (sum.is_object()) {
      add_number(sum, report, "/patches_observed");
      add_number(sum, report, "/coverage/underneath/observed");
      for (int i = 0; number(report, fmt::format("/coverage/sectors/{}/observed", i).c_str());
           ++i) {
        add_number(sum, report, fmt::format("/coverage/sectors/{}/observed", i));
      }
      report["peak_rss_bytes"] = std::max(number(sum, "/peak_rss_bytes").value_or(0),
                                          number(report, "/peak_rss_bytes").value_or(0));
    }
    sum = std::move(report);
  }
  return sum;
}

/// Of the replay; of one in parts once they are merged. No part measures held-out views, since none
/// has a whole picture; `evaluate` does.
ordered_json replay_report(const SessionWork& work) {
  const auto parts = work.parts();
  if (parts.empty()) return read_json(work.folder_of(Step::replay) / "report.json");
  std::error_code failure;
  const auto model_bytes =
      std::filesystem::file_size(work.folder_of(Step::replay) / "model.glb", failure);
  ordered_json report = failure ? ordered_json(nullptr) : sum_of_parts(parts);
  if (report.is_object()) report["model_bytes"] = model_bytes;
  return report;
}

/// What went wrong with the frames, most frequent first: "no_tags 12, blur 3".
std::string refusals_text(const ordered_json& rejections) {
  std::vector<std::pair<int, std::string>> reasons;
  for (const auto& [reason, count] : rejections.items()) {
    if (count.is_number_integer()) reasons.emplace_back(count.get<int>(), reason);
  }
  std::sort(reasons.rbegin(), reasons.rend());
  std::string text;
  for (const auto& [count, reason] : reasons) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", reason, count);
  }
  return text;
}

void ask_for_frames(const ordered_json& replay, const Wanted& wanted, ordered_json& again) {
  const double read = number(replay, "/frames/read").value_or(0);
  const double posed = number(replay, "/frames/posed").value_or(0);
  if (read <= 0 || posed >= wanted.posed * read) return;
  again.push_back(fmt::format("{:.0f} of {:.0f} frames got a pose ({})", posed, read,
                              refusals_text(replay.value("rejections", ordered_json::object()))));
}

void ask_for_accuracy(const ordered_json& evaluation, const Wanted& wanted, ordered_json& again) {
  const auto psnr = number(evaluation, "/mean/psnr");
  if (!psnr || *psnr >= wanted.psnr_db) return;
  again.push_back(
      fmt::format("{:.1f} dB over all held-out views; look at evaluate/sheet.png", *psnr));
}

void ask_for_sectors(const ordered_json& sectors, const std::optional<double>& mean_psnr,
                     const Wanted& wanted, ordered_json& again) {
  double patches = 0;
  for (const auto& sector : sectors) patches += number(sector, "/patches").value_or(0);
  for (const auto& sector : sectors) {
    const std::string where = sector.value("where", "");
    const double here = number(sector, "/patches").value_or(0);
    const double seen = number(sector, "/observed").value_or(0);
    if (here >= kLeastShareOfPatches * patches && seen < wanted.seen * here) {
      again.push_back(fmt::format("{}: {:.0f} % seen, {:.0f} frames from there", where,
                                  100 * seen / here, number(sector, "/frames").value_or(0)));
    }
    const auto psnr = number(sector, "/held_out_psnr");
    if (psnr && mean_psnr && *psnr < std::min(wanted.psnr_db, *mean_psnr - kWorseThere_db)) {
      again.push_back(fmt::format("{}: {:.1f} dB over {:.0f} held-out views", where, *psnr,
                                  number(sector, "/held_out_views").value_or(0)));
    }
  }
}

void ask_for_outline(const ordered_json& registration, ordered_json& again) {
  const auto share = number(registration, "/matched_share");
  if (share && *share < kTrustedOutline) {
    again.push_back(fmt::format("{:.0f} % of the outline on edges; look at register/outline.png",
                                100 * *share));
  }
}

/// Names relative to the batch's folder, of files that people look at.
ordered_json files_of(const SessionWork& work) {
  ordered_json files = ordered_json::object();
  for (const char* name : {"export/model.html", "evaluate/sheet.png", "register/outline.png",
                           "survey/board.png", "failed.log", "replay/model.glb"}) {
    std::error_code failure;
    if (std::filesystem::exists(work.folder() / name, failure)) {
      files[name] = work.job().name + "/" + name;
    }
  }
  for (const SessionWork& part : work.parts()) {
    std::error_code failure;
    if (!files.contains("failed.log") &&
        std::filesystem::exists(part.folder() / "failed.log", failure)) {
      files["failed.log"] =
          fmt::format("{}/{}/failed.log", work.job().name, part.folder().filename().string());
    }
  }
  return files;
}

/// Of each step; a replay's parts count with it.
ordered_json seconds_of(const SessionWork& work) {
  const auto seconds_in = [](const std::filesystem::path& folder) {
    return number(read_json(folder / "step.json"), "/seconds");
  };
  ordered_json seconds = ordered_json::object();
  for (const Step step : work.steps()) {
    if (const auto taken = seconds_in(work.folder_of(step))) {
      seconds[std::string(name_of(step))] = *taken;
    }
  }
  if (seconds.contains("replay")) {
    double sum = seconds["replay"].get<double>();
    for (const SessionWork& part : work.parts()) {
      sum += seconds_in(part.folder_of(Step::replay)).value_or(0);
    }
    seconds["replay"] = sum;
  }
  return seconds;
}

std::optional<double> share(const ordered_json& document, const char* part, const char* whole) {
  const auto a = number(document, part);
  const auto b = number(document, whole);
  return a && b && *b > 0 ? std::optional(*a / *b) : std::nullopt;
}

/// Share of the patches that some frame saw, less those underneath where that is known.
std::optional<double> seen_share(const ordered_json& replay, const ordered_json& sectors) {
  double patches = 0;
  double observed = 0;
  for (const auto& sector : sectors) {
    patches += number(sector, "/patches").value_or(0);
    observed += number(sector, "/observed").value_or(0);
  }
  return patches > 0 ? observed / patches : share(replay, "/patches_observed", "/patches");
}

ordered_json summarise_session(const SessionWork& work, const Failure* failure,
                               const Wanted& wanted) {
  const ordered_json replay = replay_report(work);
  const ordered_json evaluation = read_json(work.folder_of(Step::evaluate) / "report.json");
  const ordered_json registration = read_json(work.folder_of(Step::register_mesh) / "report.json");

  // Reasons to walk round it once more.
  ordered_json again = ordered_json::array();
  ordered_json sectors = ordered_json::array();
  if (replay.is_object()) {
    const auto* pointer = "/coverage/sectors";
    if (replay.contains(ordered_json::json_pointer(pointer))) {
      sectors = replay.at(ordered_json::json_pointer(pointer));
    }
    ask_for_frames(replay, wanted, again);
    ask_for_sectors(sectors, number(replay, "/held_out/psnr"), wanted, again);
  }
  ask_for_accuracy(evaluation, wanted, again);
  ask_for_outline(registration, again);
  const bool is_complete = work.out_of_date().empty();
  const char* state = failure != nullptr ? "failed"
                      : !is_complete     ? "unfinished"
                      : again.empty()    ? "good"
                                         : "again";

  return {{"name", work.job().name},
          {"state", state},
          {"failed_step", failure != nullptr ? ordered_json(failure->step) : nullptr},
          {"message", failure != nullptr ? ordered_json(failure->message) : nullptr},
          {"frames", json_or_null(number(replay, "/frames/read"))},
          {"posed", json_or_null(share(replay, "/frames/posed", "/frames/read"))},
          {"seen", json_or_null(seen_share(replay, sectors))},
          {"psnr", json_or_null(number(evaluation, "/mean/psnr"))},
          {"ssim", json_or_null(number(evaluation, "/mean/ssim"))},
          {"patches", json_or_null(number(replay, "/patches"))},
          {"parts", work.job().parts},
          {"model_bytes", json_or_null(number(replay, "/model_bytes"))},
          {"peak_rss_bytes", json_or_null(number(replay, "/peak_rss_bytes"))},
          {"rejections",
           replay.is_object() ? replay.value("rejections", ordered_json::object()) : nullptr},
          {"seconds", seconds_of(work)},
          {"again", std::move(again)},
          {"sectors", std::move(sectors)},
          {"files", files_of(work)}};
}

int order_of(const ordered_json& session) {
  const auto state = session.value("state", "");
  return state == "failed" ? 0 : state == "again" ? 1 : state == "unfinished" ? 2 : 3;
}

std::string cell(const ordered_json& session, const char* key, double factor, int decimals) {
  const auto value = number(session, (std::string("/") + key).c_str());
  return value ? fmt::format("{:.{}f}", factor * *value, decimals) : "-";
}

double total_seconds(const ordered_json& session) {
  double sum = 0;
  for (const auto& [step, seconds] : session.at("seconds").items()) sum += seconds.get<double>();
  return sum;
}

}  // namespace

ordered_json summarise_batch(const Jobs& jobs, std::span<const SessionWork> sessions,
                             const Failures& failures) {
  std::vector<ordered_json> rows;
  for (const SessionWork& work : sessions) {
    const auto failure = failures.find(work.job().name);
    rows.push_back(summarise_session(work, failure == failures.end() ? nullptr : &failure->second,
                                     jobs.wanted));
  }
  // What somebody must see to first.
  std::stable_sort(rows.begin(), rows.end(), [](const ordered_json& a, const ordered_json& b) {
    return order_of(a) < order_of(b);
  });
  ordered_json counts{{"good", 0}, {"again", 0}, {"failed", 0}, {"unfinished", 0}};
  for (const ordered_json& row : rows) {
    ordered_json& count = counts[row.at("state").get<std::string>()];
    count = count.get<int>() + 1;
  }
  return {
      {"wanted",
       {{"psnr", jobs.wanted.psnr_db}, {"seen", jobs.wanted.seen}, {"posed", jobs.wanted.posed}}},
      {"hold_out", jobs.hold_out},
      {"counts", std::move(counts)},
      {"sessions", rows}};
}

std::string batch_text(const ordered_json& summary) {
  std::size_t width = 7;
  for (const auto& session : summary.at("sessions")) {
    width = std::max(width, session.at("name").get<std::string>().size());
  }
  std::string text =
      fmt::format("{:<{}}  {:<10} {:>7} {:>8} {:>8} {:>8} {:>7} {:>8} {:>7}\n", "session", width,
                  "state", "frames", "posed %", "seen %", "PSNR dB", "SSIM", "model MB", "s");
  std::string reasons;
  for (const auto& session : summary.at("sessions")) {
    const auto name = session.at("name").get<std::string>();
    text += fmt::format(
        "{:<{}}  {:<10} {:>7} {:>8} {:>8} {:>8} {:>7} {:>8} {:>7.0f}\n", name, width,
        session.at("state").get<std::string>(), cell(session, "frames", 1, 0),
        cell(session, "posed", 100, 1), cell(session, "seen", 100, 1), cell(session, "psnr", 1, 2),
        cell(session, "ssim", 1, 4), cell(session, "model_bytes", 1e-6, 2), total_seconds(session));
    if (session.at("message").is_string()) {
      const auto step = session.at("failed_step").get<std::string>();
      reasons += fmt::format("{}: {}{}\n", name, step.empty() ? "" : step + ": ",
                             session.at("message").get<std::string>());
    }
    for (const auto& line : session.at("again")) {
      reasons += fmt::format("{}: {}\n", name, line.get<std::string>());
    }
  }
  const auto& counts = summary.at("counts");
  text += fmt::format("{} good, {} want another walk, {} failed, {} unfinished\n",
                      counts.at("good").get<int>(), counts.at("again").get<int>(),
                      counts.at("failed").get<int>(), counts.at("unfinished").get<int>());
  return reasons.empty() ? text : text + "\n" + reasons;
}

}  // namespace sheen::app
