// SPDX-License-Identifier: MIT
#include "fitting/unseen/fill_unseen.h"

#include <cassert>
#include <limits>

namespace sheen::fitting {
namespace {

constexpr std::uint32_t kNoRing = std::numeric_limits<std::uint32_t>::max();

Eigen::Vector3f mean_of_observed(const std::vector<std::uint8_t>& observed,
                                 const std::vector<Eigen::Vector3f>& colours) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    if (observed[i] == 0) continue;
    sum += colours[i].cast<double>();
    count += 1;
  }
  if (count == 0) return Eigen::Vector3f::Constant(0.5f);
  return (sum / count).cast<float>();
}

// Mean over the neighbours that were filled before this ring.
Eigen::Vector3f mean_of_filled(const core::VertexNeighbours& neighbours, std::uint32_t patch,
                               const std::vector<std::uint32_t>& ring,
                               const std::vector<Eigen::Vector3f>& colours) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float count = 0.0f;
  for (const std::uint32_t other : neighbours.of(patch)) {
    if (ring[other] >= ring[patch]) continue;
    sum += colours[other];
    count += 1.0f;
  }
  return sum / count;
}

}  // namespace

void fill_unseen(const core::VertexNeighbours& neighbours,
                 const std::vector<std::uint8_t>& observed, std::vector<Eigen::Vector3f>& colours) {
  assert(neighbours.vertex_count() == observed.size() && colours.size() == observed.size());
  // Start from the seen patches.
  const Eigen::Vector3f fallback = mean_of_observed(observed, colours);
  std::vector<std::uint32_t> ring(observed.size(), kNoRing);
  std::vector<std::uint32_t> queue;
  queue.reserve(observed.size());
  for (std::uint32_t patch = 0; patch < observed.size(); ++patch) {
    if (observed[patch] == 0) continue;
    ring[patch] = 0;
    queue.push_back(patch);
  }
  // Walk outwards: a patch leaves the queue after every patch of an earlier ring has its colour.
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const std::uint32_t patch = queue[head];
    if (ring[patch] > 0) colours[patch] = mean_of_filled(neighbours, patch, ring, colours);
    for (const std::uint32_t other : neighbours.of(patch)) {
      if (ring[other] != kNoRing) continue;
      ring[other] = ring[patch] + 1;
      queue.push_back(other);
    }
  }
  // What cannot be reached gets the mean of everything.
  for (std::size_t patch = 0; patch < colours.size(); ++patch) {
    if (ring[patch] == kNoRing) colours[patch] = fallback;
  }
}

}  // namespace sheen::fitting
