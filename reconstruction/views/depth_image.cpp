// SPDX-License-Identifier: MIT
#include "reconstruction/views/depth_image.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sheen::reconstruction {
namespace {

using Pixel = Projection::Pixel;

void draw_triangle(const Pixel& a, const Pixel& b, const Pixel& c, cv::Mat& depth) {
  const float area = (b.x_px - a.x_px) * (c.y_px - a.y_px) - (c.x_px - a.x_px) * (b.y_px - a.y_px);
  if (!(area < -1e-12F)) return;  // seen from behind: y runs down
  const int left = std::max(0, static_cast<int>(std::ceil(std::min({a.x_px, b.x_px, c.x_px}))));
  const int top = std::max(0, static_cast<int>(std::ceil(std::min({a.y_px, b.y_px, c.y_px}))));
  const int right =
      std::min(depth.cols - 1, static_cast<int>(std::floor(std::max({a.x_px, b.x_px, c.x_px}))));
  const int bottom =
      std::min(depth.rows - 1, static_cast<int>(std::floor(std::max({a.y_px, b.y_px, c.y_px}))));
  const float per_area = 1 / area;
  const float wa = 1 / a.depth_m;
  const float wb = 1 / b.depth_m;
  const float wc = 1 / c.depth_m;
  for (int y = top; y <= bottom; ++y) {
    auto* row = depth.ptr<float>(y);
    const auto fy = static_cast<float>(y);
    for (int x = left; x <= right; ++x) {
      const auto fx = static_cast<float>(x);
      const float u = ((fx - a.x_px) * (c.y_px - a.y_px) - (c.x_px - a.x_px) * (fy - a.y_px)) *
                      per_area;  // of b
      const float v = ((b.x_px - a.x_px) * (fy - a.y_px) - (fx - a.x_px) * (b.y_px - a.y_px)) *
                      per_area;  // of c
      if (u < 0 || v < 0 || u + v > 1) continue;
      const float d = 1 / (wa + u * (wb - wa) + v * (wc - wa));
      if (row[x] == 0 || d < row[x]) row[x] = d;
    }
  }
}

}  // namespace

DepthImage draw_depth(const core::Mesh& mesh, const Projection& project) {
  std::vector<Pixel> pixels(mesh.positions.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = project(mesh.positions[i]);
  DepthImage image{cv::Mat(project.height_px(), project.width_px(), CV_32FC1, cv::Scalar(0))};
  for (const auto& triangle : mesh.triangles) {
    const Pixel& a = pixels[triangle[0]];
    const Pixel& b = pixels[triangle[1]];
    const Pixel& c = pixels[triangle[2]];
    if (a && b && c) draw_triangle(a, b, c, image.depth);
  }
  return image;
}

}  // namespace sheen::reconstruction
