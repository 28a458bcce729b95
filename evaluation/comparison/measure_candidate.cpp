// SPDX-License-Identifier: MIT
#include "evaluation/comparison/measure_candidate.h"

#include "core/diagnostics/cpu_clock.h"
#include "core/diagnostics/stage_timer.h"
#include "core/mesh/bounds.h"
#include "evaluation/views/evaluate_views.h"
#include "fitting/descriptor.h"
#include "fitting/model_file/model_file.h"
#include "fitting/patch_light_field.h"
#include "pipeline/texel_size.h"
#include "render/renderer.h"

namespace sheen::evaluation {
namespace {

/// Counts the CPU time of every image a renderer draws.
class TimedRenderer final : public render::Renderer {
 public:
  explicit TimedRenderer(std::unique_ptr<render::Renderer> inner) : inner_(std::move(inner)) {}

  std::size_t upload(std::span<const std::uint32_t> elements) override {
    return inner_->upload(elements);
  }

  render::RenderedView render(const core::CameraModel& camera,
                              const Eigen::Isometry3d& camera_from_object) override {
    const double begin_cpu_ms = core::process_cpu_ms();
    render::RenderedView view = inner_->render(camera, camera_from_object);
    cpu_ms_.push_back(core::process_cpu_ms() - begin_cpu_ms);
    return view;
  }

  [[nodiscard]] core::StageSummary cpu_ms() const { return core::summarise(cpu_ms_); }

 private:
  std::unique_ptr<render::Renderer> inner_;
  std::vector<double> cpu_ms_;
};

std::uintmax_t bytes_of(const core::Mesh& mesh, const fitting::LightField& light_field,
                        const std::filesystem::path& scratch) {
  fitting::write_model(scratch, mesh, light_field);
  const std::uintmax_t bytes = std::filesystem::file_size(scratch);
  std::filesystem::remove(scratch);
  return bytes;
}

struct DrawnViews {
  core::ImageError error;  ///< means
  std::size_t count;
  double render_ms;  ///< CPU per view, median
};

/// Draws the held-out views and compares.
DrawnViews draw_views(const fitting::LightField& light_field, const Observations& observations,
                      render::Context& gl, int threads) {
  TimedRenderer renderer(render::make_renderer(gl, observations.mesh, light_field, threads));
  render::Renderer* const renderers[] = {&renderer};
  const auto summaries =
      evaluate_views(gl, {observations.held_out_session, observations.mesh, observations.held_out},
                     renderers, [](const ComparedView&) {});
  const auto& summary = summaries.front();
  return {summary.mean, summary.views.size(), renderer.cpu_ms().median};
}

/// What a pixel covers on the object.
double texel_size_m(const Observations& observations) {
  std::vector<Eigen::Isometry3d> poses;
  for (const pipeline::IntegratedView& view : observations.views) {
    poses.push_back(view.camera_from_object);
  }
  return pipeline::pixel_footprint_m(poses,
                                     core::bounds_of(observations.mesh).center().cast<double>(),
                                     observations.session.camera.intrinsics().focal_px.x());
}

}  // namespace

Measurement measure_candidate(const Candidate& candidate, const Observations& observations,
                              render::Context& gl, const std::filesystem::path& scratch,
                              int threads, pipeline::ProgressSink& sink) {
  // Fit.
  Measurement measurement;
  fitting::OptionValues values = candidate.options;
  if (pipeline::asks_texel_size(candidate.representation, values)) {
    pipeline::set_texel_size(texel_size_m(observations), values);
  }
  const auto fitter =
      fitting::make_fitter(candidate.representation, observations.mesh, values, threads);
  const fitting::LightField& light_field = fitter->light_field();
  const double begin_cpu_ms = core::process_cpu_ms();
  integrate_all(observations, threads, *fitter, sink);
  const double integrated_cpu_ms = core::process_cpu_ms();
  measurement.live_psnr_db = draw_views(light_field, observations, gl, threads).error.psnr_db;
  const double drawn_cpu_ms = core::process_cpu_ms();
  fitter->finish();
  measurement.finish_ms = core::process_cpu_ms() - drawn_cpu_ms;
  measurement.fit_ms = integrated_cpu_ms - begin_cpu_ms + measurement.finish_ms;
  measurement.fit_frame_ms = measurement.fit_ms / static_cast<double>(observations.views.size());

  // Weigh.
  const auto* const patches = fitting::as_patches(light_field);
  measurement.samples = fitter->statistics().samples;
  measurement.patches = patches != nullptr ? patches->patch_count() : 0;
  measurement.coefficients = light_field.coefficient_count();
  measurement.model_bytes = bytes_of(observations.mesh, light_field, scratch);
  measurement.light_field_bytes = fitting::byte_size(light_field);

  // Draw and compare.
  const DrawnViews drawn = draw_views(light_field, observations, gl, threads);
  measurement.error = drawn.error;
  measurement.views = drawn.count;
  measurement.render_view_ms = drawn.render_ms;
  return measurement;
}

}  // namespace sheen::evaluation
