// SPDX-License-Identifier: MIT
#include "evaluation/stress/stress_study.h"

#include "core/diagnostics/error.h"
#include "core/files/staged_output.h"
#include "evaluation/comparison/measure_candidate.h"
#include "pipeline/pose_frames.h"
#include "pipeline/session_readout.h"

#include <Eigen/LU>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace sheen::evaluation {
namespace {

class Notes final : public pipeline::ProgressSink {
 public:
  void note(const std::string& line) override { lines.push_back(line); }
  std::vector<std::string> lines;
};

struct PoseError {
  double mm, deg, px;
};

/// How far a pose puts the object's true vertices from where they are.
PoseError pose_error(const StressRecording& truth, const Eigen::Isometry3d& camera_from_board,
                     const Eigen::Isometry3d& true_camera_from_board) {
  double squared_m = 0, squared_px = 0;
  for (const Eigen::Vector3f& position : truth.mesh.positions) {
    const Eigen::Vector3d point = truth.board_from_object * position.cast<double>();
    const Eigen::Vector3d at = camera_from_board * point;
    const Eigen::Vector3d should = true_camera_from_board * point;
    squared_m += (at - should).squaredNorm();
    const double focal_px = truth.camera.intrinsics().focal_px.x();
    squared_px +=
        at.z() > 0 ? (focal_px * (at.hnormalized() - should.hnormalized())).squaredNorm() : 1e6;
  }
  const auto count = static_cast<double>(truth.mesh.positions.size());
  const Eigen::AngleAxisd turn(camera_from_board.linear() *
                               true_camera_from_board.linear().transpose());
  return {1000 * std::sqrt(squared_m / count), turn.angle() * 180 / std::numbers::pi,
          std::sqrt(squared_px / count)};
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Poses of a session's frames under a gate; none where no frame gets one.
std::vector<pipeline::PosedFrame> poses_of(const std::filesystem::path& folder,
                                           const capture::PoseGate& gate) {
  pipeline::FrameChoice choice;
  choice.gate = gate;
  pipeline::ProgressSink silent;
  try {
    capture::Session session = capture::open_session(folder);
    pipeline::complete_readout(session, choice, silent);
    return pipeline::pose_frames(session, choice, silent);
  } catch (const core::Error&) {
    return {};
  }
}

void judge_poses(const std::filesystem::path& folder, const StressRecording& damaged,
                 const StressRecording& truth, StressRow& row) {
  constexpr capture::PoseGate everything{
      .min_tags = 1, .max_reprojection_px = 1e3, .max_blur_px = 1e3};
  const auto error_of = [&](const pipeline::PosedFrame& frame) {
    const auto index = static_cast<std::size_t>(frame.index);
    return pose_error(truth, frame.camera_from_board, damaged.board_from_camera[index].inverse());
  };
  std::vector<bool> is_posed(damaged.light.size());
  std::vector<double> mm, deg;
  for (const pipeline::PosedFrame& frame : poses_of(folder, {})) {
    is_posed[static_cast<std::size_t>(frame.index)] = true;
    const PoseError error = error_of(frame);
    mm.push_back(error.mm);
    deg.push_back(error.deg);
    row.wrongly_posed += error.px > kWrongPose_px ? 1 : 0;
  }
  row.frames = static_cast<int>(damaged.light.size());
  row.posed = static_cast<int>(mm.size());
  row.refused = row.frames - row.posed;
  row.pose_error_mm = median(mm);
  row.pose_error_deg = median(deg);
  if (row.refused == 0) return;
  row.rightly_refused = row.refused;
  for (const pipeline::PosedFrame& frame : poses_of(folder, everything)) {
    const bool was_refused = !is_posed[static_cast<std::size_t>(frame.index)];
    if (was_refused && error_of(frame).px <= kWrongPose_px) --row.rightly_refused;
  }
}

void replace_all(std::string& text, const std::string& part, const std::string& by) {
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + by.size())) {
    text.replace(at, part.size(), by);
  }
}

/// Notes without the session's folder, whose name differs from session to session.
std::vector<std::string> without_folder(std::vector<std::string> notes,
                                        const std::filesystem::path& folder) {
  for (std::string& note : notes) {
    replace_all(note, folder.string() + "/", "");
    replace_all(note, folder.string(), "session");
  }
  return notes;
}

void judge_models(const std::filesystem::path& folder, int threads, render::Context& gl,
                  StressRow& row) {
  Notes sink;
  try {
    const Observations observations = observe_session(folder, {}, true, threads, sink);
    for (const Candidate& candidate :
         candidates_named({kStressCandidates.begin(), kStressCandidates.end()})) {
      // In the order of the table, which is not the registry's.
      const auto place = std::ranges::find(kStressCandidates, candidate.name);
      const auto i = static_cast<std::size_t>(place - kStressCandidates.begin());
      row.psnr_db.resize(kStressCandidates.size(), std::nan(""));
      row.psnr_db[i] =
          measure_candidate(candidate, observations, gl, folder / "model.glb", threads, sink)
              .error.psnr_db;
    }
  } catch (const core::Error& error) {
    row.refusal = without_folder({error.what()}, folder).front();
    row.psnr_db.clear();
  }
  row.notes = without_folder(sink.lines, folder);
}

void drop_known_notes(const std::vector<std::string>& known, StressRow& row) {
  std::erase_if(row.notes, [&](const std::string& note) {
    return std::ranges::find(known, note) != known.end();
  });
}

std::vector<StressKind> chosen(const std::vector<std::string>& only) {
  std::vector<StressKind> kinds = stress_kinds();
  for (const std::string& name : only) {
    if (std::ranges::find(kinds, name, &StressKind::name) == kinds.end()) {
      std::string names;
      for (const StressKind& kind : kinds) names += (names.empty() ? "" : ", ") + kind.name;
      throw std::invalid_argument(fmt::format("only: {} is not one of {}", name, names));
    }
  }
  std::erase_if(kinds, [&](const StressKind& kind) {
    return !only.empty() && kind.name != "none" && std::ranges::find(only, kind.name) == only.end();
  });
  return kinds;
}

/// The first severity of a kind for which `is_so`, "-" where there is none.
template <typename Predicate>
std::string first_severity(std::span<const StressRow> rows, const std::string& kind,
                           const Predicate& is_so) {
  for (const StressRow& row : rows) {
    if (row.kind == kind && is_so(row)) return fmt::format("{:g}", row.severity);
  }
  return "-";
}

/// Infinitely bad where the session was refused.
double psnr(const StressRow& row, std::size_t candidate) {
  return row.psnr_db.empty() ? -std::numeric_limits<double>::infinity() : row.psnr_db[candidate];
}

}  // namespace

std::vector<StressRow> run_stress(const StressOptions& options,
                                  const std::vector<std::string>& only,
                                  const std::filesystem::path& folder, const Progress& progress) {
  const std::vector<StressKind> kinds = chosen(only);
  progress("rendering the undamaged session");
  const StressBase base = render_stress_base(options);
  const auto gl = render::make_context();
  std::vector<StressRow> rows;
  std::vector<std::string> known_notes;
  for (const StressKind& kind : kinds) {
    for (const double severity : kind.severities) {
      progress(fmt::format("{} {:g} {}", kind.name, severity, kind.unit));
      StressRecording damaged = base.recording;
      kind.damage(damaged, severity);
      // Never committed: it is removed at the end of this turn.
      const core::StagedOutput scratch(folder / "session");
      write_stress_session(scratch.path(), damaged, base.held_out, options.seed);
      StressRow row;
      row.kind = kind.name;
      row.unit = kind.unit;
      row.severity = severity;
      judge_poses(scratch.path(), damaged, base.recording, row);
      judge_models(scratch.path(), options.threads, *gl, row);
      if (rows.empty()) known_notes = row.notes;
      drop_known_notes(known_notes, row);
      progress(fmt::format("  {} of {} frames posed, {} dB, said: {}", row.posed, row.frames,
                           row.psnr_db.empty() ? "-" : decimals(row.psnr_db.front(), 2),
                           what_was_said(row)));
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

std::string what_was_said(const StressRow& row) {
  if (!row.refusal.empty()) return "refused";
  if (!row.notes.empty()) return "noted";
  return 5 * row.refused > row.frames ? "frames refused" : "nothing";
}

Table stress_table(std::span<const StressRow> rows) {
  Table table{"Sessions under stress",
              {"kind", "severity", "unit", "frames", "posed", "refused", "rightly", "posed wrongly",
               "error mm", "error deg"},
              {}};
  for (const char* candidate : kStressCandidates) {
    table.columns.push_back(fmt::format("{} dB", candidate));
  }
  table.columns.emplace_back("said");
  for (const StressRow& row : rows) {
    std::vector<std::string> line{row.kind,
                                  fmt::format("{:g}", row.severity),
                                  row.unit,
                                  std::to_string(row.frames),
                                  std::to_string(row.posed),
                                  std::to_string(row.refused),
                                  std::to_string(row.rightly_refused),
                                  std::to_string(row.wrongly_posed),
                                  row.posed > 0 ? decimals(row.pose_error_mm, 2) : "-",
                                  row.posed > 0 ? decimals(row.pose_error_deg, 2) : "-"};
    for (std::size_t i = 0; i < kStressCandidates.size(); ++i) {
      line.push_back(row.psnr_db.empty() ? "-" : decimals(row.psnr_db[i], 2));
    }
    line.push_back(what_was_said(row));
    table.rows.push_back(std::move(line));
  }
  return table;
}

Table stress_limits(std::span<const StressRow> rows) {
  constexpr double harm_db = 1;
  Table table{"First severity below the undamaged session's mean colours; harm in silence",
              {"kind", "unit"},
              {}};
  for (const char* candidate : kStressCandidates) table.columns.emplace_back(candidate);
  table.columns.emplace_back("first 1 dB lost in silence");
  if (rows.empty()) return table;
  const StressRow& clean = rows.front();
  const double floor_db = psnr(clean, kStressCandidates.size() - 1);
  for (const StressKind& kind : stress_kinds()) {
    const auto is_of_kind = [&](const StressRow& row) { return row.kind == kind.name; };
    if (kind.name == clean.kind || std::ranges::none_of(rows, is_of_kind)) continue;
    std::vector<std::string> line{kind.name, kind.unit};
    for (std::size_t i = 0; i < kStressCandidates.size(); ++i) {
      line.push_back(first_severity(rows, kind.name,
                                    [&](const StressRow& row) { return psnr(row, i) < floor_db; }));
    }
    line.push_back(first_severity(rows, kind.name, [&](const StressRow& row) {
      return what_was_said(row) == "nothing" && psnr(row, 0) < psnr(clean, 0) - harm_db;
    }));
    table.rows.push_back(std::move(line));
  }
  return table;
}

nlohmann::ordered_json to_json(std::span<const StressRow> rows) {
  nlohmann::ordered_json document = nlohmann::ordered_json::array();
  for (const StressRow& row : rows) {
    nlohmann::ordered_json psnr_db = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < row.psnr_db.size(); ++i)
      psnr_db[kStressCandidates[i]] = row.psnr_db[i];
    // Without a posed frame the errors are no numbers, which JSON spells null.
    document.push_back({{"kind", row.kind},
                        {"unit", row.unit},
                        {"severity", row.severity},
                        {"frames", row.frames},
                        {"posed", row.posed},
                        {"refused", row.refused},
                        {"rightly_refused", row.rightly_refused},
                        {"wrongly_posed", row.wrongly_posed},
                        {"pose_error_mm", row.pose_error_mm},
                        {"pose_error_deg", row.pose_error_deg},
                        {"psnr_db", psnr_db},
                        {"said", what_was_said(row)},
                        {"notes", row.notes},
                        {"refusal", row.refusal}});
  }
  return document;
}

}  // namespace sheen::evaluation
