// SPDX-License-Identifier: MIT
#include "evaluation/study/view_sets.h"

#include "core/geometry/tangent_frame.h"
#include "evaluation/study/handheld_path.h"
#include "evaluation/study/random.h"

#include <cmath>

namespace sheen::evaluation {
namespace {

using Eigen::Vector3f;

// Streams of random numbers that must not meet.
enum ViewStream : std::uint64_t { kScattered = 1, kTest = 2, kArcs = 3, kClusters = 4 };

std::vector<View> scattered_views(std::size_t count, std::uint64_t seed, bool with_gap) {
  std::vector<View> views;
  for (std::uint64_t key = 0; views.size() < count; ++key) {
    const Vector3f direction = Random(hash_of({seed, kScattered, key})).on_sphere(kMinCosine);
    if (with_gap && in_gap(direction)) continue;
    views.push_back({direction, key});
  }
  return views;
}

std::vector<View> cluster_views(std::size_t count, std::uint64_t seed) {
  constexpr std::size_t cluster_count = 4;
  constexpr float radius = 0.105f;  // 6 degrees
  std::vector<core::TangentFrame> clusters;
  for (std::uint64_t i = 0; i < cluster_count; ++i) {
    clusters.push_back(
        core::tangent_frame(Random(hash_of({seed, kClusters, i})).on_sphere(kMinCosine + radius)));
  }
  std::vector<View> views;
  for (std::uint64_t key = 0; key < count; ++key) {
    const Vector3f local =
        Random(hash_of({seed, kClusters, cluster_count + key})).on_sphere(std::cos(radius), 1.0f);
    const core::TangentFrame& at = clusters[key % cluster_count];
    views.push_back({at.in_object(local), key});
  }
  return views;
}

// The part of a handheld path that this point sees, thinned evenly over time.
std::vector<View> arc_views(std::size_t arcs, std::size_t count, std::uint64_t seed) {
  constexpr std::size_t steps_per_arc = 2048;
  std::vector<View> seen;
  for (std::uint64_t arc = 0; arc < arcs; ++arc) {
    const HandheldArc path(hash_of({seed, kArcs, arc}));
    for (std::size_t step = 0; step < steps_per_arc; ++step) {
      const Vector3f direction =
          path.at(static_cast<float>(step) / static_cast<float>(steps_per_arc));
      if (direction.z() > kMinCosine) seen.push_back({direction, arc * steps_per_arc + step});
    }
  }
  std::vector<View> views;
  for (std::size_t i = 0; i < count; ++i) views.push_back(seen[i * seen.size() / count]);
  return views;
}

}  // namespace

std::string_view name_of(ViewSet views) {
  switch (views) {
    case ViewSet::uni:
      return "uni";
    case ViewSet::arc:
      return "arc";
    case ViewSet::one_arc:
      return "one-arc";
    case ViewSet::gap:
      return "gap";
    case ViewSet::clusters:
      break;
  }
  return "clusters";
}

bool in_gap(const Vector3f& direction) {
  return std::abs(std::atan2(direction.y(), direction.x())) < kGapHalfWidth;
}

std::vector<View> make_views(ViewSet views, std::size_t count, std::uint64_t seed) {
  switch (views) {
    case ViewSet::uni:
      return scattered_views(count, seed, false);
    case ViewSet::gap:
      return scattered_views(count, seed, true);
    case ViewSet::arc:
      return arc_views(3, count, seed);
    case ViewSet::one_arc:
      return arc_views(1, count, seed);
    case ViewSet::clusters:
      break;
  }
  return cluster_views(count, seed);
}

std::vector<Vector3f> test_directions(std::size_t count, std::uint64_t seed) {
  std::vector<Vector3f> directions;
  for (std::uint64_t i = 0; i < count; ++i) {
    directions.push_back(Random(hash_of({seed, kTest, i})).on_sphere(kMinCosine));
  }
  return directions;
}

}  // namespace sheen::evaluation
