// SPDX-License-Identifier: MIT
#include "evaluation/comparison/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace sheen::evaluation {
namespace {

// Differences below it are hard to see side by side.
constexpr double kNegligible_db = 0.5;

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

const ComparedCandidate& most_accurate(Rows rows) {
  return *std::max_element(rows.begin(), rows.end(),
                           [](const auto& a, const auto& b) { return psnr(a) < psnr(b); });
}

const ComparedCandidate& smallest_good(Rows rows, double least_db) {
  const ComparedCandidate* pick = nullptr;
  for (const ComparedCandidate& row : rows) {
    if (psnr(row) < least_db) continue;
    if (pick == nullptr ||
        std::tuple(bytes(row), -psnr(row)) < std::tuple(bytes(*pick), -psnr(*pick))) {
      pick = &row;
    }
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

}  // namespace

std::optional<Advice> advise(Rows rows, std::size_t sessions) {
  if (rows.empty()) return std::nullopt;
  const ComparedCandidate& best = most_accurate(rows);
  const ComparedCandidate& pick = smallest_good(rows, psnr(best) - kNegligible_db);
  return Advice{
      pick.candidate.name,
      fmt::format("For {} use \"{}\": {:.1f} dB on views never seen, {}.",
                  sessions == 1 ? "this recording" : "these recordings", pick.candidate.label,
                  psnr(pick),
                  &pick == &best ? against_smaller(rows, pick) : against_best(pick, best))};
}

}  // namespace sheen::evaluation
