// SPDX-License-Identifier: MIT
#include "app/comparison/measure_candidate.h"

#include "app/evaluation/evaluate_views.h"
#include "app/interrupt.h"
#include "core/diagnostics/cpu_clock.h"
#include "core/diagnostics/stage_timer.h"
#include "fitting/model_file/model_file.h"
#include "render/surface/surface_renderer.h"

namespace sheen::app {
namespace {

/// Counts the CPU time of every image a renderer draws.
class TimedRenderer final : public render::SurfaceRenderer {
 public:
  explicit TimedRenderer(std::unique_ptr<render::SurfaceRenderer> inner)
      : inner_(std::move(inner)) {}

  void upload(const fitting::ModelUpdate& update) override { inner_->upload(update); }

  render::RenderedView render(const core::CameraModel& camera,
                              const Eigen::Isometry3d& camera_from_object) override {
    const double begin_cpu_ms = core::process_cpu_ms();
    render::RenderedView view = inner_->render(camera, camera_from_object);
    cpu_ms_.push_back(core::process_cpu_ms() - begin_cpu_ms);
    return view;
  }

  [[nodiscard]] core::StageSummary cpu_ms() const { return core::summarise(cpu_ms_); }

 private:
  std::unique_ptr<render::SurfaceRenderer> inner_;
  std::vector<double> cpu_ms_;
};

/// Returns the CPU time of the whole fit, ms.
double fit(fitting::Fitter& fitter, const std::vector<core::SampleBatch>& views) {
  const double begin_cpu_ms = core::process_cpu_ms();
  for (const core::SampleBatch& view : views) {
    throw_if_interrupted();
    fitter.integrate(view);
  }
  fitter.finish();
  return core::process_cpu_ms() - begin_cpu_ms;
}

std::uintmax_t bytes_of(const core::Mesh& mesh, const fitting::LightField& light_field,
                        const std::filesystem::path& scratch) {
  fitting::write_model(scratch, mesh, light_field);
  const std::uintmax_t bytes = std::filesystem::file_size(scratch);
  std::filesystem::remove(scratch);
  return bytes;
}

}  // namespace

Measurement measure_candidate(const Candidate& candidate, const Observations& observations,
                              render::Context& gl, const std::filesystem::path& scratch,
                              int threads) {
  // Fit.
  Measurement measurement;
  const auto fitter = make_fitter(candidate, observations.neighbours, threads);
  measurement.fit_ms = fit(*fitter, observations.views);
  measurement.fit_frame_ms = measurement.fit_ms / static_cast<double>(observations.views.size());

  // Weigh.
  const fitting::LightField& light_field = fitter->light_field();
  measurement.samples = fitter->statistics().samples;
  measurement.patches = light_field.patch_count();
  measurement.coefficients = light_field.coefficient_count();
  measurement.model_bytes = bytes_of(observations.mesh, light_field, scratch);

  // Draw and compare.
  TimedRenderer renderer(render::make_gl_surface_renderer(gl, observations.mesh, light_field));
  render::SurfaceRenderer* const renderers[] = {&renderer};
  const auto summaries = evaluate_views(observations.held_out_session, observations.held_out,
                                        renderers, [](const ComparedView&) {});
  measurement.error = summaries.front().mean;
  measurement.views = summaries.front().views.size();
  measurement.render_view_ms = renderer.cpu_ms().median;
  return measurement;
}

}  // namespace sheen::app
