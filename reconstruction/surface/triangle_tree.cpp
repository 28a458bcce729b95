// SPDX-License-Identifier: MIT
#include "reconstruction/surface/triangle_tree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace sheen::reconstruction {
namespace {

constexpr std::uint32_t kLeafTriangles = 4;
constexpr std::size_t kDeepest = 64;

}  // namespace

SurfacePlace closest_on_triangle(const Eigen::Vector3f& p, const Eigen::Vector3f& a,
                                 const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  const auto place = [&](float u, float v, float w) {
    SurfacePlace result;
    result.barycentric = {u, v, w};
    result.point = u * a + v * b + w * c;
    result.distance = (result.point - p).norm();
    return result;
  };
  const Eigen::Vector3f ab = b - a;
  const Eigen::Vector3f ac = c - a;
  const Eigen::Vector3f ap = p - a;
  const float d1 = ab.dot(ap);
  const float d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return place(1, 0, 0);
  const Eigen::Vector3f bp = p - b;
  const float d3 = ab.dot(bp);
  const float d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return place(0, 1, 0);
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const float v = d1 / (d1 - d3);
    return place(1 - v, v, 0);
  }
  const Eigen::Vector3f cp = p - c;
  const float d5 = ab.dot(cp);
  const float d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return place(0, 0, 1);
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const float w = d2 / (d2 - d6);
    return place(1 - w, 0, w);
  }
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return place(0, 1 - w, w);
  }
  const float sum = va + vb + vc;
  if (!(sum > 0)) return place(1, 0, 0);  // a triangle of one point
  return place(va / sum, vb / sum, vc / sum);
}

TriangleTree::TriangleTree(const core::Mesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  std::vector<Eigen::AlignedBox3f> boxes(mesh.triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      boxes[t].extend(mesh.positions[mesh.triangles[t][corner]]);
    }
  }
  if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()), boxes);
}

std::uint32_t TriangleTree::build(std::uint32_t begin, std::uint32_t end,
                                  const std::vector<Eigen::AlignedBox3f>& boxes) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({});
  Eigen::AlignedBox3f box;
  Eigen::AlignedBox3f centres;
  for (std::uint32_t i = begin; i < end; ++i) {
    box.extend(boxes[order_[i]]);
    centres.extend(boxes[order_[i]].center());
  }
  std::uint32_t right = 0;
  if (end - begin > kLeafTriangles) {
    int axis = 0;
    centres.sizes().maxCoeff(&axis);
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                       const float x = boxes[a].center()[axis];
                       const float y = boxes[b].center()[axis];
                       return x < y || (x == y && a < b);
                     });
    build(begin, middle, boxes);
    right = build(middle, end, boxes);
  }
  nodes_[number] = {box, begin, end, right};
  return number;
}

SurfacePlace TriangleTree::closest(const Eigen::Vector3f& point, float within) const {
  SurfacePlace best;
  best.distance = within;
  float bound = within * within;
  bool found = false;
  std::array<std::uint32_t, kDeepest> open{};
  std::size_t count = 0;
  if (!nodes_.empty()) open[count++] = 0;
  while (count > 0) {
    const std::uint32_t number = open[--count];
    const Node& node = nodes_[number];
    if (node.box.squaredExteriorDistance(point) >= bound) continue;
    if (node.right != 0) {
      const std::uint32_t left = number + 1;
      const bool left_first = nodes_[left].box.squaredExteriorDistance(point) <=
                              nodes_[node.right].box.squaredExteriorDistance(point);
      open[count++] = left_first ? node.right : left;
      open[count++] = left_first ? left : node.right;
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const auto& t = mesh_.triangles[order_[i]];
      SurfacePlace place = closest_on_triangle(point, mesh_.positions[t[0]], mesh_.positions[t[1]],
                                               mesh_.positions[t[2]]);
      if (!(place.distance < best.distance)) continue;
      place.triangle_idx = order_[i];
      best = place;
      bound = best.distance * best.distance;
      found = true;
    }
  }
  if (!found) best.distance = std::numeric_limits<float>::infinity();
  return best;
}

void TriangleTree::for_each_in(const Eigen::AlignedBox3f& box,
                               const std::function<void(std::uint32_t triangle_idx)>& visit) const {
  std::array<std::uint32_t, kDeepest> open{};
  std::size_t count = 0;
  if (!nodes_.empty()) open[count++] = 0;
  while (count > 0) {
    const std::uint32_t number = open[--count];
    const Node& node = nodes_[number];
    if (!node.box.intersects(box)) continue;
    if (node.right != 0) {
      open[count++] = node.right;
      open[count++] = number + 1;
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const auto& t = mesh_.triangles[order_[i]];
      Eigen::AlignedBox3f own;
      for (int corner = 0; corner < 3; ++corner) own.extend(mesh_.positions[t[corner]]);
      if (own.intersects(box)) visit(order_[i]);
    }
  }
}

}  // namespace sheen::reconstruction
