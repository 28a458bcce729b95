// SPDX-License-Identifier: MIT
#include "evaluation/comparison/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace sheen::evaluation {
namespace {

// Differences below it are hard to see side by side.
constexpr double kNegligible_db = 0.5;
// What one sees without looking for it: change of one image over the usual change (steps that are
// blended stay below 3), and the part of the object that is not there.
constexpr double kVisibleJump = 5;
constexpr double kVisibleHoles = 0.005;
// What another candidate must do better to be worth a word.
constexpr double kWorse_db = 2;
constexpr double kWorseEdges = 1.5;
constexpr double kMoreMemory = 3;

using Rows = std::span<const ComparedCandidate>;

double psnr(const ComparedCandidate& row) {
  return row.measured.error.psnr_db;
}

double bytes(const ComparedCandidate& row) {
  return static_cast<double>(row.measured.model_bytes);
}

/// "8 % of its bytes" below one, "1.3 times its bytes" above.
std::string share(double part, double whole, const char* of_what) {
  const double ratio = part / whole;
  if (ratio < 0.01) return fmt::format("{:.2g} % of its {}", 100 * ratio, of_what);
  if (ratio < 0.995) return fmt::format("{:.0f} % of its {}", 100 * ratio, of_what);
  return fmt::format("{:.{}f} times its {}", ratio, ratio < 9.95 ? 1 : 0, of_what);
}

bool jumps(const ComparedCandidate& row) {
  return row.measured.pop_ratio > kVisibleJump;
}
bool has_holes(const ComparedCandidate& row) {
  return row.measured.outline.hole_fraction > kVisibleHoles;
}

const ComparedCandidate& most_accurate(Rows rows) {
  return *std::max_element(rows.begin(), rows.end(),
                           [](const auto& a, const auto& b) { return psnr(a) < psnr(b); });
}

/// The smallest of those that are good enough and neither jump nor have holes, if there is one;
/// else the smallest that is good enough.
const ComparedCandidate& smallest_good(Rows rows, double least_db) {
  const ComparedCandidate* pick = nullptr;
  const auto rank = [](const ComparedCandidate& row) {
    return std::tuple(jumps(row) || has_holes(row), bytes(row), -psnr(row));
  };
  for (const ComparedCandidate& row : rows) {
    if (psnr(row) >= least_db && (pick == nullptr || rank(row) < rank(*pick))) pick = &row;
  }
  return *pick;
}

/// The most accurate of those that are smaller; null when `pick` is the smallest.
const ComparedCandidate* next_smaller(Rows rows, const ComparedCandidate& pick) {
  const ComparedCandidate* next = nullptr;
  for (const ComparedCandidate& row : rows) {
    if (bytes(row) < bytes(pick) && (next == nullptr || psnr(row) > psnr(*next))) next = &row;
  }
  return next;
}

std::string against_best(const ComparedCandidate& pick, const ComparedCandidate& best) {
  return fmt::format("{:.1f} dB below the best, \"{}\", at {} and {}", psnr(best) - psnr(pick),
                     best.candidate.label, share(bytes(pick), bytes(best), "bytes"),
                     share(pick.measured.fit_ms, best.measured.fit_ms, "fitting time"));
}

std::string against_smaller(Rows rows, const ComparedCandidate& pick) {
  const ComparedCandidate* next = next_smaller(rows, pick);
  if (next == nullptr) return "the most accurate and the smallest of all compared";
  return fmt::format(
      "the most accurate of all compared; the best of the smaller ones, \"{}\", loses {:.1f} dB at "
      "{}",
      next->candidate.label, psnr(pick) - psnr(*next), share(bytes(*next), bytes(pick), "bytes"));
}

/// What speaks against the pick, from the figures that PSNR does not show: each beside the
/// candidate that does best there.
std::string drawbacks(Rows rows, const ComparedCandidate& pick) {
  std::string text;
  const auto add = [&](const std::string& one) { text += (text.empty() ? "; but " : ", ") + one; };
  const auto best_by = [&](const auto& figure) -> const ComparedCandidate& {
    return *std::ranges::max_element(rows, {}, figure);
  };
  if (jumps(pick)) {
    add(fmt::format("it jumps while the viewer moves (changes of {:.0f} times the usual one)",
                    pick.measured.pop_ratio));
  }
  if (has_holes(pick)) {
    add(fmt::format("it leaves {:.1f} % of the object uncovered",
                    100 * pick.measured.outline.hole_fraction));
  }
  const auto worst_db = [](const ComparedCandidate& row) { return row.measured.worst_psnr_db; };
  if (const auto& best = best_by(worst_db); worst_db(pick) < worst_db(best) - kWorse_db) {
    add(fmt::format("its worst view has {:.1f} dB (\"{}\": {:.1f})", worst_db(pick),
                    best.candidate.label, worst_db(best)));
  }
  const auto edges = [](const ComparedCandidate& row) {
    return row.measured.outline.edge_difference;
  };
  const auto no_edges = [&](const ComparedCandidate& row) { return -edges(row); };
  if (const auto& best = best_by(no_edges); edges(pick) > kWorseEdges * edges(best)) {
    add(fmt::format("its edges differ by {:.0f} grey levels (\"{}\": {:.0f})", edges(pick),
                    best.candidate.label, edges(best)));
  }
  const auto outside_db = [](const ComparedCandidate& row) {
    return row.measured.outline.box_psnr_db;
  };
  if (const auto& best = best_by(outside_db); outside_db(pick) < outside_db(best) - kWorse_db) {
    add(fmt::format("it draws beside the object ({:.1f} dB over its box, \"{}\": {:.1f})",
                    outside_db(pick), best.candidate.label, outside_db(best)));
  }
  // A memory of 0 is one that nobody knows.
  const auto mb = [](const ComparedCandidate& row) {
    return 1e-6 * static_cast<double>(row.measured.drawing_bytes);
  };
  const auto little = [&](const ComparedCandidate& row) {
    return psnr(row) >= psnr(pick) - kWorse_db ? -mb(row) : -mb(pick);
  };
  if (const auto& best = best_by(little); mb(best) > 0 && mb(pick) > kMoreMemory * mb(best)) {
    add(fmt::format("it takes {:.0f} MB while drawn (\"{}\": {:.0f})", mb(pick),
                    best.candidate.label, mb(best)));
  }
  return text;
}

}  // namespace

std::optional<Advice> advise(Rows rows, std::size_t sessions) {
  if (rows.empty()) return std::nullopt;
  const ComparedCandidate& best = most_accurate(rows);
  const ComparedCandidate& pick = smallest_good(rows, psnr(best) - kNegligible_db);
  return Advice{pick.candidate.name,
                fmt::format("For {} use \"{}\": {:.1f} dB on views never seen, {}{}.",
                            sessions == 1 ? "this recording" : "these recordings",
                            pick.candidate.label, psnr(pick),
                            &pick == &best ? against_smaller(rows, pick) : against_best(pick, best),
                            drawbacks(rows, pick))};
}

}  // namespace sheen::evaluation
