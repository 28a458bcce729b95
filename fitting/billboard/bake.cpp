// SPDX-License-Identifier: MIT
#include "fitting/billboard/bake.h"

#include "core/concurrency/parallel_for.h"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace sheen::fitting::billboard {
namespace {

/// Gives pixels without coverage what the nearest one with coverage has, so that readings between
/// pixels and lossy images do not mix the object with its background.
void spread_outwards(FrameImage& frame) {
  cv::Mat coverage;
  cv::extractChannel(frame.shape, coverage, 0);
  const cv::Mat outside = coverage == 0;
  if (cv::countNonZero(outside) == 0) return;
  cv::Mat distance;
  cv::Mat labels;
  cv::distanceTransform(outside, distance, labels, cv::DIST_L2, cv::DIST_MASK_5,
                        cv::DIST_LABEL_PIXEL);
  // Every covered pixel has a label of its own.
  std::vector<cv::Point> of_label(outside.total() + 1);
  for (int y = 0; y < outside.rows; ++y) {
    for (int x = 0; x < outside.cols; ++x) {
      if (outside.at<std::uint8_t>(y, x) != 0) continue;
      of_label[static_cast<std::size_t>(labels.at<int>(y, x))] = {x, y};
    }
  }
  for (int y = 0; y < outside.rows; ++y) {
    for (int x = 0; x < outside.cols; ++x) {
      if (outside.at<std::uint8_t>(y, x) == 0) continue;
      const cv::Point nearest = of_label[static_cast<std::size_t>(labels.at<int>(y, x))];
      frame.colour.at<cv::Vec3b>(y, x) = frame.colour.at<cv::Vec3b>(nearest);
      auto& shape = frame.shape.at<cv::Vec3b>(y, x);
      shape = frame.shape.at<cv::Vec3b>(nearest);
      shape[0] = 0;
    }
  }
}

}  // namespace

FrameBaker::FrameBaker(const core::Mesh& mesh, const std::vector<core::TangentFrame>& frames,
                       const PatchLightField& light_field, int samples)
    : FrameBaker(mesh, std::make_unique<PatchColours>(mesh, frames, light_field), samples) {}

FrameBaker::FrameBaker(const core::Mesh& mesh, std::unique_ptr<FrameColours> colours, int samples)
    : mesh_(mesh),
      colours_(std::move(colours)),
      samples_(samples),
      corners_(mesh.positions.size()) {}

FrameImage FrameBaker::bake(const FrameCamera& camera) {
  side_ = camera.side_px * samples_;
  seen_.assign(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_), {});
  project(camera);
  for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) draw_triangle(i);
  look_from(camera);
  FrameImage frame{box(), {}, {}};
  if (frame.crop.empty()) return frame;
  frame.colour.create(frame.crop.size(), CV_8UC3);
  frame.shape.create(frame.crop.size(), CV_8UC3);
  for (int y = 0; y < frame.crop.height; ++y) {
    for (int x = 0; x < frame.crop.width; ++x) {
      resolve(cv::Point(x, y) + frame.crop.tl(), camera.radius_m, frame.colour.at<cv::Vec3b>(y, x),
              frame.shape.at<cv::Vec3b>(y, x));
    }
  }
  spread_outwards(frame);
  return frame;
}

void FrameBaker::project(const FrameCamera& camera) {
  const auto samples = static_cast<float>(samples_);
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Eigen::Vector3f in_frame = camera.in_frame(mesh_.positions[i]);
    // Middles of the finer pixels have whole numbers, too.
    const Eigen::Array2f fine = samples * (camera.pixel(in_frame).array() + 0.5f) - 0.5f;
    corners_[i] = {fine.x(), fine.y(), in_frame.z(), camera.magnification(in_frame.z())};
  }
}

/// Draws a front where nothing drawn before is nearer. Perspective: with the weights k on the
/// image, those on the surface are proportional to k times the corner's magnification.
void FrameBaker::draw_triangle(std::uint32_t triangle_idx) {
  const auto& vertex = mesh_.triangles[triangle_idx];
  const Corner& a = corners_[vertex[0]];
  const Corner& b = corners_[vertex[1]];
  const Corner& c = corners_[vertex[2]];
  const float area = (c.x - a.x) * (b.y - a.y) - (b.x - a.x) * (c.y - a.y);
  // Written so that a number that is none draws nothing.
  if (!(area > 0.0f)) return;
  const auto first = [](float x) { return std::max(0, static_cast<int>(std::ceil(x))); };
  const auto last = [&](float x) { return std::min(side_ - 1, static_cast<int>(std::floor(x))); };
  const int left = first(std::min({a.x, b.x, c.x}));
  const int right = last(std::max({a.x, b.x, c.x}));
  const int top = first(std::min({a.y, b.y, c.y}));
  const int bottom = last(std::max({a.y, b.y, c.y}));
  const float per_area = 1.0f / area;
  for (int y = top; y <= bottom; ++y) {
    Seen* const row = seen_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(side_);
    for (int x = left; x <= right; ++x) {
      const float dx = static_cast<float>(x) - a.x;
      const float dy = static_cast<float>(y) - a.y;
      const float image_b = (dy * (c.x - a.x) - dx * (c.y - a.y)) * per_area;
      const float image_c = (dx * (b.y - a.y) - dy * (b.x - a.x)) * per_area;
      const float image_a = 1.0f - image_b - image_c;
      if (std::min({image_a, image_b, image_c}) < 0.0f) continue;
      const float at_a = image_a * a.magnification;
      const float at_b = image_b * b.magnification;
      const float at_c = image_c * c.magnification;
      const float per_sum = 1.0f / (at_a + at_b + at_c);
      const float z = (at_a * a.z + at_b * b.z + at_c * c.z) * per_sum;
      Seen& seen = row[x];
      if (z > seen.z) seen = {{triangle_idx, at_b * per_sum, at_c * per_sum}, z};
    }
  }
}

void FrameBaker::look_from(const FrameCamera& camera) {
  needed_.assign(corners_.size(), 0);
  for (const Seen& seen : seen_) {
    if (!seen.object()) continue;
    for (const std::uint32_t vertex_idx : mesh_.triangles[seen.point.triangle_idx]) {
      needed_[vertex_idx] = 1;
    }
  }
  colours_->look_from(camera, needed_);
}

cv::Rect FrameBaker::box() const {
  cv::Point least(side_, side_);
  cv::Point most(-1, -1);
  for (int y = 0; y < side_; ++y) {
    const Seen* const row =
        seen_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(side_);
    for (int x = 0; x < side_; ++x) {
      if (!row[x].object()) continue;
      least = {std::min(least.x, x), std::min(least.y, y)};
      most = {std::max(most.x, x), std::max(most.y, y)};
    }
  }
  if (most.x < 0) return {};
  return {least / samples_, most / samples_ + cv::Point(1, 1)};
}

/// The mean of the points that show the object; the nearest one's depth.
void FrameBaker::resolve(const cv::Point& pixel, float radius_m, cv::Vec3b& colour,
                         cv::Vec3b& shape) const {
  Eigen::Vector3f rgb = Eigen::Vector3f::Zero();
  int covered = 0;
  float nearest = -radius_m;
  bool supported = false;
  for (int y = 0; y < samples_; ++y) {
    const Seen* const row =
        seen_.data() +
        static_cast<std::size_t>(pixel.y * samples_ + y) * static_cast<std::size_t>(side_) +
        pixel.x * samples_;
    for (int x = 0; x < samples_; ++x) {
      if (!row[x].object()) continue;
      const WeightedColour sums = colours_->at(row[x].point, pixel * samples_ + cv::Point(x, y));
      rgb += sums.colour().cwiseMax(0.0f).cwiseMin(1.0f);
      nearest = std::max(nearest, row[x].z);
      supported = supported || sums.weight_sum > 2 * kUnseenWeight;
      ++covered;
    }
  }
  colour = {0, 0, 0};
  shape = {0, 0, 0};
  if (covered == 0) return;
  rgb *= 255.0f / static_cast<float>(covered);
  for (int channel = 0; channel < 3; ++channel) {
    colour[channel] = static_cast<std::uint8_t>(std::lround(rgb[2 - channel]));
  }
  const int points = samples_ * samples_;
  shape[0] = static_cast<std::uint8_t>((255 * covered + points / 2) / points);
  shape[1] = depth_code(nearest, radius_m);
  shape[2] = supported ? 255 : 0;
}

void bake_all(const core::Mesh& mesh, const std::vector<core::TangentFrame>& frames,
              const PatchLightField& patches, int threads, Billboards& billboards) {
  mean::MeanLightField means(patches.patch_count());
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    means.store(i, patches.mean_colour(i), patches.observed()[i] != 0);
  }
  billboards.set_means(means);
  core::parallel_for(
      billboards.element_count(), threads,
      [&](std::size_t begin, std::size_t end) {
        FrameBaker baker(mesh, frames, patches, kFrameSamples);
        for (std::size_t i = begin; i < end; ++i) {
          billboards.set_frame(
              i, encode(baker.bake(billboards.camera(i)), billboards.options().views.quality));
        }
      },
      1);
}

}  // namespace sheen::fitting::billboard
