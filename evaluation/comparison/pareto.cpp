// SPDX-License-Identifier: MIT
#include "evaluation/comparison/pareto.h"

#include <algorithm>
#include <cmath>

namespace sheen::evaluation {
namespace {

bool is_finite(const CostBenefit& point) {
  return std::isfinite(point.cost) && std::isfinite(point.benefit);
}

bool dominates(const CostBenefit& a, const CostBenefit& b) {
  return is_finite(a) && a.cost <= b.cost && a.benefit >= b.benefit &&
         (a.cost < b.cost || a.benefit > b.benefit);
}

}  // namespace

std::vector<std::uint8_t> pareto_front(std::span<const CostBenefit> points) {
  std::vector<std::uint8_t> front;
  front.reserve(points.size());
  for (const CostBenefit& point : points) {
    const bool is_dominated = std::any_of(
        points.begin(), points.end(), [&](const auto& other) { return dominates(other, point); });
    front.push_back(is_finite(point) && !is_dominated ? 1 : 0);
  }
  return front;
}

}  // namespace sheen::evaluation
