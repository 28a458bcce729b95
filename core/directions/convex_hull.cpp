// SPDX-License-Identifier: MIT
#include "core/directions/convex_hull.h"

#include <cstddef>
#include <cstdio>
#include <memory>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace sheen::core {
namespace {

/// Qhull with its memory.
struct Qhull {
  Qhull() { qh_zero(&qh, nullptr); }
  ~Qhull() {
    qh_freeqhull(&qh, qh_ALL);
    int long_bytes = 0, blocks = 0;
    qh_memfreeshort(&qh, &long_bytes, &blocks);
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;

  qhT qh;
};

/// What Qhull says of points in a plane is nothing that a user should read.
struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

std::optional<std::vector<std::array<std::uint32_t, 3>>> convex_hull(
    std::span<const Eigen::Vector3d> points) {
  constexpr std::size_t least = 4;
  if (points.size() < least) return std::nullopt;
  std::vector<coordT> coordinates;
  for (const Eigen::Vector3d& point : points) {
    coordinates.insert(coordinates.end(), {point.x(), point.y(), point.z()});
  }
  const std::unique_ptr<std::FILE, CloseFile> silence(std::fopen("/dev/null", "w"));
  Qhull hull;
  std::array<char, 16> command{"qhull Qt Pp"};  // triangles, no warnings
  if (qh_new_qhull(&hull.qh, 3, static_cast<int>(points.size()), coordinates.data(), False,
                   command.data(), silence.get(), silence.get()) != 0) {
    return std::nullopt;
  }
  std::vector<std::array<std::uint32_t, 3>> faces;
  for (const facetT* face = hull.qh.facet_list; face != nullptr && face->next != nullptr;
       face = face->next) {
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto* const corner = static_cast<const vertexT*>(face->vertices->e[i].p);
      corners[i] = static_cast<std::uint32_t>(qh_pointid(&hull.qh, corner->point));
    }
    faces.push_back(corners);
  }
  return faces;
}

}  // namespace sheen::core
