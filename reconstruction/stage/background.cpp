// SPDX-License-Identifier: MIT
#include "reconstruction/stage/background.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace sheen::reconstruction {
namespace {

constexpr float kNoise = 0.015F;            // of a pixel's channel
constexpr float kMisplacement_px2 = 0.35F;  // variance of the print's place in the image
constexpr int kWindows = 10;                // across the image
constexpr int kStride = 2;                  // of the pixels that the fit reads
constexpr int kRounds = 4;                  // of reweighting
constexpr float kPixelsOfPrior = 40;        // by which the gain is pulled
constexpr float kOffsetPrior = 3;           // the same for the offset, times that

/// Gain and offset of three channels.
struct Light {
  cv::Vec3f gain{1, 1, 1};
  cv::Vec3f offset{0, 0, 0};
};

/// Light on a grid of nodes over the image, bilinear between them.
class LightGrid {
 public:
  LightGrid(cv::Size image, const ViewGain& gain)
      : spacing_(static_cast<float>(image.width) / kWindows),
        columns_(kWindows + 1),
        rows_(2 + static_cast<int>(static_cast<float>(image.height) / spacing_)),
        nodes_(static_cast<std::size_t>(columns_ * rows_)) {
    for (Light& node : nodes_) node.gain = gain;
  }

  /// The four nodes round a pixel and their weights.
  struct Place {
    std::array<std::size_t, 4> nodes;
    std::array<float, 4> weights;
  };
  [[nodiscard]] Place place(int x, int y) const {
    const float u = static_cast<float>(x) / spacing_;
    const float v = static_cast<float>(y) / spacing_;
    const auto column = static_cast<std::size_t>(u);
    const auto row = static_cast<std::size_t>(v);
    const float fu = u - static_cast<float>(column);
    const float fv = v - static_cast<float>(row);
    const std::size_t first = row * static_cast<std::size_t>(columns_) + column;
    const auto below = static_cast<std::size_t>(columns_);
    return {{first, first + 1, first + below, first + below + 1},
            {(1 - fu) * (1 - fv), fu * (1 - fv), (1 - fu) * fv, fu * fv}};
  }

  [[nodiscard]] Light at(const Place& place) const {
    Light light{{0, 0, 0}, {0, 0, 0}};
    for (std::size_t i = 0; i < 4; ++i) {
      light.gain += place.weights[i] * nodes_[place.nodes[i]].gain;
      light.offset += place.weights[i] * nodes_[place.nodes[i]].offset;
    }
    return light;
  }

  std::vector<Light>& nodes() { return nodes_; }

 private:
  float spacing_;
  int columns_, rows_;
  std::vector<Light> nodes_;
};

/// Weighted sums of a node for one channel: of B B, B, 1, B I, I.
using Sums = std::array<float, 5>;

cv::Vec3f unit_colour(const cv::Vec3b& bgr) {
  return cv::Vec3f(bgr) * (1.0F / 255);
}

/// Weight of a pixel: redescending, so that what is no stage has no say.
float weight_of(const cv::Vec3f& residual, float sigma) {
  const float e = residual.dot(residual) / (3 * sigma * sigma);
  const float w = 1 / (1 + 0.25F * e);
  return w * w * kNoise * kNoise / (sigma * sigma);
}

void fit_light(LightGrid& light, const cv::Mat& image, const Background& flat, const cv::Mat& mask,
               const ViewGain& gain, float trust) {
  std::vector<std::array<Sums, 3>> sums(light.nodes().size());
  for (int round = 0; round < kRounds; ++round) {
    for (auto& node : sums) node = {};
    for (int y = 0; y < image.rows; y += kStride) {
      for (int x = 0; x < image.cols; x += kStride) {
        if (flat.source.at<std::uint8_t>(y, x) != static_cast<std::uint8_t>(TexelSource::seen)) {
          continue;
        }
        if (!mask.empty() && mask.at<std::uint8_t>(y, x) != 0) continue;
        const auto place = light.place(x, y);
        const Light now = light.at(place);
        const auto& B = flat.colour.at<cv::Vec3f>(y, x);
        const cv::Vec3f I = unit_colour(image.at<cv::Vec3b>(y, x));
        const float w = weight_of(I - B.mul(now.gain) - now.offset, flat.sigma.at<float>(y, x));
        for (std::size_t i = 0; i < 4; ++i) {
          const float wi = w * place.weights[i];
          for (int c = 0; c < 3; ++c) {
            Sums& s = sums[place.nodes[i]][static_cast<std::size_t>(c)];
            s[0] += wi * B[c] * B[c];
            s[1] += wi * B[c];
            s[2] += wi;
            s[3] += wi * B[c] * I[c];
            s[4] += wi * I[c];
          }
        }
      }
    }
    for (std::size_t n = 0; n < sums.size(); ++n) {
      for (int c = 0; c < 3; ++c) {
        const Sums& s = sums[n][static_cast<std::size_t>(c)];
        const float prior = trust * kPixelsOfPrior;
        const float a11 = s[0] + prior;
        const float a22 = s[2] + kOffsetPrior * prior;
        const float b1 = s[3] + prior * gain[c];
        const float determinant = a11 * a22 - s[1] * s[1];
        light.nodes()[n].gain[c] = (b1 * a22 - s[4] * s[1]) / determinant;
        light.nodes()[n].offset[c] = (a11 * s[4] - s[1] * b1) / determinant;
      }
    }
  }
}

/// Adds to the spread of every pixel what a print that lies a little elsewhere makes.
void widen_at_edges(Background& background) {
  cv::Mat luma;
  cv::cvtColor(background.colour, luma, cv::COLOR_BGR2GRAY);
  cv::Mat dx;
  cv::Mat dy;
  cv::Scharr(luma, dx, CV_32F, 1, 0, 1.0 / 32);
  cv::Scharr(luma, dy, CV_32F, 0, 1, 1.0 / 32);
  for (int y = 0; y < luma.rows; ++y) {
    auto* sigma = background.sigma.ptr<float>(y);
    const auto* gx = dx.ptr<float>(y);
    const auto* gy = dy.ptr<float>(y);
    for (int x = 0; x < luma.cols; ++x) {
      sigma[x] = std::sqrt(kNoise * kNoise + sigma[x] * sigma[x] +
                           kMisplacement_px2 * (gx[x] * gx[x] + gy[x] * gy[x]));
    }
  }
}

/// The map's texels at the pixels of a view.
Background remapped(const StageMap& map, const ViewSet& views, const View& view) {
  cv::Mat places = plane_points(views, view);
  for (int y = 0; y < places.rows; ++y) {
    auto* row = places.ptr<cv::Vec2f>(y);
    for (int x = 0; x < places.cols; ++x) {
      const Eigen::Vector2f texel = map.grid.texel_of({row[x][0], row[x][1]});
      const bool inside = texel.x() >= 0 && texel.y() >= 0 &&
                          texel.x() <= static_cast<float>(map.grid.size.width - 1) &&
                          texel.y() <= static_cast<float>(map.grid.size.height - 1);
      row[x] = inside ? cv::Vec2f(texel.x(), texel.y()) : cv::Vec2f(-10, -10);
    }
  }
  Background background;
  cv::remap(map.colour, background.colour, places, cv::noArray(), cv::INTER_LINEAR,
            cv::BORDER_CONSTANT);
  cv::remap(map.sigma, background.sigma, places, cv::noArray(), cv::INTER_LINEAR,
            cv::BORDER_CONSTANT);
  cv::remap(map.source, background.source, places, cv::noArray(), cv::INTER_NEAREST,
            cv::BORDER_CONSTANT);
  return background;
}

}  // namespace

Background predict_background(const StageMap& map, const ViewSet& views, const View& view,
                              const ViewGain& gain, const cv::Mat& mask, float trust) {
  Background background = remapped(map, views, view);
  widen_at_edges(background);
  LightGrid light(view.image.size(), gain);
  fit_light(light, view.image, background, mask, gain, trust);
  for (int y = 0; y < view.image.rows; ++y) {
    auto* colours = background.colour.ptr<cv::Vec3f>(y);
    for (int x = 0; x < view.image.cols; ++x) {
      const Light at = light.at(light.place(x, y));
      colours[x] = colours[x].mul(at.gain) + at.offset;
    }
  }
  return background;
}

}  // namespace sheen::reconstruction
