// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/iwls/fit_rule.h"
#include "fitting/iwls/lanes.h"
#include "fitting/iwls/moment_rows.h"
#include "fitting/iwls/quad_tree.h"

#include <cstddef>

namespace sheen::fitting::iwls::SHEEN_LANES {

/// A quad's samples as a fit needs them (eq. 2): weight, means and centred moments, updated by
/// West's recurrence. Centred, single precision is enough for any number of samples in any spot;
/// running sums of products would lose the spread of a camera that is held still.
template <typename Real, std::size_t kTerms>
struct QuadMoments {
  using L = Lanes<Real>;
  using Rows = MomentRows<kTerms>;
  static constexpr std::size_t kFeatures = Rows::kFeatures;
  using Matrix = L[kFeatures > 0 ? kFeatures : 1][kFeatures > 0 ? kFeatures : 1];

  Real* rows;

  SHEEN_INLINE L row(std::size_t i) const { return load(rows + kLanes * i); }
  SHEEN_INLINE void set_row(std::size_t i, L value) const { save(rows + kLanes * i, value); }

  /// The basis (eq. 6) without its constant.
  static SHEEN_INLINE void features(L x, L y, L* phi) {
    if constexpr (kTerms >= 3) {
      phi[0] = x;
      phi[1] = y;
    }
    if constexpr (kTerms >= 6) {
      phi[2] = x * x;
      phi[3] = x * y;
      phi[4] = y * y;
    }
  }

  /// Adds a sample with weight `theta`, 0 in lanes that do not hold it. `kWhole` false: only weight
  /// and mean colour.
  template <bool kWhole>
  SHEEN_INLINE void add(L x, L y, L theta, const L* rgb) const {
    const L weight = row(Rows::kWeight) + theta;
    const L gain = weight > 0 ? theta / weight : L{};
    set_row(Rows::kWeight, weight);
    L d_rgb[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const L mean = row(Rows::kColour + i);
      d_rgb[i] = rgb[i] - mean;
      set_row(Rows::kColour + i, mean + gain * d_rgb[i]);
    }
    if constexpr (kWhole && kTerms > 1) {
      L d_phi[kFeatures];
      features(x, y, d_phi);
      const L rest = theta * (1 - gain);
      std::size_t second = Rows::kSecond;
      for (std::size_t a = 0; a < kFeatures; ++a) {
        const L mean = row(Rows::kMean + a);
        d_phi[a] -= mean;
        set_row(Rows::kMean + a, mean + gain * d_phi[a]);
        const L scaled = rest * d_phi[a];
        for (std::size_t b = 0; b <= a; ++b, ++second) {
          set_row(second, row(second) + scaled * d_phi[b]);
        }
        for (std::size_t i = 0; i < 3; ++i) {
          const std::size_t mixed = Rows::kMixed + 3 * a + i;
          set_row(mixed, row(mixed) + scaled * d_rgb[i]);
        }
      }
    }
  }

  SHEEN_INLINE void count(LaneMask<Real> covered) const {
    const L one = all_lanes(Real{1});
    set_row(Rows::kCount, row(Rows::kCount) + (covered ? one : L{}));
  }

  /// Weighted mean colour that leans on `prior` as if that were `pull` samples: what a split node
  /// tells its children.
  SHEEN_INLINE void leaning_mean(Real pull, const L* prior, L* mean) const {
    const L weight = row(Rows::kWeight);
    const L inverse = 1 / (weight + pull);
    for (std::size_t i = 0; i < 3; ++i) {
      mean[i] = (weight * row(Rows::kColour + i) + pull * prior[i]) * inverse;
    }
  }

  /// The polynomials of all lanes (eqs. 2 and 8), [term][r, g, b], in each node's own coordinates.
  /// `prior` is the value a lane takes without samples. Finite for finite moments.
  SHEEN_INLINE void solve(const FitRule& rule, const L* prior, L* polynomial) const {
    const L weight = row(Rows::kWeight);
    const Real pull = rule.faithful ? Real{0} : static_cast<Real>(rule.ridge.value);
    const L known = weight / (weight + pull);
    L deviation[3];
    for (std::size_t i = 0; i < 3; ++i) deviation[i] = row(Rows::kColour + i) - prior[i];
    if constexpr (kTerms > 1) solve_slopes(rule, weight, known * pull, deviation, polynomial + 3);
    // Close with the constant.
    for (std::size_t i = 0; i < 3; ++i) {
      L rest = deviation[i];
      for (std::size_t a = 0; a < kFeatures; ++a) {
        rest -= polynomial[3 + 3 * a + i] * row(Rows::kMean + a);
      }
      const L value = prior[i] + known * rest;
      polynomial[i] = weight > smallest_weight() ? value : prior[i];
    }
  }

 private:
  // A sample a hair inside the radius has a weight that all but underflows.
  static constexpr Real smallest_weight() {
    return static_cast<Real>(sizeof(Real) == 4 ? 1e-30 : 1e-100);
  }

  // With the constant eliminated: (C + lean m m^T + p1) c = X + lean m (mean colour - prior)^T,
  // every term of the left side positive, so that nothing cancels.
  SHEEN_INLINE void solve_slopes(const FitRule& rule, L weight, L lean, const L* deviation,
                                 L* slopes) const {
    Matrix A;
    const L penalty = rule.faithful ? L{}
                                    : static_cast<Real>(rule.ridge.relative) * weight +
                                          static_cast<Real>(rule.ridge.absolute);
    L limit[kFeatures];
    std::size_t second = Rows::kSecond;
    for (std::size_t a = 0; a < kFeatures; ++a) {
      const L mean = row(Rows::kMean + a);
      for (std::size_t b = 0; b <= a; ++b, ++second) {
        A[a][b] = row(second) + lean * mean * row(Rows::kMean + b);
      }
      limit[a] = static_cast<Real>(kSmallestPivot) * (A[a][a] + weight * mean * mean);
      A[a][a] += penalty;
      for (std::size_t i = 0; i < 3; ++i) {
        slopes[3 * a + i] = row(Rows::kMixed + 3 * a + i) + lean * mean * deviation[i];
      }
    }
    if (rule.choose_order) drop_terms(A, slopes);
    const LaneMask<Real> regular = factor_and_substitute(A, limit, slopes);
    if (!rule.faithful) return;
    for (std::size_t i = 0; i < 3 * kFeatures; ++i) {
      slopes[i] = (regular & (weight > smallest_weight())) ? slopes[i] : L{};
    }
  }

  // Uses only as many terms as the samples carry: the others become equations of their own, 1 c =
  // 0.
  SHEEN_INLINE void drop_terms(Matrix& A, L* slopes) const {
    const L count = row(Rows::kCount);
    for (std::size_t a = 0; a < kFeatures; ++a) {
      const Real needed = static_cast<Real>(kSamplesPerTerm * (a < 2 ? 3 : 6));
      const LaneMask<Real> keep = count >= needed;
      for (std::size_t b = 0; b < a; ++b) A[a][b] = keep ? A[a][b] : L{};
      A[a][a] = keep ? A[a][a] : all_lanes(Real{1});
      for (std::size_t i = 0; i < 3; ++i) slopes[3 * a + i] = keep ? slopes[3 * a + i] : L{};
    }
  }

  // L D L^T without square roots and pivoting, three right-hand sides at once, in place. Returns
  // where all pivots are above their limit.
  static SHEEN_INLINE LaneMask<Real> factor_and_substitute(Matrix& A, const L* limit, L* slopes) {
    L inverse_d[kFeatures];
    LaneMask<Real> regular = ~LaneMask<Real>{};
    for (std::size_t row_idx = 0; row_idx < kFeatures; ++row_idx) {
      for (std::size_t col = 0; col < row_idx; ++col) {
        for (std::size_t k = 0; k < col; ++k) {
          A[row_idx][col] -= A[row_idx][k] * A[col][k] * inverse_d[k];
        }
      }
      L pivot = A[row_idx][row_idx];
      for (std::size_t k = 0; k < row_idx; ++k) {
        pivot -= A[row_idx][k] * A[row_idx][k] * inverse_d[k];
      }
      regular &= pivot > limit[row_idx];
      inverse_d[row_idx] = 1 / pivot;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t a = 0; a < kFeatures; ++a) {
        L sum = slopes[3 * a + i];
        for (std::size_t k = 0; k < a; ++k) sum -= A[a][k] * slopes[3 * k + i];
        slopes[3 * a + i] = sum * inverse_d[a];
      }
      for (std::size_t a = kFeatures; a-- > 0;) {
        for (std::size_t k = a + 1; k < kFeatures; ++k) {
          slopes[3 * a + i] -= A[k][a] * inverse_d[a] * slopes[3 * k + i];
        }
      }
    }
    return regular;
  }
};

}  // namespace sheen::fitting::iwls::SHEEN_LANES
