// SPDX-License-Identifier: MIT
// Projection and back-projection: every instruction set of this processor against the camera model
// called vertex by vertex, and the worker pool against new threads. Argument: vertices.
#include "bench/micro/walk.h"
#include "core/concurrency/parallel_for.h"
#include "core/samples/back_projection.h"
#include "core/samples/sampling_kernels.h"

#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>

#include <string>
#include <thread>

namespace sheen::bench {
namespace {

constexpr int kSizes[] = {4'000, 31'000, 150'000, 500'000};

/// All views of the walk, one after the other.
class Views {
 public:
  explicit Views(const Walk& walk) : walk_(walk) {}
  const Eigen::Isometry3d& next() {
    return walk_.camera_from_object[view_idx_++ % walk_.camera_from_object.size()];
  }

 private:
  const Walk& walk_;
  std::size_t view_idx_ = 0;
};

cv::Mat noisy_image(const core::CameraModel& camera) {
  cv::Mat image(camera.height_px(), camera.width_px(), CV_8UC3);
  cv::RNG random(1);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

void project_one_by_one(benchmark::State& state) {
  const Walk& walk = walk_round(static_cast<int>(state.range(0)));
  Views views(walk);
  std::vector<float> x_px(walk.mesh.positions.size());
  for (auto _ : state) {
    const Eigen::Isometry3d& pose = views.next();
    for (std::size_t i = 0; i < x_px.size(); ++i) {
      const auto pixel = walk.camera.project(pose * walk.mesh.positions[i].cast<double>());
      x_px[i] = pixel ? static_cast<float>(pixel->x()) : -1.0f;
    }
    benchmark::DoNotOptimize(x_px.data());
    benchmark::ClobberMemory();
  }
}

void project(benchmark::State& state) {
  const Walk& walk = walk_round(static_cast<int>(state.range(0)));
  const core::SurfacePoints points = core::surface_points(walk.mesh);
  Views views(walk);
  core::VertexView view;
  for (auto _ : state) {
    core::project_vertices(points, walk.camera, views.next(), {}, 1, view);
    benchmark::ClobberMemory();
  }
}

void project_and_sample(benchmark::State& state) {
  const Walk& walk = walk_round(static_cast<int>(state.range(0)));
  const core::SurfacePoints points = core::surface_points(walk.mesh);
  const cv::Mat image = noisy_image(walk.camera);
  Views views(walk);
  core::VertexView view;
  core::SampleBatch batch;
  for (auto _ : state) {
    core::project_vertices(points, walk.camera, views.next(), {}, 1, view);
    core::back_project(image, view, batch);
    benchmark::ClobberMemory();
  }
  state.counters["samples"] = static_cast<double>(batch.size());
}

/// Reading images alone, by one instruction set.
void read_image(benchmark::State& state, const core::SamplingKernels& kernels) {
  const Walk& walk = walk_round(static_cast<int>(state.range(0)));
  const cv::Mat image = noisy_image(walk.camera);
  core::VertexView view;
  core::SampleBatch batch;
  core::project_vertices(core::surface_points(walk.mesh), walk.camera,
                         walk.camera_from_object.front(), {}, 1, view);
  core::back_project(image, view, batch);
  for (auto _ : state) {
    kernels.read(
        {image.data, image.step[0]},
        {view.x_px.data(), view.y_px.data(), view.u.data(), view.v.data(), batch.patch.data(),
         batch.u.data(), batch.v.data(), batch.r.data(), batch.g.data(), batch.b.data()},
        batch.size());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(batch.size()));
}

constexpr int kThreads = 2;

void split_by_the_pool(benchmark::State& state) {
  std::vector<int> values(1024);
  for (auto _ : state) {
    core::parallel_for(values.size(), kThreads, [&](std::size_t begin, std::size_t) {
      benchmark::DoNotOptimize(values[begin] += 1);
    });
  }
}

void split_by_new_threads(benchmark::State& state) {
  std::vector<int> values(1024);
  for (auto _ : state) {
    const std::jthread other([&] { benchmark::DoNotOptimize(values[512] += 1); });
    benchmark::DoNotOptimize(values[0] += 1);
  }
}

void register_all() {
  const auto at_all_sizes = [](benchmark::internal::Benchmark* bench) {
    for (const int size : kSizes) bench->Arg(size);
    bench->Unit(benchmark::kMillisecond);
  };
  at_all_sizes(benchmark::RegisterBenchmark("project/one_by_one", project_one_by_one));
  at_all_sizes(benchmark::RegisterBenchmark("project", project));
  at_all_sizes(benchmark::RegisterBenchmark("project_and_sample", project_and_sample));
  for (const core::SamplingKernels& kernels : core::sampling_kernel_sets()) {
    at_all_sizes(benchmark::RegisterBenchmark(
        ("read_image/" + std::string(kernels.instruction_set)).c_str(), read_image, kernels));
  }
  const auto in_real_time = [](benchmark::internal::Benchmark* bench) {
    bench->Unit(benchmark::kMicrosecond)->MeasureProcessCPUTime()->UseRealTime();
  };
  in_real_time(benchmark::RegisterBenchmark("split/pool", split_by_the_pool));
  in_real_time(benchmark::RegisterBenchmark("split/threads", split_by_new_threads));
}

const bool registered = (register_all(), true);

}  // namespace
}  // namespace sheen::bench
