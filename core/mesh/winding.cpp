// SPDX-License-Identifier: MIT
#include "core/mesh/winding.h"

#include "core/mesh/parts.h"
#include "core/visibility/ray_caster.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace sheen::core {
namespace {

constexpr double kClearShare = 0.9;   // of what is seen: what a few folds and thin parts cannot be
constexpr std::size_t kFewRays = 20;  // on a part: fewer say nothing about it
constexpr int kGrid = 64;             // rays across the object, either way, in a view

/// A side of a triangle, by position: the smaller index first.
struct Side {
  std::uint64_t edge = 0;
  std::uint32_t triangle = 0;
  bool is_forward = false;  ///< runs from the smaller index to the larger

  bool operator<(const Side& other) const {
    return std::pair(edge, triangle) < std::pair(other.edge, other.triangle);
  }
};

std::vector<Side> sorted_sides(const Mesh& mesh) {
  const std::vector<std::uint32_t> first = first_at_position(mesh);
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint64_t from = first[mesh.triangles[t][corner]];
      const std::uint64_t to = first[mesh.triangles[t][(corner + 1) % 3]];
      sides.push_back({std::min(from, to) << 32U | std::max(from, to),
                       static_cast<std::uint32_t>(t), from < to});
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

/// Calls `visit` with the two sides of every edge of exactly two triangles.
template <typename Visit>
void for_each_inner_edge(const std::vector<Side>& sides, const Visit& visit) {
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end].edge == sides[begin].edge) ++end;
    if (end - begin == 2) visit(sides[begin], sides[begin + 1]);
    begin = end;
  }
}

/// Triangles joined over edges, each with whether it runs as the first of its group does.
class TurnGroups {
 public:
  explicit TurnGroups(std::size_t triangles)
      : parent_(triangles), turned_(triangles, 0), is_one_sided_(triangles, 0) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  /// Root of the group and whether triangle `t` is turned against it.
  std::pair<std::uint32_t, bool> find(std::uint32_t t) {
    std::uint32_t root = t;
    bool turned = false;
    for (; parent_[root] != root; root = parent_[root]) turned ^= turned_[root] != 0;
    // Shorten the way for later.
    bool rest = turned;
    while (parent_[t] != root && parent_[t] != t) {
      const std::uint32_t next = parent_[t];
      const bool own = turned_[t] != 0;
      parent_[t] = root;
      turned_[t] = rest;
      rest ^= own;
      t = next;
    }
    return {root, turned};
  }

  void join(std::uint32_t a, std::uint32_t b, bool contradict) {
    const auto [root_a, turned_a] = find(a);
    const auto [root_b, turned_b] = find(b);
    const bool turned = turned_a ^ turned_b ^ contradict;
    if (root_a == root_b) {
      if (turned) is_one_sided_[root_a] = 1;
      return;
    }
    parent_[root_b] = root_a;
    turned_[root_b] = turned;
    is_one_sided_[root_a] |= is_one_sided_[root_b];
  }

  [[nodiscard]] bool is_one_sided(std::uint32_t root) const { return is_one_sided_[root] != 0; }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint8_t> turned_;  ///< against its parent
  std::vector<std::uint8_t> is_one_sided_;
};

void turn(Eigen::Matrix<std::uint32_t, 3, 1>& triangle) {
  std::swap(triangle[1], triangle[2]);
}

/// Rectangle of pixels around what is in front of the camera; empty where nothing is.
Eigen::AlignedBox2d image_box(const Mesh& mesh, const MeshView& view) {
  constexpr std::size_t most = 4000;
  const std::size_t stride = std::max<std::size_t>(1, mesh.positions.size() / most);
  Eigen::AlignedBox2d box;
  for (std::size_t i = 0; i < mesh.positions.size(); i += stride) {
    const auto pixel =
        view.camera->project(view.camera_from_mesh * mesh.positions[i].cast<double>());
    if (pixel) box.extend(*pixel);
  }
  const Eigen::AlignedBox2d image(
      Eigen::Vector2d::Zero(),
      Eigen::Vector2d(view.camera->width_px() - 1, view.camera->height_px() - 1));
  return box.isEmpty() ? box : box.intersection(image);
}

/// Counts, for every part, the rays that meet it from the front and from behind.
struct Sides {
  std::vector<std::size_t> front, back;
};

Sides count_sides(const Mesh& mesh, const MeshParts& parts, std::span<const MeshView> views) {
  const RayCaster caster(mesh);
  Sides sides{std::vector<std::size_t>(parts.count, 0), std::vector<std::size_t>(parts.count, 0)};
  for (const MeshView& view : views) {
    const Eigen::AlignedBox2d box = image_box(mesh, view);
    if (box.isEmpty()) continue;
    const Eigen::Isometry3d mesh_from_camera = view.camera_from_mesh.inverse();
    const Eigen::Vector3f eye = mesh_from_camera.translation().cast<float>();
    for (int y = 0; y < kGrid; ++y) {
      for (int x = 0; x < kGrid; ++x) {
        const Eigen::Vector2d place((x + 0.5) / kGrid, (y + 0.5) / kGrid);
        const auto ray = view.camera->unproject(box.min() + box.sizes().cwiseProduct(place));
        if (!ray) continue;
        const Eigen::Vector3f direction = (mesh_from_camera.linear() * *ray).cast<float>();
        const auto hit =
            caster.first_hit(eye, direction, 0, std::numeric_limits<float>::infinity());
        if (!hit) continue;
        const std::uint32_t part = parts.of_triangle[hit->triangle_idx];
        ++(hit->front_face ? sides.front : sides.back)[part];
      }
    }
  }
  return sides;
}

/// For every part the share of its normals, weighted by area, that contradict its winding.
std::vector<double> contradicting_shares(const Mesh& mesh, const MeshParts& parts) {
  std::vector<double> against(parts.count, 0), all(parts.count, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3d area = doubled_area(mesh, mesh.triangles[t]);
    for (const std::uint32_t corner : mesh.triangles[t]) {
      all[parts.of_triangle[t]] += area.norm();
      if (area.dot(mesh.normals[corner].cast<double>()) < 0) {
        against[parts.of_triangle[t]] += area.norm();
      }
    }
  }
  for (std::size_t part = 0; part < against.size(); ++part) {
    against[part] = all[part] > 0 ? against[part] / all[part] : 0;
  }
  return against;
}

}  // namespace

std::size_t unify_winding(Mesh& mesh) {
  const std::vector<Side> sides = sorted_sides(mesh);
  bool is_mixed = false;
  for_each_inner_edge(sides, [&is_mixed](const Side& a, const Side& b) {
    is_mixed |= a.is_forward == b.is_forward;
  });
  if (!is_mixed) return 0;

  TurnGroups groups(mesh.triangles.size());
  for_each_inner_edge(sides, [&groups](const Side& a, const Side& b) {
    if (a.triangle != b.triangle) groups.join(a.triangle, b.triangle, a.is_forward == b.is_forward);
  });
  // Of every group the smaller share is turned.
  std::vector<double> area_kept(mesh.triangles.size(), 0), area_turned(mesh.triangles.size(), 0);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [root, is_turned] = groups.find(t);
    (is_turned ? area_turned : area_kept)[root] += doubled_area(mesh, mesh.triangles[t]).norm();
  }
  std::size_t count = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [root, is_turned] = groups.find(t);
    const bool turns_rest = area_turned[root] > area_kept[root];
    if (groups.is_one_sided(root) || is_turned == turns_rest) continue;
    turn(mesh.triangles[t]);
    ++count;
  }
  return count;
}

double normals_against_winding(const Mesh& mesh) {
  if (mesh.normals.size() != mesh.positions.size()) return 0;
  double against = 0, all = 0;
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d area = doubled_area(mesh, triangle);
    for (const std::uint32_t corner : triangle) {
      const double along = area.dot(mesh.normals[corner].cast<double>());
      all += std::abs(along) > 0 ? area.norm() : 0;
      against += along < 0 ? area.norm() : 0;
    }
  }
  return all > 0 ? against / all : 0;
}

SeenSides face_cameras(Mesh& mesh, std::span<const MeshView> views) {
  const MeshParts parts = mesh_parts(mesh);
  const Sides sides = count_sides(mesh, parts, views);
  const std::size_t front = std::reduce(sides.front.begin(), sides.front.end(), std::size_t{0});
  const std::size_t back = std::reduce(sides.back.begin(), sides.back.end(), std::size_t{0});
  SeenSides seen{.rays = front + back};
  if (seen.rays < kFewRays) return seen;
  const auto share = [](std::size_t of, std::size_t other) {
    return static_cast<double>(of) / static_cast<double>(std::max<std::size_t>(1, of + other));
  };
  seen.back_share = share(back, front);

  // Decide for every part; what is seen too little goes with the rest.
  enum class Verdict { unclear, right, inside_out };
  const auto judge = [&share](std::size_t of_front, std::size_t of_back) {
    if (share(of_back, of_front) >= kClearShare) return Verdict::inside_out;
    return share(of_front, of_back) >= kClearShare ? Verdict::right : Verdict::unclear;
  };
  const Verdict rest = judge(front, back);
  std::vector<Verdict> verdicts(parts.count, rest);
  for (std::uint32_t part = 0; part < parts.count; ++part) {
    if (sides.front[part] + sides.back[part] >= kFewRays) {
      verdicts[part] = judge(sides.front[part], sides.back[part]);
    }
  }

  // Turn triangles, and normals that went with the wrong winding or against the right one.
  const std::vector<double> against = contradicting_shares(mesh, parts);
  std::vector<std::uint8_t> turns_normal(mesh.positions.size(), 0);
  std::vector<std::uint8_t> is_turned(parts.count, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t part = parts.of_triangle[t];
    const bool is_inside_out = verdicts[part] == Verdict::inside_out;
    if (is_inside_out) turn(mesh.triangles[t]);
    is_turned[part] = is_inside_out;
    const bool normals_are_wrong =
        is_inside_out ? against[part] < 0.5
                      : verdicts[part] == Verdict::right && against[part] >= kClearShare;
    if (!normals_are_wrong) continue;
    seen.turned_normals |= !is_inside_out;
    for (const std::uint32_t corner : mesh.triangles[t]) turns_normal[corner] = 1;
  }
  for (std::size_t i = 0; i < turns_normal.size(); ++i) {
    if (turns_normal[i] != 0) mesh.normals[i] = -mesh.normals[i];
  }
  seen.turned_parts =
      static_cast<std::size_t>(std::count(is_turned.begin(), is_turned.end(), std::uint8_t{1}));
  return seen;
}

}  // namespace sheen::core
