// SPDX-License-Identifier: MIT
// Sending changed patches to OpenGL: all, what one view changed, and within a budget per redraw.
#include "fitting/iwls/center_layout.h"
#include "fitting/iwls/light_field_model.h"
#include "render/context/context.h"
#include "render/gl/functions.h"
#include "render/surface/budgeted_upload.h"
#include "render/surface/patch_shader.h"

#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

namespace sheen {
namespace {

constexpr std::size_t kPatches = 31000;

// A quadtree's model of 16 centres on the GPU.
struct Uploaded {
  std::unique_ptr<render::Context> context = render::make_context();
  render::gl::Functions gl = render::gl::load_functions(*context);
  fitting::iwls::LightFieldModel model = make_model();
  std::unique_ptr<render::PatchShader> shader = render::make_patch_shader(gl, model);

  static fitting::iwls::LightFieldModel make_model() {
    const auto layout = fitting::iwls::make_center_layout({}, 16);
    const auto radius = static_cast<float>(fitting::iwls::level_radius(layout.side));
    return {{layout.layout, layout.centers, 3, radius}, kPatches};
  }
};

Uploaded& uploaded() {
  static Uploaded the_only;
  return the_only;
}

// Every `stride`-th run of `run` patches.
std::vector<std::uint32_t> runs(std::size_t run, std::size_t stride) {
  std::vector<std::uint32_t> patches;
  for (std::uint32_t i = 0; i < kPatches; ++i) {
    if (i / run % stride == 0) patches.push_back(i);
  }
  return patches;
}

void upload(benchmark::State& state, const std::vector<std::uint32_t>& patches) {
  std::size_t bytes = 0;
  for (auto _ : state) bytes += uploaded().shader->upload(patches);
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes));
}

void everything(benchmark::State& state) {
  upload(state, runs(1, 1));
}
// What a view changes: a quarter of the patches, in runs as meshes number their vertices, or one by
// one.
void view_in_runs(benchmark::State& state) {
  upload(state, runs(8, 4));
}
void view_scattered(benchmark::State& state) {
  upload(state, runs(1, 4));
}

// One redraw of a capture in which every frame changes a quarter of the patches.
void redraw_within_budget(benchmark::State& state) {
  const auto patches = runs(8, 4);
  render::BudgetedUpload queue(*uploaded().shader, kPatches);
  std::size_t bytes = 0;
  for (auto _ : state) {
    queue.add(patches);
    bytes += queue.send(static_cast<std::size_t>(state.range(0)));
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes));
}

#define SHEEN_UPLOAD(name) BENCHMARK(name)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond)

SHEEN_UPLOAD(everything);
SHEEN_UPLOAD(view_in_runs);
SHEEN_UPLOAD(view_scattered);
SHEEN_UPLOAD(redraw_within_budget)->Arg(256 << 10)->Arg(1 << 20)->Arg(16 << 20);

}  // namespace
}  // namespace sheen
