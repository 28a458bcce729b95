// SPDX-License-Identifier: MIT
// Sending changed patches to OpenGL: all, what one view changed, and within a budget per redraw.
#include "fitting/iwls/center_layout.h"
#include "fitting/iwls/light_field_model.h"
#include "render/context/context.h"
#include "render/gl/functions.h"
#include "render/surface/patch_shader.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <span>
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

// As many of these as a redraw has room for, in bytes.
void view_within_budget(benchmark::State& state) {
  auto patches = runs(8, 4);
  const std::size_t patch_bytes = uploaded().shader->upload(std::span(patches).first(1));
  patches.resize(std::min(patches.size(), static_cast<std::size_t>(state.range(0)) / patch_bytes));
  upload(state, patches);
}

#define SHEEN_UPLOAD(name) BENCHMARK(name)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond)

SHEEN_UPLOAD(everything);
SHEEN_UPLOAD(view_in_runs);
SHEEN_UPLOAD(view_scattered);
SHEEN_UPLOAD(view_within_budget)->Arg(256 << 10)->Arg(1 << 20);

}  // namespace
}  // namespace sheen
