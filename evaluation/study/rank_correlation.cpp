// SPDX-License-Identifier: MIT
#include "evaluation/study/rank_correlation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace sheen::evaluation {
namespace {

// Ranks from 1; equal values share the mean of theirs.
std::vector<double> ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t k) { return values[i] < values[k]; });
  std::vector<double> rank(values.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    const double shared = 0.5 * static_cast<double>(begin + 1 + end);
    for (std::size_t i = begin; i < end; ++i) rank[order[i]] = shared;
    begin = end;
  }
  return rank;
}

}  // namespace

double spearman(std::span<const double> a, std::span<const double> b) {
  assert(a.size() == b.size());
  const std::vector<double> rank_a = ranks(a);
  const std::vector<double> rank_b = ranks(b);
  const double middle = 0.5 * static_cast<double>(a.size() + 1);
  double covariance = 0;
  double variance_a = 0;
  double variance_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = rank_a[i] - middle;
    const double y = rank_b[i] - middle;
    covariance += x * y;
    variance_a += x * x;
    variance_b += y * y;
  }
  const double scale = std::sqrt(variance_a * variance_b);
  return scale > 0 ? covariance / scale : 0.0;
}

// Mann and Whitney: the positives' sum of ranks less its smallest possible value, over the number
// of pairs.
double ranking_quality(std::span<const double> scores, std::span<const bool> positive) {
  assert(scores.size() == positive.size());
  const std::vector<double> rank = ranks(scores);
  double sum = 0;
  double positives = 0;
  for (std::size_t i = 0; i < rank.size(); ++i) {
    if (!positive[i]) continue;
    sum += rank[i];
    positives += 1;
  }
  const double others = static_cast<double>(rank.size()) - positives;
  if (positives == 0 || others == 0) return 0.5;
  return (sum - 0.5 * positives * (positives + 1)) / (positives * others);
}

}  // namespace sheen::evaluation
