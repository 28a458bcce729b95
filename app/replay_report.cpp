// SPDX-License-Identifier: MIT
#include "app/replay_report.h"

#include "core/numerics/median.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>

namespace sheen::app {
namespace {

// The order of the pipeline; a stage that never ran is reported as zero.
constexpr const char* kStages[] = {"decode", "pose", "correct", "visibility",
                                   "sample", "fit",  "update"};

std::size_t peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

double per_patch(const ReplayReport& report) {
  return report.patches == 0
             ? 0.0
             : static_cast<double>(report.coefficients) / static_cast<double>(report.patches);
}

double fits_per_patch_per_view(const fitting::FitStatistics& fit) {
  return fit.patch_views == 0
             ? 0.0
             : static_cast<double>(fit.fits) / static_cast<double>(fit.patch_views);
}

int rejected(const pipeline::FrameStatistics& frames) {
  int sum = frames.frames_refused;
  for (const auto& [reason, count] : frames.pose_rejections) sum += count;
  return sum;
}

double median_of(std::vector<double> values) {
  return values.empty() ? 0 : core::upper_median(values);
}

nlohmann::ordered_json to_json(const core::StageSummary& summary) {
  return {{"mean", summary.mean}, {"median", summary.median}, {"p95", summary.p95}};
}

nlohmann::ordered_json held_out_json(const std::optional<evaluation::EvaluationSummary>& summary) {
  if (!summary) return nullptr;
  nlohmann::ordered_json document = evaluation::to_json(summary->mean);
  document["views"] = summary->views.size();
  document["covered_fraction"] = summary->covered_fraction;
  return document;
}

/// Frames whose exposure was found and the gains' range.
nlohmann::ordered_json exposure_json(const std::vector<double>& gains) {
  if (gains.empty()) return {{"frames", 0}};
  const auto [least, most] = std::minmax_element(gains.begin(), gains.end());
  return {
      {"frames", gains.size()}, {"least", *least}, {"median", median_of(gains)}, {"most", *most}};
}

nlohmann::ordered_json board_json(const std::optional<capture::BoardRefinement>& board) {
  if (!board) return nullptr;
  return {{"views", board->views},
          {"tags", board->tags},
          {"rms_before_px", board->rms_before_px},
          {"rms_after_px", board->rms_after_px},
          {"median_shift_mm", 1000 * board->median_shift_m}};
}

nlohmann::ordered_json placement_json(const std::optional<pipeline::MeshPlacement>& placement) {
  if (!placement) return nullptr;
  const Eigen::Vector3d shift_mm = 1000 * placement->shift_m;
  return {{"shift_mm", {shift_mm.x(), shift_mm.y(), shift_mm.z()}},
          {"growth", placement->growth},
          {"residual_change", placement->residual_change}};
}

std::string placement_text(const pipeline::MeshPlacement& placement) {
  return fmt::format(
      "mesh     placed: {:.2f} mm aside, {:+.2f} % of its size, residual on check views {:+.1f} "
      "%\n",
      1000 * placement.shift_m.norm(), 100 * placement.growth, 100 * placement.residual_change);
}

nlohmann::ordered_json mesh_json(const std::optional<pipeline::MeshRefinement>& mesh) {
  if (!mesh) return nullptr;
  return {{"accepted", mesh->is_accepted},
          {"median_mm", mesh->median_mm},
          {"residual_change", mesh->residual_change},
          {"views", mesh->views},
          {"check_views", mesh->check_views}};
}

std::string mesh_text(const pipeline::MeshRefinement& mesh) {
  if (mesh.is_accepted) {
    return fmt::format("mesh     refined: median {:.2g} mm, residual on check views {:+.1f} %\n",
                       mesh.median_mm, 100 * mesh.residual_change);
  }
  return fmt::format("mesh     kept: residual on check views would change by {:+.1f} %\n",
                     100 * mesh.residual_change);
}

std::string held_out_row(const std::string& name, const evaluation::EvaluationSummary& summary) {
  return fmt::format("  {:<22}{:>8.2f} dB{:>8.4f}{:>9.4f}\n", name, summary.mean.psnr_db,
                     summary.mean.ssim, summary.mean.rmse);
}

std::string frames_text(const pipeline::FrameStatistics& frames) {
  std::string text = fmt::format(
      "frames   {} read, {} posed, {} rejected, {} fitted, {} held out\n", frames.frames_read,
      frames.posed.size(), rejected(frames), frames.frames_fitted, frames.held_out.size());
  if (frames.damaged > 0) {
    text += fmt::format("         {} more were damaged and left out\n", frames.damaged);
  }
  for (const auto& [reason, count] : frames.pose_rejections) {
    text += fmt::format("         {} refused: {}\n", count, reason);
  }
  if (frames.frames_refused > 0) {
    text += fmt::format("         {} refused: mismatch\n", frames.frames_refused);
  }
  if (!frames.reprojection_px.empty()) {
    text += fmt::format("pose     {:.2f} px median joint reprojection\n",
                        median_of(frames.reprojection_px));
  }
  return text;
}

std::string timing_text(const core::StageTimer& timer) {
  std::string text = "ms per frame (median CPU) ";
  for (const char* stage : kStages) {
    text += fmt::format(" {} {:.1f}", stage, timer.summary(stage).median);
  }
  return text + fmt::format("\n         whole frame: {:.1f} CPU, {:.1f} wall\n",
                            timer.frame_cpu().median, timer.frame_wall().median);
}

/// Of patches, or of photographs.
std::string model_text(const ReplayReport& report) {
  const double megabytes = static_cast<double>(report.model_bytes) / 1e6;
  if (report.patches == 0) {
    return fmt::format("model    {}: {:.2f} MB\n", report.representation, megabytes);
  }
  return fmt::format("model    {}: {} patches ({} seen), {:.0f} numbers each, {:.2f} MB\n",
                     report.representation, report.patches, report.patches_observed,
                     per_patch(report), megabytes);
}

}  // namespace

nlohmann::ordered_json to_json(const ReplayReport& report) {
  const pipeline::FrameStatistics& frames = report.frames;
  nlohmann::ordered_json stages;
  for (const char* stage : kStages) stages[stage] = to_json(report.timer.summary(stage));
  stages["align"] = to_json(report.timer.summary("align"));
  stages["evidence"] = to_json(report.timer.summary("evidence"));
  nlohmann::ordered_json vertices;
  for (std::size_t i = 1; i < frames.vertex_rejections.size(); ++i) {
    vertices[std::string(name_of(static_cast<core::VertexRejection>(i)))] =
        frames.vertex_rejections[i];
  }
  nlohmann::ordered_json findings = nlohmann::ordered_json::array();
  for (const pipeline::Finding& finding : report.findings) {
    findings.push_back({{"cause", finding.cause}, {"says", finding.line}});
  }
  nlohmann::ordered_json rejections = nlohmann::ordered_json::object();
  for (const auto& [reason, count] : frames.pose_rejections) rejections[reason] = count;
  if (frames.frames_refused > 0) rejections["mismatch"] = frames.frames_refused;
  return {{"frames",
           {{"read", frames.frames_read},
            {"posed", frames.posed.size()},
            {"rejected", rejected(frames)},
            {"fitted", frames.frames_fitted},
            {"damaged", frames.damaged},
            {"held_out", frames.held_out.size()}}},
          {"stage_ms", stages},
          {"frame_ms", to_json(report.timer.frame_wall())},
          {"cpu_ms", to_json(report.timer.frame_cpu())},
          {"finish_cpu_ms", report.finish_ms},
          {"fits_per_patch_per_view", fits_per_patch_per_view(report.fit)},
          {"patches", report.patches},
          {"patches_observed", report.patches_observed},
          {"samples", report.fit.samples},
          {"coefficients", report.coefficients},
          {"coefficients_per_patch", per_patch(report)},
          {"model_bytes", report.model_bytes},
          {"peak_rss_bytes", peak_rss_bytes()},
          {"representation", report.representation},
          {"choice", report.fit.choice.empty() ? nlohmann::ordered_json(nullptr)
                                               : nlohmann::ordered_json(report.fit.choice)},
          {"held_out", held_out_json(report.held_out)},
          {"held_out_mean_colour", held_out_json(report.held_out_mean)},
          {"held_out_refined_poses", held_out_json(report.held_out_refined_poses)},
          {"pose_refinement",
           {{"refined", frames.refined_px.size()}, {"motion_px", median_of(frames.refined_px)}}},
          {"board_refinement", board_json(report.board)},
          {"mesh_placement", placement_json(report.placement)},
          {"mesh_refinement", mesh_json(report.mesh)},
          {"exposure", exposure_json(frames.gains)},
          {"levelled_by_paper", report.is_levelled},
          {"readout_ms", 1e3 * report.readout_s},
          {"reprojection_px", frames.reprojection_px.empty()
                                  ? nlohmann::ordered_json(nullptr)
                                  : nlohmann::ordered_json(median_of(frames.reprojection_px))},
          {"rejections", rejections},
          {"findings", findings},
          {"vertex_rejections", vertices},
          {"coverage", report.coverage ? evaluation::to_json(*report.coverage)
                                       : nlohmann::ordered_json(nullptr)},
          {"options", report.options}};
}

std::string to_text(const ReplayReport& report) {
  std::string text = frames_text(report.frames);
  if (report.placement) text += placement_text(*report.placement);
  if (report.mesh) text += mesh_text(*report.mesh);
  text += model_text(report);
  if (!report.fit.choice.empty()) text += fmt::format("         {}\n", report.fit.choice);
  text += fmt::format(
      "fit      {} samples, {:.1f} least-squares fits per patch per view, {:.0f} ms at the end\n",
      report.fit.samples, fits_per_patch_per_view(report.fit), report.finish_ms);
  if (report.held_out && !report.held_out->views.empty()) {
    text += fmt::format("held out {} views        PSNR    SSIM     RMSE\n",
                        report.held_out->views.size());
    text += held_out_row(report.representation, *report.held_out);
    if (report.held_out_mean) text += held_out_row("mean colour", *report.held_out_mean);
    if (report.held_out_refined_poses) {
      text += held_out_row("with refined poses", *report.held_out_refined_poses);
    }
  }
  return text + timing_text(report.timer);
}

}  // namespace sheen::app
