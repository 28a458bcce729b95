// SPDX-License-Identifier: MIT
#include "capture/plausibility/unit_guess.h"

#include <fmt/format.h>

#include <utility>

namespace sheen::capture {

std::string unit_guess(double value, double least_m, double most_m) {
  constexpr std::pair<const char*, double> units[] = {
      {"millimetres", 0.001}, {"centimetres", 0.01}, {"inches", 0.0254}};
  std::string guess;
  for (const auto& [name, metres] : units) {
    if (value * metres < least_m || value * metres > most_m) continue;
    guess += (guess.empty() ? "" : " or ") + std::string(name);
  }
  return guess;
}

std::string unit_question(double value, double least_m, double most_m,
                          const std::string& otherwise) {
  const std::string guess = unit_guess(value, least_m, most_m);
  return guess.empty() ? otherwise : "are the numbers " + guess + "?";
}

std::string length_text(double length_m) {
  return length_m < 1e4 ? fmt::format("{:.3g} m", length_m)
                        : fmt::format("{:.4g} km", length_m / 1000);
}

}  // namespace sheen::capture
