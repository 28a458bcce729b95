// SPDX-License-Identifier: MIT
#include "fitting/detail/texture_solver.h"

#include "core/concurrency/parallel_for.h"

#include <numeric>

namespace sheen::fitting::detail {
namespace {

/// Pull towards the given texture: as strong as a pixel that sees the texel's middle frontally.
constexpr float kLambda = 1.0f;
/// More bring nothing on views that were not seen.
constexpr int kSteps = 2;

/// Units of the sums in the matrix: a pixel that sees the middle of a texel frontally adds 1.
constexpr float kUnit = 1.0f / (kCosineUnits * kReadingUnits * kReadingUnits);

/// The normal equations of a texture, those of a texel a row.
class System {
 public:
  System(std::span<const TexelSums> texels, std::size_t width, int threads)
      : texels_(texels),
        width_(width),
        height_(texels.size() / width),
        threads_(threads),
        diagonal_(texels.size(), 0.0f) {
    for_rows([&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t others = texels_[i].right + texels_[i - 1].right + texels_[i].below +
                                     texels_[i - width_].below + texels_[i].below_right +
                                     texels_[i - width_ - 1].below_right + texels_[i].below_left +
                                     texels_[i - width_ + 1].below_left;
        // Modulo 2^32 like the sums: the diagonal itself is small enough.
        const std::uint32_t row = texels_[i].weight * kReadingUnits - others;
        diagonal_[i] = static_cast<float>(row) * kUnit;
      }
    });
  }

  /// Calls body(begin, end) for the inner part of every row.
  template <typename Body>
  void for_rows(const Body& body) const {
    core::parallel_for(
        height_ - 2, threads_,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t y = begin + 1; y < end + 1; ++y) {
            body(y * width_ + 1, (y + 1) * width_ - 1);
          }
        },
        16);
  }

  /// Sum over all rows of body(begin, end), in their order.
  template <typename Body>
  double sum_over_rows(const Body& body) const {
    std::vector<double> sums(height_, 0.0);
    for_rows([&](std::size_t begin, std::size_t end) { sums[begin / width_] = body(begin, end); });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
  }

  [[nodiscard]] float product(const std::vector<float>& x, std::size_t i) const {
    const TexelSums& here = texels_[i];
    const TexelSums* const above = &texels_[i - width_];
    const auto f = [](std::uint32_t v) { return static_cast<float>(v); };
    const float others =
        f(here.right) * x[i + 1] + f(texels_[i - 1].right) * x[i - 1] +
        f(here.below) * x[i + width_] + f(above[0].below) * x[i - width_] +
        f(here.below_right) * x[i + width_ + 1] + f(above[-1].below_right) * x[i - width_ - 1] +
        f(here.below_left) * x[i + width_ - 1] + f(above[1].below_left) * x[i - width_ + 1];
    return diagonal_[i] * x[i] + others * kUnit;
  }

  /// Sum of the pixels' colours less what the texture explains of it; 0 where there are no pixels.
  void residual(const std::vector<float>& texture, std::size_t channel,
                std::vector<float>& out) const {
    for_rows([&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const float wanted =
            static_cast<float>(texels_[i].colour[channel]) * (kUnit * kReadingUnits);
        out[i] = texels_[i].weight == 0 ? 0.0f : wanted - product(texture, i);
      }
    });
  }

 private:
  std::span<const TexelSums> texels_;
  std::size_t width_, height_;
  int threads_;
  std::vector<float> diagonal_;
};

/// Takes off a residual (of texels, each weighted with its pixels) its mean around every vertex,
/// interpolated across the triangles.
class SmoothPart {
 public:
  SmoothPart(std::span<const TexelSums> texels, const core::Mesh& mesh,
             const SurfaceTexels& surface)
      : texels_(texels), mesh_(mesh), surface_(surface), weight_(mesh.positions.size(), 0.0f) {
    for_each([&](std::size_t vertex, float share, std::size_t texel) {
      weight_[vertex] += share * weight_of(texel);
    });
  }

  void remove_from(std::vector<float>& residual) const {
    std::vector<float> mean(weight_.size(), 0.0f);
    for_each([&](std::size_t vertex, float share, std::size_t texel) {
      if (weight_[vertex] > 0.0f) mean[vertex] += share * residual[texel] / weight_[vertex];
    });
    for_each([&](std::size_t vertex, float share, std::size_t texel) {
      residual[texel] -= weight_of(texel) * share * mean[vertex];
    });
  }

 private:
  /// Calls visit(vertex, its barycentric weight, texel).
  template <typename Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto& corner = mesh_.triangles[t];
      for (const SurfaceTexel& texel : surface_.of(t)) {
        visit(corner[0], 1.0f - texel.at_second - texel.at_third, texel.texel_idx);
        visit(corner[1], texel.at_second, texel.texel_idx);
        visit(corner[2], texel.at_third, texel.texel_idx);
      }
    }
  }
  [[nodiscard]] float weight_of(std::size_t texel) const {
    return static_cast<float>(texels_[texel].weight) * (kUnit * kReadingUnits);
  }

  std::span<const TexelSums> texels_;
  const core::Mesh& mesh_;
  const SurfaceTexels& surface_;
  std::vector<float> weight_;
};

void solve_channel(const System& system, const SmoothPart& smooth, std::size_t channel,
                   std::vector<float>& texture) {
  std::vector<float> r(texture.size(), 0.0f);
  system.residual(texture, channel, r);
  smooth.remove_from(r);
  std::vector<float> p = r;
  std::vector<float> Ap(texture.size(), 0.0f);
  const auto dot = [&](const std::vector<float>& a, const std::vector<float>& b) {
    return system.sum_over_rows([&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += static_cast<double>(a[i] * b[i]);
      return sum;
    });
  };
  double squared = dot(r, r);
  for (int step = 0; step < kSteps && squared > 0; ++step) {
    system.for_rows([&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Ap[i] = system.product(p, i) + kLambda * p[i];
      }
    });
    const auto alpha = static_cast<float>(squared / dot(p, Ap));
    system.for_rows([&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        texture[i] += alpha * p[i];
        r[i] -= alpha * Ap[i];
      }
    });
    const double next = dot(r, r);
    const auto beta = static_cast<float>(next / squared);
    squared = next;
    system.for_rows([&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) p[i] = r[i] + beta * p[i];
    });
  }
}

}  // namespace

Planes mean_texture(std::span<const TexelSums> texels) {
  Planes planes;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    planes[channel].resize(texels.size());
    for (std::size_t i = 0; i < texels.size(); ++i) {
      planes[channel][i] = texels[i].weight == 0 ? 0.0f
                                                 : static_cast<float>(texels[i].colour[channel]) /
                                                       static_cast<float>(texels[i].weight);
    }
  }
  return planes;
}

void solve_texture(std::span<const TexelSums> texels, std::size_t width, const core::Mesh& mesh,
                   const SurfaceTexels& surface, int threads, Planes& texture) {
  if (width < 3 || texels.size() / width < 3) return;
  const System system(texels, width, threads);
  const SmoothPart smooth(texels, mesh, surface);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    solve_channel(system, smooth, channel, texture[channel]);
  }
}

}  // namespace sheen::fitting::detail
