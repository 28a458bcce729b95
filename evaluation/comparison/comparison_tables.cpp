// SPDX-License-Identifier: MIT
#include "evaluation/comparison/comparison_tables.h"

#include <fmt/format.h>

namespace sheen::evaluation {
namespace {

/// None for models without patches.
double coefficients_per_patch(const CandidateMeasurement& measured) {
  if (measured.patches == 0) return 0;
  return static_cast<double>(measured.coefficients) / static_cast<double>(measured.patches);
}

nlohmann::ordered_json to_json(const ComparedCandidate& row) {
  const CandidateMeasurement& m = row.measured;
  return {{"session", row.session},
          {"candidate", row.candidate.name},
          {"label", row.candidate.label},
          {"family", row.candidate.family},
          {"psnr", m.error.psnr_db},
          {"live_psnr", m.live_psnr_db},
          {"ssim", m.error.ssim},
          {"rmse", m.error.rmse},
          {"worst_psnr", m.worst_psnr_db},
          {"box_psnr", m.outline.box_psnr_db},
          {"edge_difference", m.outline.edge_difference},
          {"holes", m.outline.hole_fraction},
          {"pop_ratio", m.pop_ratio},
          {"views", m.views},
          {"samples", m.samples},
          {"patches", m.patches},
          {"coefficients", m.coefficients},
          {"coefficients_per_patch", coefficients_per_patch(m)},
          {"model_bytes", m.model_bytes},
          {"light_field_bytes", m.light_field_bytes},
          {"drawing_bytes", m.drawing_bytes},
          {"fit_ms", m.fit_ms},
          {"finish_ms", m.finish_ms},
          {"fit_ms_per_frame", m.fit_frame_ms},
          {"render_ms_per_view", m.render_view_ms},
          {"front_fit_time", row.fronts.fit_time},
          {"front_render_time", row.fronts.render_time},
          {"front_bytes", row.fronts.bytes}};
}

nlohmann::ordered_json to_json(const std::vector<ComparedCandidate>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ComparedCandidate& row : rows) list.push_back(to_json(row));
  return list;
}

/// Quoted where a reader would otherwise see more than one field.
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char character : text) quoted += character == '"' ? "\"\"" : std::string(1, character);
  return quoted + '"';
}

std::string csv_value(const nlohmann::ordered_json& value) {
  if (value.is_string()) return csv_field(value.get<std::string>());
  if (value.is_boolean()) return value.get<bool>() ? "1" : "0";
  return value.dump();
}

std::string session_text(const Comparison& comparison, const ComparedSession& session) {
  std::string text = fmt::format(
      "{}: {} frames fitted, {} views held out ({})\n"
      "  {:<22}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>7}{:>10}{:>10}{:>10}{:>11}  front\n",
      session.name, session.fitted_frames, session.held_out_views,
      session.has_own_held_out ? "the session's own held_out/" : "from its frames", "candidate",
      "PSNR dB", "live dB", "worst dB", "box dB", "SSIM", "edge", "holes %", "pop", "KB",
      "MB drawn", "fit ms", "render ms");
  for (const ComparedCandidate& row : comparison.rows) {
    if (row.session != session.name) continue;
    const CandidateMeasurement& m = row.measured;
    std::string front = row.fronts.bytes ? " bytes" : "";
    if (row.fronts.fit_time) front += " fit";
    if (row.fronts.render_time) front += " render";
    text += fmt::format(
        "  {:<22}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.4f}{:>9.2f}{:>9.2f}{:>7.1f}{:>10.0f}{:>10.1f}"
        "{:>10.1f}{:>11.1f} {}\n",
        row.candidate.name, m.error.psnr_db, m.live_psnr_db, m.worst_psnr_db, m.outline.box_psnr_db,
        m.error.ssim, m.outline.edge_difference, 100 * m.outline.hole_fraction, m.pop_ratio,
        static_cast<double>(m.model_bytes) / 1e3, static_cast<double>(m.drawing_bytes) / 1e6,
        m.fit_frame_ms, m.render_view_ms, front);
  }
  return text;
}

}  // namespace

std::string to_csv(const Comparison& comparison) {
  // The columns are the fields of the JSON document, so that both say the same.
  std::string csv;
  for (const ComparedCandidate& row : comparison.rows) {
    const nlohmann::ordered_json fields = to_json(row);
    std::string names;
    std::string values;
    for (const auto& [name, value] : fields.items()) {
      const char* const separator = names.empty() ? "" : ",";
      names.append(separator).append(name);
      values.append(separator).append(csv_value(value));
    }
    if (csv.empty()) csv = names + '\n';
    csv += values + '\n';
  }
  return csv;
}

std::string to_text(const Comparison& comparison) {
  std::string text;
  for (const ComparedSession& session : comparison.sessions) {
    text += session_text(comparison, session) + '\n';
  }
  for (const LeftOutCandidate& left : comparison.left_out) {
    text += fmt::format("left out: {} on {}: {}\n", left.candidate, left.session, left.reason);
  }
  return text;
}

nlohmann::ordered_json to_json(const Comparison& comparison, const std::optional<Advice>& advice) {
  nlohmann::ordered_json document;
  document["sessions"] = nlohmann::ordered_json::array();
  for (const ComparedSession& session : comparison.sessions) {
    document["sessions"].push_back({{"name", session.name},
                                    {"folder", session.folder},
                                    {"fitted_frames", session.fitted_frames},
                                    {"held_out_views", session.held_out_views},
                                    {"has_own_held_out", session.has_own_held_out}});
  }
  document["results"] = to_json(comparison.rows);
  document["averages"] = to_json(averages(comparison));
  document["left_out"] = nlohmann::ordered_json::array();
  for (const LeftOutCandidate& left : comparison.left_out) {
    document["left_out"].push_back(
        {{"session", left.session}, {"candidate", left.candidate}, {"reason", left.reason}});
  }
  document["advice"] = nullptr;
  if (advice) {
    document["advice"] = {{"candidate", advice->candidate}, {"sentence", advice->sentence}};
  }
  return document;
}

}  // namespace sheen::evaluation
