// SPDX-License-Identifier: MIT
#include "evaluation/study/measure.h"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace sheen::evaluation {
namespace {

// CPU time of this thread: what others do on the machine does not count.
double thread_cpu_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

struct SquaredSum {
  double sum = 0;
  std::size_t count = 0;
  void add(double squared, std::size_t channels) {
    sum += squared;
    count += channels;
  }
  [[nodiscard]] double root_mean() const {
    return count == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(count));
  }
};

template <typename Value>
double mean_over(const std::vector<PointError>& points, const Value& value) {
  double sum = 0;
  for (const PointError& point : points) sum += value(point);
  return points.empty() ? 0.0 : sum / static_cast<double>(points.size());
}

}  // namespace

PointError point_error(const fitting::PatchLightField& light_field, std::size_t patch_idx,
                       std::span<const TestSample> test) {
  SquaredSum all;
  SquaredSum gap;
  double worst = 0;
  for (const TestSample& sample : test) {
    const Eigen::Vector3f colour = light_field.evaluate(patch_idx, sample.uv).colour();
    const Eigen::Vector3f shown = colour.cwiseMax(0.0f).cwiseMin(1.0f);
    const auto squared = static_cast<double>((shown - sample.rgb).squaredNorm());
    all.add(squared, 3);
    if (sample.held_out_sector) gap.add(squared, 3);
    worst = std::max(worst, static_cast<double>((colour - sample.rgb).cwiseAbs().maxCoeff()));
  }
  return {all.root_mean(), worst, gap.root_mean()};
}

std::vector<PointError> point_errors(const fitting::PatchLightField& light_field,
                                     const StudySet& set) {
  std::vector<PointError> errors;
  for (std::size_t i = 0; i < set.points.size(); ++i) {
    errors.push_back(point_error(light_field, i, set.points[i].test));
  }
  return errors;
}

double Measurement::mean_rms() const {
  return mean_over(points, [](const PointError& point) { return point.rms; });
}

double Measurement::rms_spread() const {
  const double mean = mean_rms();
  const double variance = mean_over(
      points, [&](const PointError& point) { return (point.rms - mean) * (point.rms - mean); });
  return std::sqrt(variance);
}

double Measurement::mean_rms_in_gap() const {
  return mean_over(points, [](const PointError& point) { return point.rms_in_gap; });
}

double Measurement::worst95() const {
  if (points.empty()) return 0;
  std::vector<double> worst;
  for (const PointError& point : points) worst.push_back(point.worst);
  const std::size_t rank = (worst.size() - 1) * 95 / 100;
  std::nth_element(worst.begin(), worst.begin() + static_cast<std::ptrdiff_t>(rank), worst.end());
  return worst[rank];
}

double Measurement::pooled_psnr_db(const StudySet& set) const {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    sum += points[i].rms * points[i].rms * static_cast<double>(set.points[i].test.size());
    count += set.points[i].test.size();
  }
  constexpr double floor = 1e-12;  // an exact model shows 120 dB
  return -10.0 * std::log10(std::max(floor, sum / static_cast<double>(count)));
}

Measurement measure(const Method& method, const StudySet& set) {
  const std::vector<core::SampleBatch> batches = set.batches();
  const auto fitter = method.make(set.points.size());
  // Fit.
  const double start_us = thread_cpu_us();
  for (const core::SampleBatch& batch : batches) fitter->integrate(batch);
  fitter->finish();
  const double elapsed_us = thread_cpu_us() - start_us;
  // Compare.
  const fitting::PatchLightField& light_field = fitter->light_field();
  Measurement result;
  result.points = point_errors(light_field, set);
  result.coefficients_per_point =
      static_cast<double>(light_field.coefficient_count()) / static_cast<double>(set.points.size());
  result.fit_us = elapsed_us / static_cast<double>(std::max<std::size_t>(1, set.sample_count()));
  return result;
}

}  // namespace sheen::evaluation
