// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/iwls/lanes.h"
#include "fitting/iwls/quad_evaluate.h"
#include "fitting/iwls/quad_kernels.h"
#include "fitting/iwls/quad_moments.h"
#include "fitting/iwls/wendland_lanes.h"

#include <cstddef>
#include <cstdint>

namespace sheen::fitting::iwls::SHEEN_LANES {

/// The quadtree and the batch construction on one patch (docs/algorithm.md, section 5): sums run
/// at all nodes of all levels, a node is split when it and all its ancestors hold more samples than
/// the limit. A split node is only asked for its weight and mean, so once all four of a quad are
/// split nothing else of them is kept up to date - unless the fit is faithful, where an empty leaf
/// takes its parent's polynomial.
template <typename Real, std::size_t kTerms>
class QuadPatchFit {
 public:
  // refit() fills refit_all_. NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init)
  SHEEN_INLINE QuadPatchFit(const QuadFit<Real>& fit, const QuadPatch<Real>& patch)
      : fit_(fit), patch_(patch) {}

  SHEEN_INLINE void gather(const QuadSample& sample) {
    const L rgb[3] = {all_lanes(static_cast<Real>(sample.rgb[0])),
                      all_lanes(static_cast<Real>(sample.rgb[1])),
                      all_lanes(static_cast<Real>(sample.rgb[2]))};
    const auto u = static_cast<Real>(sample.u);
    const auto v = static_cast<Real>(sample.v);
    for (std::size_t quad = 0; quad < fit_.tree.quad_count; ++quad) add(quad, u, v, rgb);
  }

  /// Fits the leaves that hold the last sample, or all of them; `prior` is the patch's mean.
  SHEEN_INLINE FitOutcome refit(const double* prior, bool all) {
    // The root speaks always; without inner nodes all centres do.
    const std::size_t speaking = fit_.tree.first_finest == 0 ? fit_.tree.quad_count : 1;
    for (std::size_t quad = 0; quad < speaking; ++quad) {
      speaks_[quad] = true;
      refit_all_[quad] = all;
      for (std::size_t i = 0; i < 3; ++i) prior_[quad][i] = static_cast<Real>(prior[i]);
    }
    std::size_t quad = 0;
    for (; quad < fit_.tree.first_finest; ++quad) {
      if (speaks_[quad]) visit_inner(quad);
    }
    for (; quad < fit_.tree.quad_count; ++quad) {
      if (speaks_[quad]) visit_finest(quad);
    }
    return outcome_;
  }

  SHEEN_INLINE void prefetch(Real u, Real v) const {
    for (std::size_t quad = 0; quad < fit_.tree.quad_count; ++quad) {
      const bool covered = bits_of(place_of(fit_.tree.quads[quad], u, v).covered) != 0;
      const bool finest = quad >= fit_.tree.first_finest;
      if (covered) {
        fetch(moments(quad).rows, kept_whole(quad) ? kQuadReals * sizeof(Real) : kCacheLine);
      }
      // Lanes without samples follow the prior, wherever the sample is.
      if (finest && (covered || seen(quad) != kAllLanes)) {
        fetch(coefficients(quad), kQuadHalves * sizeof(std::uint16_t));
      }
    }
  }

 private:
  using L = Lanes<Real>;
  using Rows = MomentRows<kTerms>;
  static constexpr std::size_t kQuadReals = kLanes * Rows::kRows;
  static constexpr std::size_t kQuadHalves = kLanes * 3 * kTerms;
  static constexpr std::size_t kMaxQuads = QuadTree<Real>::kMaxQuads;
  static constexpr std::size_t kCacheLine = 64;

  static SHEEN_INLINE void fetch(const void* from, std::size_t bytes) {
    const auto* const first = static_cast<const char*>(from);
    for (std::size_t at = 0; at < bytes; at += kCacheLine) __builtin_prefetch(first + at, 1);
  }

  struct Place {
    L x, y, distance2;
    LaneMask<Real> covered;
  };

  static SHEEN_INLINE Place place_of(const Quad<Real>& quad, Real u, Real v) {
    const L x = (u - load(quad.u)) * quad.inverse_radius;
    const L y = (v - load(quad.v)) * quad.inverse_radius;
    const L distance2 = x * x + y * y;
    return {x, y, distance2, distance2 < 1};
  }

  [[nodiscard]] SHEEN_INLINE QuadMoments<Real, kTerms> moments(std::size_t quad) const {
    return {patch_.moments + quad * kQuadReals};
  }
  [[nodiscard]] SHEEN_INLINE std::uint16_t* coefficients(std::size_t finest_quad) const {
    return patch_.coefficients + (finest_quad - fit_.tree.first_finest) * kQuadHalves;
  }
  [[nodiscard]] SHEEN_INLINE LaneBits seen(std::size_t quad) const {
    return patch_.flags[quad] & kAllLanes;
  }
  [[nodiscard]] SHEEN_INLINE LaneBits split(std::size_t quad) const {
    return patch_.flags[quad] >> 4;
  }
  // Whether all moments of the quad are kept up to date, or weight and mean only.
  [[nodiscard]] SHEEN_INLINE bool kept_whole(std::size_t quad) const {
    return quad >= fit_.tree.first_finest || fit_.rule.faithful || split(quad) != kAllLanes;
  }
  static SHEEN_INLINE std::size_t child(std::size_t quad, std::size_t lane) {
    return quad == 0 ? 1 : 4 * (quad - 1) + lane + 2;
  }

  SHEEN_INLINE void add(std::size_t quad, Real u, Real v, const L* rgb) {
    const Place place = place_of(fit_.tree.quads[quad], u, v);
    const LaneBits covered = bits_of(place.covered);
    covering_[quad] = covered;
    just_split_[quad] = 0;
    if (covered == 0) return;
    const L theta = weights<Real>(place.distance2, place.covered);
    if (!kept_whole(quad)) {
      moments(quad).template add<false>(place.x, place.y, theta, rgb);
      return;
    }
    moments(quad).template add<true>(place.x, place.y, theta, rgb);
    moments(quad).count(place.covered);
    const LaneBits full = bits_of(moments(quad).row(Rows::kCount) > fit_.refine_above);
    just_split_[quad] = full & ~split(quad);
    patch_.flags[quad] = static_cast<std::uint8_t>(patch_.flags[quad] | covered | full << 4);
  }

  // Lets split nodes hand over to their children and fits the others.
  SHEEN_INLINE void visit_inner(std::size_t quad) {
    // The root has no siblings.
    const LaneBits nodes = quad == 0 ? 1U : kAllLanes;
    const LaneBits splits = split(quad) & nodes;
    const LaneBits concerned = refit_all_[quad] ? kAllLanes : covering_[quad] | ~seen(quad);
    const LaneBits leaves = nodes & ~splits & concerned;
    if (splits != 0) hand_over(quad, splits);
    if (leaves != 0) fit_inner_leaves(quad, leaves);
  }

  void fit_inner_leaves(std::size_t quad, LaneBits leaves) {
    L prior[3], polynomial[3 * kTerms];
    spread(prior_[quad], prior);
    const LaneBits fitted = leaves & seen(quad);
    if (fitted != 0) moments(quad).solve(fit_.rule, prior, polynomial);
    outcome_.fits += static_cast<std::size_t>(__builtin_popcount(fitted));
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if ((leaves >> lane & 1) == 0) continue;
      if ((fitted >> lane & 1) != 0) {
        copy_down(quad, lane, polynomial, quad, lane);
      } else if (inherits(quad)) {
        copy_from_parent(quad, lane);
      } else {
        const Below below = centers_below(quad, lane);
        for (std::size_t i = 0; i < below.count; ++i) {
          store_prior(below.first + i, prior, kAllLanes, refit_all_[quad]);
        }
      }
    }
  }

  SHEEN_INLINE void hand_over(std::size_t quad, LaneBits splits) {
    L prior[3], mean[3];
    spread(prior_[quad], prior);
    moments(quad).leaning_mean(static_cast<Real>(fit_.rule.ridge.value), prior, mean);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if ((splits >> lane & 1) == 0) continue;
      const std::size_t below = child(quad, lane);
      speaks_[below] = true;
      refit_all_[below] = refit_all_[quad] || (just_split_[quad] >> lane & 1) != 0;
      for (std::size_t i = 0; i < 3; ++i) prior_[below][i] = mean[i][lane];
    }
  }

  SHEEN_INLINE void visit_finest(std::size_t quad) {
    const LaneBits empty = kAllLanes & ~seen(quad);
    const LaneBits fitted = ~empty & (refit_all_[quad] ? kAllLanes : covering_[quad]);
    L prior[3];
    spread(prior_[quad], prior);
    if (fitted != 0) {
      L polynomial[3 * kTerms];
      moments(quad).solve(fit_.rule, prior, polynomial);
      outcome_.fits += static_cast<std::size_t>(__builtin_popcount(fitted));
      store(quad, polynomial, fitted);
    }
    if (empty == 0) return;
    if (!inherits(quad)) {
      store_prior(quad, prior, empty, refit_all_[quad]);
      return;
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if ((empty >> lane & 1) != 0) copy_from_parent(quad, lane);
    }
  }

  // Whether empty leaves of the quad take their parent's polynomial.
  [[nodiscard]] SHEEN_INLINE bool inherits(std::size_t quad) const {
    return fit_.rule.faithful && quad > 0 && fit_.tree.first_finest > 0;
  }

  // Gives lanes without samples the prior. They all hold an older prior already, unless they were
  // just handed over: when that is the same in half floats, nothing needs to be written.
  SHEEN_INLINE void store_prior(std::size_t finest, const L* prior, LaneBits lanes, bool anew) {
    if (!anew && holds_constant(finest, prior, lanes)) return;
    L polynomial[3 * kTerms] = {prior[0], prior[1], prior[2]};
    store(finest, polynomial, lanes);
  }

  [[nodiscard]] SHEEN_INLINE bool holds_constant(std::size_t finest, const L* prior,
                                                 LaneBits lanes) const {
    const std::uint16_t* const stored = coefficients(finest) + __builtin_ctz(lanes);
    bool same = true;
    for (std::size_t i = 0; i < 3; ++i) same &= stored[kLanes * i] == to_halves(prior[i])[0];
    return same;
  }

  // Gives the centres below node (quad, lane) the polynomial of its parent, which is split and so
  // holds samples.
  void copy_from_parent(std::size_t quad, std::size_t lane) {
    const std::size_t parent = quad < 2 ? 0 : 1 + (quad - 2) / 4;
    const std::size_t parent_lane = quad < 2 ? 0 : (quad - 2) % 4;
    L prior[3], polynomial[3 * kTerms];
    spread(prior_[quad], prior);
    moments(parent).solve(fit_.rule, prior, polynomial);
    copy_down(parent, parent_lane, polynomial, quad, lane);
  }

  // Stores one lane of `polynomial`, which belongs to node (source, source_lane), at all centres
  // of node (quad, lane), about each of them (a polynomial's space is closed under that).
  void copy_down(std::size_t source, std::size_t source_lane, const L* polynomial, std::size_t quad,
                 std::size_t lane) {
    L p[3 * kTerms];
    for (std::size_t i = 0; i < 3 * kTerms; ++i) p[i] = all_lanes(polynomial[i][source_lane]);
    if (quad >= fit_.tree.first_finest) {
      store_about(source, source_lane, p, quad, 1U << lane);
      return;
    }
    const Below below = centers_below(quad, lane);
    for (std::size_t i = 0; i < below.count; ++i) {
      store_about(source, source_lane, p, below.first + i, kAllLanes);
    }
  }

  struct Below {
    std::size_t first, count;  // quads of centres
  };

  [[nodiscard]] SHEEN_INLINE Below centers_below(std::size_t quad, std::size_t lane) const {
    Below below{child(quad, lane), 1};
    for (; below.first < fit_.tree.first_finest; below.first = child(below.first, 0)) {
      below.count *= 4;
    }
    return below;
  }

  void store_about(std::size_t source, std::size_t source_lane, const L* p, std::size_t finest,
                   LaneBits lanes) {
    const Quad<Real>& from = fit_.tree.quads[source];
    const Quad<Real>& to = fit_.tree.quads[finest];
    const L x = (load(to.u) - from.u[source_lane]) * from.inverse_radius;
    const L y = (load(to.v) - from.v[source_lane]) * from.inverse_radius;
    const Real scale = to.radius * from.inverse_radius;
    L q[3 * kTerms];
    for (std::size_t i = 0; i < 3; ++i) {
      q[i] = p[i];
      if constexpr (kTerms >= 3) {
        q[i] += x * p[3 + i] + y * p[6 + i];
        q[3 + i] = scale * p[3 + i];
        q[6 + i] = scale * p[6 + i];
      }
      if constexpr (kTerms >= 6) {
        const L xx = p[9 + i], xy = p[12 + i], yy = p[15 + i];
        q[i] += x * (x * xx + y * xy) + y * y * yy;
        q[3 + i] += scale * (2 * x * xx + y * xy);
        q[6 + i] += scale * (2 * y * yy + x * xy);
        q[9 + i] = scale * scale * xx;
        q[12 + i] = scale * scale * xy;
        q[15 + i] = scale * scale * yy;
      }
    }
    store(finest, q, lanes);
  }

  void store(std::size_t finest, const L* polynomial, LaneBits lanes) {
    using Bits = std::uint16_t __attribute__((vector_size(8)));
    const auto b = static_cast<std::uint16_t>(lanes);
    const Bits own = {1, 2, 4, 8};
    const auto keep = reinterpret_cast<Bits>((Bits{b, b, b, b} & own) == 0);
    std::uint16_t* place = coefficients(finest);
    Bits difference{};
    for (std::size_t i = 0; i < 3 * kTerms; ++i, place += kLanes) {
      Bits old;
      __builtin_memcpy(&old, place, sizeof(old));
      const Bits made = (old & keep) | (to_halves(polynomial[i]) & ~keep);
      difference |= old ^ made;
      __builtin_memcpy(place, &made, sizeof(made));
    }
    outcome_.changed |= reinterpret_cast<std::uint64_t>(difference) != 0;
  }

  static SHEEN_INLINE void spread(const Real* rgb, L* lanes) {
    for (std::size_t i = 0; i < 3; ++i) lanes[i] = all_lanes(rgb[i]);
  }

  const QuadFit<Real>& fit_;
  const QuadPatch<Real>& patch_;
  LaneBits covering_[kMaxQuads] = {};    // lanes that hold the sample just gathered
  LaneBits just_split_[kMaxQuads] = {};  // lanes that it brought above the limit
  bool speaks_[kMaxQuads] = {};          // reached by splits
  bool refit_all_[kMaxQuads];
  Real prior_[kMaxQuads][3];
  FitOutcome outcome_{};
};

template <typename Real, std::size_t kTerms>
void gather(const QuadFit<Real>& fit, const QuadPatch<Real>& patch, const QuadSample& sample) {
  QuadPatchFit<Real, kTerms>(fit, patch).gather(sample);
}

template <typename Real, std::size_t kTerms>
FitOutcome integrate(const QuadFit<Real>& fit, const QuadPatch<Real>& patch,
                     const QuadSample& sample, const double* prior) {
  QuadPatchFit<Real, kTerms> one(fit, patch);
  one.gather(sample);
  return one.refit(prior, false);
}

template <typename Real, std::size_t kTerms>
FitOutcome solve(const QuadFit<Real>& fit, const QuadPatch<Real>& patch, const double* prior) {
  return QuadPatchFit<Real, kTerms>(fit, patch).refit(prior, true);
}

template <typename Real, std::size_t kTerms>
void prefetch(const QuadFit<Real>& fit, const QuadPatch<Real>& patch, double u, double v) {
  QuadPatchFit<Real, kTerms>(fit, patch).prefetch(static_cast<Real>(u), static_cast<Real>(v));
}

template <typename Real, std::size_t kTerms>
QuadKernels<Real> kernels_of_terms() {
  return {gather<Real, kTerms>, integrate<Real, kTerms>, solve<Real, kTerms>,
          prefetch<Real, kTerms>};
}

inline EvaluateKernels evaluate_kernels() {
  return {evaluate<1>, evaluate<3>, evaluate<6>};
}

template <typename Real>
QuadKernelSet<Real> quad_kernels(std::string_view instruction_set) {
  return {instruction_set, kernels_of_terms<Real, 1>(), kernels_of_terms<Real, 3>(),
          kernels_of_terms<Real, 6>()};
}

}  // namespace sheen::fitting::iwls::SHEEN_LANES
