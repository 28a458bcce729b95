// SPDX-License-Identifier: MIT
// Weighted sums of 8-bit basis textures, as the paper on dynamic textures has them in a table: the
// plain loop (compiled without vectors), its two SIMD schemes, and what the program uses.
#include "bench/micro/texture_blend_scalar.h"
#include "render/eigen_texture/blend_kernels.h"
#include "render/eigen_texture/texture_blender.h"

#include <benchmark/benchmark.h>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace sheen {
namespace {

using namespace render::eigen_texture;

fitting::eigen_texture::Channel random_bases(std::size_t bases, std::size_t texels) {
  std::mt19937 random(1);
  fitting::eigen_texture::Channel channel{bases, std::vector<std::int8_t>(bases * texels), {}};
  for (auto& one : channel.texels) one = static_cast<std::int8_t>(random() % 255 - 127);
  return channel;
}

void blend(benchmark::State& state, const BlendKernel& kernel) {
  const auto bases = static_cast<std::size_t>(state.range(0));
  const auto side = static_cast<std::size_t>(state.range(1));
  BlendedChannel channel(random_bases(bases, side * side), side * side, kernel);
  std::vector<float> coefficients(bases, 0.1f);
  for (auto _ : state) {
    coefficients[0] += 0.001f;
    benchmark::DoNotOptimize(channel.blend(coefficients).data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(bases * side * side));
}

[[maybe_unused]] const bool registered = [] {
  std::vector<BlendKernel> kernels = blend_kernels();
  kernels.push_back({"scalar, without vectors", BasisLayout::planes, bench::blend_without_vectors});
  for (const BlendKernel& kernel : kernels) {
    benchmark::RegisterBenchmark(std::string(kernel.name).c_str(),
                                 [kernel](benchmark::State& state) { blend(state, kernel); })
        ->ArgNames({"bases", "side"})
        ->Args({20, 256})
        ->Args({40, 256})
        ->Args({20, 512})
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
}  // namespace sheen
