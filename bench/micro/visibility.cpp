// SPDX-License-Identifier: MIT
// Which vertices the object hides: the raster by every instruction set of this processor, Embree's
// rays, and OpenGL's depth pass on OSMesa. The counter `agreement` is the share of vertices in
// question on which a method says the same as the rays, over all views of the walk. Argument:
// vertices.
#include "bench/micro/walk.h"
#include "core/visibility/raster_visibility.h"
#include "core/visibility/ray_visibility.h"
#include "render/context/context.h"
#include "render/visibility/depth_visibility.h"

#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

namespace sheen::bench {
namespace {

constexpr int kSizes[] = {4'000, 31'000, 150'000, 500'000};

/// A walk with all its views projected.
struct Projected {
  const Walk& walk;
  std::vector<core::VertexView> views;
};

Projected project_all(int vertices) {
  Projected projected{walk_round(vertices), {}};
  const core::SurfacePoints points = core::surface_points(projected.walk.mesh);
  for (const Eigen::Isometry3d& pose : projected.walk.camera_from_object) {
    core::project_vertices(points, projected.walk.camera, pose, {}, 1,
                           projected.views.emplace_back());
  }
  return projected;
}

/// Share of the vertices in question on which both say the same.
double agreement(const Projected& projected, core::Visibility& method, core::Visibility& rays) {
  std::size_t candidates = 0;
  std::size_t alike = 0;
  for (std::size_t v = 0; v < projected.views.size(); ++v) {
    const core::VertexView& before = projected.views[v];
    core::VertexView by_method = before;
    core::VertexView by_rays = before;
    const Eigen::Isometry3d& pose = projected.walk.camera_from_object[v];
    method.reject_occluded(projected.walk.camera, pose, by_method);
    rays.reject_occluded(projected.walk.camera, pose, by_rays);
    for (std::size_t i = 0; i < before.rejection.size(); ++i) {
      if (before.rejection[i] != core::VertexRejection::none) continue;
      ++candidates;
      alike += by_method.rejection[i] == by_rays.rejection[i] ? 1 : 0;
    }
  }
  return static_cast<double>(alike) / static_cast<double>(candidates);
}

/// One view after the other.
void run(benchmark::State& state, const Projected& projected, core::Visibility& method) {
  core::VertexView view = projected.views.front();
  std::size_t v = 0;
  for (auto _ : state) {
    state.PauseTiming();
    view = projected.views[v];
    state.ResumeTiming();
    method.reject_occluded(projected.walk.camera, projected.walk.camera_from_object[v], view);
    benchmark::ClobberMemory();
    v = (v + 1) % projected.views.size();
  }
  const auto rays = core::make_ray_visibility(projected.walk.mesh, 1);
  state.counters["agreement"] = agreement(projected, method, *rays);
}

void by_raster(benchmark::State& state, const core::RasterKernels& kernels) {
  const Projected projected = project_all(static_cast<int>(state.range(0)));
  run(state, projected, *core::make_raster_visibility(projected.walk.mesh, 1, kernels));
}

void by_rays(benchmark::State& state) {
  const Projected projected = project_all(static_cast<int>(state.range(0)));
  run(state, projected, *core::make_ray_visibility(projected.walk.mesh, 1));
}

void by_depth_pass(benchmark::State& state) {
  const Projected projected = project_all(static_cast<int>(state.range(0)));
  const auto context = render::make_osmesa_context();
  run(state, projected, *render::make_depth_visibility(*context, projected.walk.mesh));
}

void register_all() {
  const auto at_all_sizes = [](benchmark::internal::Benchmark* bench) {
    for (const int size : kSizes) bench->Arg(size);
    bench->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
  };
  for (const core::RasterKernels& kernels : core::raster_kernel_sets()) {
    at_all_sizes(benchmark::RegisterBenchmark(
        ("raster/" + std::string(kernels.instruction_set)).c_str(), by_raster, kernels));
  }
  at_all_sizes(benchmark::RegisterBenchmark("rays", by_rays));
  at_all_sizes(benchmark::RegisterBenchmark("depth_pass", by_depth_pass));
}

const bool registered = (register_all(), true);

}  // namespace
}  // namespace sheen::bench
