// SPDX-License-Identifier: MIT
#include "evaluation/comparison/measure_candidate.h"

#include "core/diagnostics/cpu_clock.h"
#include "core/diagnostics/stage_timer.h"
#include "core/mesh/bounds.h"
#include "evaluation/comparison/smooth_path.h"
#include "evaluation/views/evaluate_views.h"
#include "fitting/descriptor.h"
#include "fitting/model_file/model_file.h"
#include "fitting/patch_light_field.h"
#include "pipeline/texel_size.h"
#include "render/renderer.h"

#include <malloc.h>

#include <algorithm>

namespace sheen::evaluation {
namespace {

constexpr double kBest_db = 99;

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

/// Bytes that are allocated, of all threads.
std::size_t allocated_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

struct DrawnViews {
  core::ImageError error;  ///< means
  double worst_psnr_db;
  OutlineError outline;  ///< means
  std::size_t count;
  double render_ms;  ///< CPU per view, median
};

const pipeline::PosedFrame& held_out_frame(const Observations& observations, int index) {
  return *std::ranges::find(observations.held_out, index, &pipeline::PosedFrame::index);
}

/// Draws the held-out views and compares.
DrawnViews draw_views(const fitting::LightField& light_field, const Observations& observations,
                      render::Context& gl, int threads) {
  TimedRenderer renderer(render::make_renderer(gl, observations.mesh, light_field, threads));
  render::Renderer* const renderers[] = {&renderer};
  EdgeBand edges(observations.mesh, threads);
  DrawnViews drawn{{}, kBest_db, {}, 0, 0};
  const capture::Session& session = observations.held_out_session;
  const auto summaries = evaluate_views(
      gl, {session, observations.mesh, observations.held_out}, renderers,
      [&](const ComparedView& view) {
        const int index = view.photograph.index;
        const cv::Mat band = edges.seen_by(
            session.camera_of(index),
            held_out_frame(observations, index).camera_from_board * session.board_from_object);
        const OutlineError error =
            outline_error(view.rendered[0], view.photograph.image, view.mask, band);
        drawn.outline.box_psnr_db += error.box_psnr_db;
        drawn.outline.edge_difference += error.edge_difference;
        drawn.outline.hole_fraction += error.hole_fraction;
        drawn.worst_psnr_db = std::min(drawn.worst_psnr_db, view.errors[0].error.psnr_db);
      });
  const auto& summary = summaries.front();
  drawn.error = summary.mean;
  drawn.count = summary.views.size();
  for (double* const sum :
       {&drawn.outline.box_psnr_db, &drawn.outline.edge_difference, &drawn.outline.hole_fraction}) {
    *sum /= static_cast<double>(std::max<std::size_t>(drawn.count, 1));
  }
  drawn.render_ms = renderer.cpu_ms().median;
  return drawn;
}

/// A camera's way past the object, round what is its vertical on the board.
SmoothPath path_through(const Observations& observations) {
  const pipeline::IntegratedView& middle = observations.views[observations.views.size() / 2];
  return smooth_path(
      observations.session.camera_of(middle.frame_index), middle.camera_from_object,
      core::bounds_of(observations.mesh).center().cast<double>(),
      observations.session.board_from_object.linear().transpose() * Eigen::Vector3d::UnitZ());
}

/// Saves, reads back and draws as another program would: size of the file, memory, jumps.
void measure_saved(const fitting::LightField& light_field, const Observations& observations,
                   render::Context& gl, const std::filesystem::path& scratch, int threads,
                   CandidateMeasurement& measurement) {
  fitting::write_model(scratch, observations.mesh, light_field);
  measurement.model_bytes = std::filesystem::file_size(scratch);
  std::size_t with_model = 0;
  {
    const fitting::Model model = fitting::read_model(scratch);
    std::filesystem::remove(scratch);
    const auto renderer = render::make_renderer(gl, model.mesh, *model.light_field, threads);
    measurement.pop_ratio = pop_ratio(*renderer, path_through(observations));
    with_model = allocated_bytes();
  }
  // What is given back is what was needed.
  const std::size_t without = allocated_bytes();
  measurement.drawing_bytes = with_model > without ? with_model - without : 0;
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

CandidateMeasurement measure_candidate(const Candidate& candidate, const Observations& observations,
                                       render::Context& gl, const std::filesystem::path& scratch,
                                       int threads, pipeline::ProgressSink& sink) {
  // Fit.
  CandidateMeasurement measurement;
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
  measure_saved(light_field, observations, gl, scratch, threads, measurement);
  measurement.light_field_bytes = fitting::byte_size(light_field);

  // Draw and compare.
  const DrawnViews drawn = draw_views(light_field, observations, gl, threads);
  measurement.error = drawn.error;
  measurement.worst_psnr_db = drawn.worst_psnr_db;
  measurement.outline = drawn.outline;
  measurement.views = drawn.count;
  measurement.render_view_ms = drawn.render_ms;
  return measurement;
}

}  // namespace sheen::evaluation
