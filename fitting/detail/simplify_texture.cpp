// SPDX-License-Identifier: MIT
#include "fitting/detail/simplify_texture.h"

#include "core/concurrency/parallel_for.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <opencv2/core/types.hpp>

#include <algorithm>
#include <array>
#include <vector>

namespace sheen::fitting::detail {
namespace {

constexpr int kLargestTile = 64;
constexpr int kSmallestTile = 4;
constexpr double kPerNumber = 2;  // Akaike
/// Texels that nobody observed follow the others, if only so much that a tile is never without any.
constexpr float kUnobservedWeight = 1e-3f;

/// Values of a channel at a tile's corners, or only the first: one colour.
using Corners = Eigen::Vector4d;

/// Weights of the corners at the places of a tile's rows or columns: 1 - x and x.
double along(int i, int size) {
  return size > 1 ? static_cast<double>(i) / (size - 1) : 0.0;
}
Eigen::Vector4d corner_weights(int x, int y, const cv::Rect& tile) {
  const double right = along(x - tile.x, tile.width);
  const double below = along(y - tile.y, tile.height);
  return {(1 - right) * (1 - below), right * (1 - below), (1 - right) * below, right * below};
}

/// A tile's simpler form.
struct Fit {
  std::array<Corners, 3> corners;
  double cost = 0;         ///< sum of n r^2
  std::size_t texels = 0;  ///< that readings touch
};

class Simplifier {
 public:
  Simplifier(const core::Atlas& atlas, std::span<const float> weight, float noise, Planes& texture)
      : width_(static_cast<std::size_t>(atlas.width)),
        weight_(weight),
        per_number_(kPerNumber * static_cast<double>(noise) * static_cast<double>(noise)),
        texture_(texture) {}

  TexelCount simplify_chart(const core::Atlas::Rectangle& chart) {
    const cv::Rect all(chart.origin.x(), chart.origin.y(), chart.size.x(), chart.size.y());
    const Fit one_colour = fit<1>(all);
    TexelCount count{0, one_colour.texels};
    if (pays(one_colour, 1)) {
      draw<1>(all, one_colour);
      count.stored = std::min<std::size_t>(1, one_colour.texels);
      return count;
    }
    for (int y = all.y; y < all.br().y; y += kLargestTile) {
      for (int x = all.x; x < all.br().x; x += kLargestTile) {
        count.stored += simplify_tile(cv::Rect(x, y, kLargestTile, kLargestTile) & all);
      }
    }
    return count;
  }

 private:
  /// Returns the colours that are stored.
  std::size_t simplify_tile(const cv::Rect& tile) {
    const Fit linear = fit<4>(tile);
    if (linear.texels == 0) return 0;
    if (pays(linear, 4)) {
      draw<4>(tile, linear);
      return 4;
    }
    if (std::max(tile.width, tile.height) <= kSmallestTile) return linear.texels;
    const int left = (tile.width + 1) / 2;
    const int upper = (tile.height + 1) / 2;
    std::size_t stored = 0;
    for (const cv::Rect& part :
         {cv::Rect(tile.x, tile.y, left, upper),
          cv::Rect(tile.x + left, tile.y, tile.width - left, upper),
          cv::Rect(tile.x, tile.y + upper, left, tile.height - upper),
          cv::Rect(tile.x + left, tile.y + upper, tile.width - left, tile.height - upper)}) {
      if (!part.empty()) stored += simplify_tile(part);
    }
    return stored;
  }

  /// Whether a form of so many colours is worth what it saves.
  [[nodiscard]] bool pays(const Fit& fit, std::size_t colours) const {
    if (fit.texels <= colours) return fit.texels == 0;
    return fit.cost <= per_number_ * 3.0 * static_cast<double>(fit.texels - colours);
  }

  /// Calls visit(texel, its weight, basis) for the texels that readings touch.
  template <int kColours, typename Visit>
  void for_each(const cv::Rect& tile, const Visit& visit) const {
    for (int y = tile.y; y < tile.br().y; ++y) {
      for (int x = tile.x; x < tile.br().x; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x);
        if (weight_[i] < 0.0f) continue;
        const Eigen::Matrix<double, kColours, 1> basis =
            kColours == 1
                ? Eigen::Matrix<double, kColours, 1>::Ones().eval()
                : Eigen::Matrix<double, kColours, 1>(corner_weights(x, y, tile).head<kColours>());
        visit(i, static_cast<double>(std::max(weight_[i], kUnobservedWeight)), basis);
      }
    }
  }

  /// Weighted least squares.
  template <int kColours>
  [[nodiscard]] Fit fit(const cv::Rect& tile) const {
    using Basis = Eigen::Matrix<double, kColours, 1>;
    Eigen::Matrix<double, kColours, kColours> matrix =
        Eigen::Matrix<double, kColours, kColours>::Zero();
    Eigen::Matrix<double, kColours, 3> wanted = Eigen::Matrix<double, kColours, 3>::Zero();
    Fit fit;
    for_each<kColours>(tile, [&](std::size_t i, double weight, const Basis& basis) {
      matrix += weight * basis * basis.transpose();
      wanted += weight * basis * colour(i);
      ++fit.texels;
    });
    if (fit.texels == 0) return fit;
    // A little of the matrix' own size, where texels lie in one row or column.
    matrix.diagonal().array() += 1e-9 * matrix.trace();
    const Eigen::Matrix<double, kColours, 3> solution = matrix.ldlt().solve(wanted);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      fit.corners[channel].setZero();
      fit.corners[channel].template head<kColours>() =
          solution.col(static_cast<Eigen::Index>(channel));
    }
    for_each<kColours>(tile, [&](std::size_t i, double weight, const Basis& basis) {
      fit.cost += weight * (colour(i) - basis.transpose() * solution).squaredNorm();
    });
    return fit;
  }

  template <int kColours>
  void draw(const cv::Rect& tile, const Fit& fit) {
    using Basis = Eigen::Matrix<double, kColours, 1>;
    for_each<kColours>(tile, [&](std::size_t i, double /*weight*/, const Basis& basis) {
      for (std::size_t channel = 0; channel < 3; ++channel) {
        texture_[channel][i] =
            static_cast<float>(basis.dot(fit.corners[channel].template head<kColours>()));
      }
    });
  }

  [[nodiscard]] Eigen::RowVector3d colour(std::size_t i) const {
    return Eigen::RowVector3f(texture_[0][i], texture_[1][i], texture_[2][i]).cast<double>();
  }

  std::size_t width_;
  std::span<const float> weight_;
  double per_number_;
  Planes& texture_;
};

}  // namespace

TexelCount simplify_texture(const core::Atlas& atlas, std::span<const float> weight, float noise,
                            int threads, Planes& texture) {
  // Charts share no texel.
  Simplifier simplifier(atlas, weight, noise, texture);
  std::vector<TexelCount> counts(atlas.charts.size());
  core::parallel_for(
      counts.size(), threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
          counts[c] = simplifier.simplify_chart(atlas.charts[c]);
        }
      },
      1);
  TexelCount sum;
  for (const TexelCount& count : counts) {
    sum.stored += count.stored;
    sum.offered += count.offered;
  }
  return sum;
}

}  // namespace sheen::fitting::detail
