// SPDX-License-Identifier: MIT
// How memory and time of a fit grow: samples of a glossy object go straight into a fitter,
// view after view of a walk at the pace of the synthetic sessions, without images. One line of
// CSV each time the number of views has doubled.
#include "bench/micro/walk.h"
#include "capture/synthetic/camera_path.h"
#include "capture/synthetic/hash.h"
#include "core/diagnostics/cpu_clock.h"
#include "core/samples/observation.h"
#include "core/visibility/raster_visibility.h"
#include "fitting/descriptor.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>

namespace sheen::bench {
namespace {

struct ScaleOptions {
  std::string fitter = "sparse";
  int vertices = 31'000;
  int views = 1'000;
  int threads = 2;
};

/// Patterned enamel under one lamp, with a sensor's noise.
class GlossyObject {
 public:
  explicit GlossyObject(const core::Mesh& mesh) : mesh_(mesh) {}

  void photograph(const core::VertexView& view, const Eigen::Vector3f& eye, std::uint32_t view_idx,
                  core::SampleBatch& batch) const {
    batch.clear();
    for (std::uint32_t i = 0; i < view.rejection.size(); ++i) {
      if (view.rejection[i] != core::VertexRejection::none) continue;
      const float highlight = highlight_at(i, eye);
      const Eigen::Vector3f wave = 60.0f * mesh_.positions[i];
      batch.patch.push_back(i);
      batch.u.push_back(view.u[i]);
      batch.v.push_back(view.v[i]);
      batch.r.push_back(value(0.4f + 0.2f * std::sin(wave.x()) + highlight, view_idx, i, 0));
      batch.g.push_back(value(0.3f + 0.2f * std::sin(wave.y()) + highlight, view_idx, i, 1));
      batch.b.push_back(value(0.3f + 0.2f * std::sin(wave.z()) + highlight, view_idx, i, 2));
    }
  }

 private:
  /// Blinn's lobe about a lamp from above.
  [[nodiscard]] float highlight_at(std::uint32_t i, const Eigen::Vector3f& eye) const {
    const Eigen::Vector3f lamp = Eigen::Vector3f(0.3f, 0.2f, 1.0f).normalized();
    const Eigen::Vector3f half = ((eye - mesh_.positions[i]).normalized() + lamp).normalized();
    return 0.6f * std::pow(std::max(0.0f, half.dot(mesh_.normals[i])), 60.0f);
  }

  /// Noise of the sensor as in the synthetic sessions' middle grey: uniform, +-0.01.
  static float value(float radiance, std::uint32_t view_idx, std::uint32_t patch,
                     std::uint32_t channel) {
    using capture::synthetic::hash;
    const float noise = capture::synthetic::unit_float(hash(view_idx, patch, channel)) - 0.5f;
    return std::clamp(radiance + 0.02f * noise, 0.0f, 1.0f);
  }

  const core::Mesh& mesh_;
};

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024e-6;  // Linux counts in KiB
}

capture::synthetic::CameraPath path_round(const core::Mesh& mesh, int views) {
  constexpr double views_per_turn = 40;  // of the synthetic sessions
  double radius_m = 0;
  for (const Eigen::Vector3f& position : mesh.positions) {
    radius_m = std::max(radius_m, static_cast<double>(position.norm()));
  }
  auto options = capture::synthetic::recording_path(1);
  options.turns = views / views_per_turn;
  return {options, Eigen::Vector3d::Zero(), radius_m};
}

/// Mean CPU milliseconds a view since the last line.
struct Line {
  double visibility_ms = 0, fit_ms = 0;
  int views = 0;

  void print(const ScaleOptions& options, int views_in_all) const {
    fmt::print("{},{},{},{:.1f},{:.3f},{:.3f}\n", options.fitter, options.vertices, views_in_all,
               peak_rss_mb(), visibility_ms / views, fit_ms / views);
    std::fflush(stdout);
  }
};

void run(const ScaleOptions& options) {
  const Walk& walk = walk_round(options.vertices);
  const core::SurfacePoints points = core::surface_points(walk.mesh);
  const auto visibility = core::make_raster_visibility(walk.mesh, options.threads);
  const GlossyObject object(walk.mesh);
  const auto fitter = fitting::make_fitter(options.fitter == "quadtree" ? "iwls" : options.fitter,
                                           walk.mesh, {}, options.threads);
  const auto path = path_round(walk.mesh, options.views);

  fmt::print("fitter,vertices,views,peak_rss_mb,visibility_ms,fit_ms\n");
  core::VertexView view;
  core::SampleBatch batch;
  const cv::Mat no_image;
  Line line;
  int next_line = 60;
  for (int v = 0; v < options.views; ++v) {
    const Eigen::Isometry3d pose =
        path.board_from_camera(static_cast<double>(v) / options.views).inverse();
    const double begin_ms = core::own_cpu_ms();
    core::project_vertices(points, walk.camera, pose, {}, options.threads, view);
    visibility->reject_occluded(walk.camera, pose, view);
    const double seen_ms = core::own_cpu_ms();
    object.photograph(view, core::eye_in_object(pose), static_cast<std::uint32_t>(v), batch);
    const double photographed_ms = core::own_cpu_ms();
    fitter->integrate({v, no_image, walk.camera, pose, view, batch});
    line.visibility_ms += seen_ms - begin_ms;
    line.fit_ms += core::own_cpu_ms() - photographed_ms;
    ++line.views;
    if (v + 1 == next_line || v + 1 == options.views) {
      line.print(options, v + 1);
      line = {};
      next_line *= 2;
    }
  }
}

}  // namespace
}  // namespace sheen::bench

int main(int argc, char** argv) {
  sheen::bench::ScaleOptions options;
  CLI::App app("Memory and CPU time of a fit against vertices and views, as CSV");
  app.add_option("--fitter", options.fitter, "sparse, quadtree, sh or mean")->capture_default_str();
  app.add_option("--vertices", options.vertices, "Size of the object")
      ->check(CLI::Range(500, 2'000'000))
      ->capture_default_str();
  app.add_option("--views", options.views, "Views to fit")
      ->check(CLI::Range(2, 100'000))
      ->capture_default_str();
  app.add_option("--threads", options.threads, "Worker threads")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    sheen::bench::run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
