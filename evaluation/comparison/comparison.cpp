// SPDX-License-Identifier: MIT
#include "evaluation/comparison/comparison.h"

#include "evaluation/comparison/pareto.h"

#include <algorithm>

namespace sheen::evaluation {
namespace {

template <typename Cost>
std::vector<std::uint8_t> front_of(std::span<const ComparedCandidate> rows, Cost cost) {
  std::vector<CostBenefit> points;
  points.reserve(rows.size());
  for (const ComparedCandidate& row : rows) {
    points.push_back({static_cast<double>(row.measured.*cost), row.measured.error.psnr_db});
  }
  return pareto_front(points);
}

void add(const CandidateMeasurement& part, CandidateMeasurement& sum) {
  sum.error.psnr_db += part.error.psnr_db;
  sum.live_psnr_db += part.live_psnr_db;
  sum.error.ssim += part.error.ssim;
  sum.error.rmse += part.error.rmse;
  sum.error.pixels += part.error.pixels;
  sum.worst_psnr_db += part.worst_psnr_db;
  sum.outline.box_psnr_db += part.outline.box_psnr_db;
  sum.outline.edge_difference += part.outline.edge_difference;
  sum.outline.hole_fraction += part.outline.hole_fraction;
  sum.pop_ratio += part.pop_ratio;
  sum.drawing_bytes += part.drawing_bytes;
  sum.views += part.views;
  sum.samples += part.samples;
  sum.patches += part.patches;
  sum.coefficients += part.coefficients;
  sum.model_bytes += part.model_bytes;
  sum.light_field_bytes += part.light_field_bytes;
  sum.fit_ms += part.fit_ms;
  sum.finish_ms += part.finish_ms;
  sum.fit_frame_ms += part.fit_frame_ms;
  sum.render_view_ms += part.render_view_ms;
}

void divide(CandidateMeasurement& sum, std::size_t count) {
  const auto divisor = static_cast<double>(count);
  for (double* figure :
       {&sum.error.psnr_db, &sum.live_psnr_db, &sum.error.ssim, &sum.error.rmse, &sum.worst_psnr_db,
        &sum.outline.box_psnr_db, &sum.outline.edge_difference, &sum.outline.hole_fraction,
        &sum.pop_ratio, &sum.fit_ms, &sum.finish_ms, &sum.fit_frame_ms, &sum.render_view_ms}) {
    *figure /= divisor;
  }
  for (std::size_t* figure : {&sum.error.pixels, &sum.views, &sum.samples, &sum.patches,
                              &sum.coefficients, &sum.drawing_bytes}) {
    *figure /= count;
  }
  sum.model_bytes /= count;
  sum.light_field_bytes /= count;
}

}  // namespace

void mark_fronts(std::span<ComparedCandidate> rows) {
  const auto fit_time = front_of(rows, &CandidateMeasurement::fit_frame_ms);
  const auto render_time = front_of(rows, &CandidateMeasurement::render_view_ms);
  const auto bytes = front_of(rows, &CandidateMeasurement::model_bytes);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].fronts = {fit_time[i] != 0, render_time[i] != 0, bytes[i] != 0};
  }
}

std::vector<ComparedCandidate> averages(const Comparison& comparison) {
  std::vector<ComparedCandidate> means;
  const std::size_t sessions = comparison.sessions.size();
  for (const Candidate& candidate : all_candidates()) {
    ComparedCandidate mean{{}, candidate, {}, {}};
    std::size_t count = 0;
    for (const ComparedCandidate& row : comparison.rows) {
      if (row.candidate.name != std::string_view(candidate.name)) continue;
      add(row.measured, mean.measured);
      ++count;
    }
    if (count == 0 || count != sessions) continue;
    divide(mean.measured, count);
    means.push_back(mean);
  }
  mark_fronts(means);
  return means;
}

std::vector<std::string> session_names(const std::vector<std::filesystem::path>& folders) {
  std::vector<std::string> names;
  for (const auto& folder : folders) {
    const auto full = std::filesystem::weakly_canonical(folder);
    // "box/" names the same folder as "box".
    names.push_back((full.has_filename() ? full : full.parent_path()).filename().string());
  }
  std::vector<std::string> unique = names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::count(names.begin(), names.end(), names[i]) > 1) unique[i] = folders[i].string();
  }
  return unique;
}

}  // namespace sheen::evaluation
