// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sheen::evaluation {

/// What a candidate costs and what it is worth, in any units.
struct CostBenefit {
  double cost = 0;     ///< less is better
  double benefit = 0;  ///< more is better
};

/// 1 where no other point is at least as good in both and better in one. Equal points do not
/// dominate each other; points that are not finite are never on the front and dominate nobody.
std::vector<std::uint8_t> pareto_front(std::span<const CostBenefit> points);

}  // namespace sheen::evaluation
