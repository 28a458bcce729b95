// SPDX-License-Identifier: MIT
// The fit of one view: running sums against the memory floor and against a refit from lists.
#include "core/mesh/neighbours.h"
#include "fitting/huge_pages.h"
#include "fitting/iwls/iwls_fitter.h"
#include "fitting/iwls/moment_rows.h"
#include "fitting/iwls/quad_tree.h"
#include "fitting/iwls/wendland.h"

#include <Eigen/Dense>
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

namespace sheen {
namespace {

using fitting::iwls::Construction;

constexpr std::size_t kWarmViews = 60;

// An object like a ball, seen by a camera that walks round it three times at changing height.
class Walk {
 public:
  explicit Walk(std::size_t patch_count) {
    for (std::size_t i = 0; i < patch_count; ++i) {
      const double z =
          1.0 - 2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(patch_count);
      const double azimuth = std::numbers::pi * (3.0 - std::sqrt(5.0)) * static_cast<double>(i);
      const double r = std::sqrt(1.0 - z * z);
      normals_.emplace_back(r * std::cos(azimuth), r * std::sin(azimuth), z);
    }
    for (std::size_t view = 0; view < kWarmViews; ++view) views_.push_back(batch_of(view));
  }

  [[nodiscard]] const core::SampleBatch& view(std::size_t i) const {
    return views_[i % views_.size()];
  }

 private:
  [[nodiscard]] core::SampleBatch batch_of(std::size_t view) const {
    const double turn = 6.0 * std::numbers::pi * static_cast<double>(view) / kWarmViews;
    const Eigen::Vector3d eye(std::cos(turn), std::sin(turn), 0.9 * std::sin(0.7 * turn));
    const Eigen::Vector3d w = eye.normalized();
    core::SampleBatch batch;
    for (std::size_t i = 0; i < normals_.size(); ++i) {
      const Eigen::Vector3d& n = normals_[i];
      // 29 % of the patches: what one view of a real object gives.
      if (n.dot(w) < 0.42) continue;
      const Eigen::Vector3d t = n.unitOrthogonal();
      batch.patch.push_back(static_cast<std::uint32_t>(i));
      batch.u.push_back(static_cast<float>(w.dot(t)));
      batch.v.push_back(static_cast<float>(w.dot(n.cross(t))));
      batch.r.push_back(static_cast<float>(0.5 + 0.4 * std::sin(3 * w.dot(t))));
      batch.g.push_back(static_cast<float>(0.5 + 0.3 * n.dot(w)));
      batch.b.push_back(0.25f);
    }
    return batch;
  }

  std::vector<Eigen::Vector3d> normals_;
  std::vector<core::SampleBatch> views_;
};

const Walk& walk_of(std::size_t patch_count) {
  static std::map<std::size_t, std::unique_ptr<Walk>> walks;
  auto& walk = walks[patch_count];
  if (!walk) walk = std::make_unique<Walk>(patch_count);
  return *walk;
}

void integrate(benchmark::State& state, Construction construction, bool faithful) {
  const auto patches = static_cast<std::size_t>(state.range(0));
  const Walk& walk = walk_of(patches);
  fitting::iwls::Options options;
  options.construction = construction;
  options.centers = static_cast<int>(state.range(1));
  options.faithful = faithful;
  const core::VertexNeighbours isolated{std::vector<std::uint32_t>(patches + 1, 0), {}};
  const auto fitter = make_iwls_fitter(isolated, options, 1);
  for (std::size_t i = 0; i < kWarmViews; ++i) fitter->integrate(walk.view(i));
  std::size_t view = 0;
  std::size_t samples = 0;
  for (auto _ : state) {
    samples += walk.view(view).size();
    benchmark::DoNotOptimize(fitter->integrate(walk.view(view++)));
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(samples));
}

// Reads, changes and writes, asked for ahead as the fit does, the cache lines that the quadtree
// touches, and does nothing else: the whole moments of the finest quads whose support holds a
// sample, one line of the inner ones, the coefficients.
void memory_floor(benchmark::State& state) {
  using Rows = fitting::iwls::MomentRows<3>;
  constexpr std::size_t line = 16;  // floats
  constexpr std::size_t quad_floats = 4 * Rows::kRows;
  constexpr std::size_t coefficient_floats = 18;  // 36 halves
  const auto patches = static_cast<std::size_t>(state.range(0));
  const Walk& walk = walk_of(patches);
  const fitting::iwls::QuadTree<float> tree(
      fitting::iwls::make_center_layout({}, static_cast<int>(state.range(1))), true);
  const std::size_t stride = tree.quad_count * quad_floats;
  const std::size_t coefficient_stride = tree.finest_count() * coefficient_floats;
  std::vector<float, fitting::HugePageAllocator<float>> moments(patches * stride, 0.0f);
  std::vector<float, fitting::HugePageAllocator<float>> coefficients(patches * coefficient_stride,
                                                                     0.0f);
  // Note beforehand what each view touches.
  const auto covers = [&](std::size_t quad, float u, float v) {
    const auto& q = tree.quads[quad];
    for (std::size_t lane = 0; lane < 4; ++lane) {
      if (std::hypot(u - q.u[lane], v - q.v[lane]) < q.radius) return true;
    }
    return false;
  };
  std::vector<std::vector<std::uint32_t>> touched(kWarmViews);
  for (std::size_t view = 0; view < kWarmViews; ++view) {
    const core::SampleBatch& batch = walk.view(view);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      std::uint32_t quads = 0;
      for (std::size_t quad = 0; quad < tree.quad_count; ++quad) {
        if (covers(quad, batch.u[i], batch.v[i])) quads |= 1U << quad;
      }
      touched[view].push_back(quads);
    }
  }
  // Calls use(first float, count) for everything a sample touches.
  const auto visit = [&](std::size_t patch, std::uint32_t quads, const auto& use) {
    float* const m = moments.data() + patch * stride;
    float* const c = coefficients.data() + patch * coefficient_stride;
    for (std::size_t quad = 0; quad < tree.first_finest; ++quad) {
      if (quads >> quad & 1) use(m + quad * quad_floats, line);
    }
    for (std::size_t quad = tree.first_finest; quad < tree.quad_count; ++quad) {
      if ((quads >> quad & 1) == 0) continue;
      use(m + quad * quad_floats, quad_floats);
      use(c + (quad - tree.first_finest) * coefficient_floats, coefficient_floats);
    }
  };
  const auto fetch = [](const float* from, std::size_t count) {
    for (std::size_t i = 0; i < count; i += line) __builtin_prefetch(from + i, 1);
  };
  const auto change = [](float* from, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) from[i] += 1.0f;
  };
  constexpr std::size_t ahead = 3;
  std::size_t view = 0;
  std::size_t samples = 0;
  for (auto _ : state) {
    const core::SampleBatch& batch = walk.view(view);
    const auto& quads = touched[view++ % kWarmViews];
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (i + ahead < batch.size()) visit(batch.patch[i + ahead], quads[i + ahead], fetch);
      visit(batch.patch[i], quads[i], change);
    }
    benchmark::ClobberMemory();
    samples += batch.size();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(samples));
}

// What the paper describes: every centre keeps a list of samples, and every list that takes a
// sample is fitted from scratch. 12 samples (4 x rank) is where the paper's lists are split; 48 is
// what a centre of the finest level, which is never split, holds after some hundred views.
void naive_refit(benchmark::State& state) {
  constexpr std::size_t patches = 2000;
  const auto list_length = static_cast<std::size_t>(state.range(0));
  const auto layout = fitting::iwls::make_center_layout({}, 16);
  const double radius = fitting::iwls::level_radius(layout.side);
  struct Listed {
    Eigen::Vector3d basis;  // 1, x, y in the centre's coordinates
    double theta;
    Eigen::RowVector3d rgb;
  };
  std::mt19937 random(1);
  const auto unit = [&] { return static_cast<double>(random()) / 4294967296.0; };
  std::vector<std::vector<Listed>> lists(patches * layout.centers.size());
  for (auto& list : lists) {
    for (std::size_t i = 0; i < list_length; ++i) {
      const double angle = 2 * std::numbers::pi * unit();
      const double d = std::sqrt(unit());
      list.push_back({{1, d * std::cos(angle), d * std::sin(angle)},
                      fitting::iwls::wendland(d),
                      {unit(), unit(), unit()}});
    }
  }
  std::vector<Eigen::Matrix3f> model(lists.size());
  const core::SampleBatch& batch = walk_of(31000).view(0);
  std::size_t samples = 0;
  for (auto _ : state) {
    for (std::size_t patch = 0; patch < patches; ++patch) {
      const Eigen::Vector2d x(batch.u[patch], batch.v[patch]);
      for (std::size_t center = 0; center < layout.centers.size(); ++center) {
        const double d = (x - layout.centers[center].cast<double>()).norm() / radius;
        if (d >= 1) continue;
        const std::size_t idx = patch * layout.centers.size() + center;
        Eigen::Matrix3d A = Eigen::Vector3d(0.1, 0.03, 0.03).asDiagonal();
        Eigen::Matrix3d g = Eigen::Matrix3d::Zero();
        for (const Listed& one : lists[idx]) {
          A += one.theta * one.basis * one.basis.transpose();
          g += one.theta * one.basis * one.rgb;
        }
        model[idx] = A.ldlt().solve(g).cast<float>();
      }
    }
    benchmark::DoNotOptimize(model.data());
    samples += patches;
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(samples));
}

constexpr benchmark::TimeUnit kUnit = benchmark::kMillisecond;

BENCHMARK_CAPTURE(integrate, quadtree, Construction::quadtree, false)
    ->ArgsProduct({{4000, 31000, 150000}, {16, 64}})
    ->ArgNames({"patches", "centers"})
    ->Unit(kUnit);
BENCHMARK(memory_floor)
    ->ArgsProduct({{4000, 31000, 150000}, {16, 64}})
    ->ArgNames({"patches", "centers"})
    ->Unit(kUnit);
BENCHMARK_CAPTURE(integrate, batch, Construction::batch, false)
    ->Args({31000, 16})
    ->ArgNames({"patches", "centers"})
    ->Unit(kUnit);
BENCHMARK_CAPTURE(integrate, quadtree_faithful, Construction::quadtree, true)
    ->Args({31000, 16})
    ->ArgNames({"patches", "centers"})
    ->Unit(kUnit);
BENCHMARK_CAPTURE(integrate, adaptive_faithful, Construction::adaptive, true)
    ->Args({31000, 16})
    ->ArgNames({"patches", "centers"})
    ->Unit(kUnit);
BENCHMARK(naive_refit)->Arg(12)->Arg(48)->ArgName("list")->Unit(kUnit);

}  // namespace
}  // namespace sheen
