// SPDX-License-Identifier: MIT
#pragma once

#include <span>

namespace sheen::evaluation {

/// Spearman's rank correlation, [-1, 1]; equal values share the mean of their ranks. 0 when either
/// side is constant. The two have the same size.
double spearman(std::span<const double> a, std::span<const double> b);

/// Probability that a score ranks a random member of the positives above a random other one (area
/// under the ROC curve), ties count half. .5 when there are no positives or no others.
double ranking_quality(std::span<const double> scores, std::span<const bool> positive);

}  // namespace sheen::evaluation
