// SPDX-License-Identifier: MIT
#include "app/comparison/measure_candidate.h"

#include "app/evaluation/evaluate_views.h"
#include "app/interrupt.h"
#include "core/diagnostics/stage_timer.h"
#include "fitting/model_file/model_file.h"
#include "render/surface/surface_renderer.h"

namespace sheen::app {
namespace {

constexpr const char* kAbsorb = "absorb";
constexpr const char* kFinish = "finish";

/// Counts the CPU time of every picture a renderer draws.
class TimedRenderer final : public render::SurfaceRenderer {
 public:
  explicit TimedRenderer(std::unique_ptr<render::SurfaceRenderer> inner)
      : inner_(std::move(inner)) {}

  void upload(const fitting::ModelUpdate& update) override { inner_->upload(update); }

  render::RenderedView render(const core::CameraModel& camera,
                              const Eigen::Isometry3d& camera_from_object) override {
    const auto timing = timer_.measure_frame();
    return inner_->render(camera, camera_from_object);
  }

  [[nodiscard]] core::StageSummary cpu_ms() const { return timer_.frame_cpu(); }

 private:
  std::unique_ptr<render::SurfaceRenderer> inner_;
  core::StageTimer timer_;
};

/// Returns the CPU time of the whole fit, ms.
double fit(fitting::Representation& representation, const std::vector<core::SampleBatch>& views) {
  core::StageTimer timer;
  for (const core::SampleBatch& view : views) {
    throw_if_interrupted();
    const auto frame = timer.measure_frame();
    const auto timing = timer.measure(kAbsorb);
    representation.absorb(view);
  }
  {
    const auto frame = timer.measure_frame();
    const auto timing = timer.measure(kFinish);
    representation.finish();
  }
  return timer.summary(kAbsorb).mean * static_cast<double>(views.size()) +
         timer.summary(kFinish).mean;
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
  const auto representation = make_representation(candidate, observations.neighbours, threads);
  measurement.fit_ms = fit(*representation, observations.views);
  measurement.fit_frame_ms = measurement.fit_ms / static_cast<double>(observations.views.size());

  // Weigh.
  const fitting::LightField& light_field = representation->light_field();
  measurement.samples = representation->statistics().samples;
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
