// SPDX-License-Identifier: MIT
#include "fitting/iwls/wendland.h"
#include "fitting/sparse/patch_model.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <vector>

namespace sheen::fitting::sparse {
namespace {

constexpr std::array kSides{2, 4, 8};
constexpr float kSupportInCells = 1.25f;

// Cells of one level that meet the disc, row by row from (-1, -1).
void add_level(int side, std::vector<Atom>& atoms) {
  const float cell = 2.0f / static_cast<float>(side);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const Eigen::Vector2f center =
          cell * Eigen::Vector2f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f) -
          Eigen::Vector2f::Ones();
      const Eigen::Vector2f nearest =
          (center.cwiseAbs() - Eigen::Vector2f::Constant(cell / 2)).cwiseMax(0.0f);
      if (nearest.squaredNorm() < 1.0f) atoms.push_back({center, kSupportInCells * cell});
    }
  }
}

std::vector<Atom> make_atoms() {
  std::vector<Atom> atoms;
  for (const int side : kSides) add_level(side, atoms);
  assert(atoms.size() <= std::numeric_limits<std::uint8_t>::max() + std::size_t{1});
  return atoms;
}

// By a grid over the square: with 256 steps the means are good to four digits, more than a vertex
// colour shows.
std::vector<float> make_means() {
  constexpr int steps = 256;
  std::vector<double> sums(atoms().size(), 0.0);
  double points = 0;
  for (int y = 0; y < steps; ++y) {
    for (int x = 0; x < steps; ++x) {
      const Eigen::Vector2f uv(2.0f * (static_cast<float>(x) + 0.5f) / steps - 1.0f,
                               2.0f * (static_cast<float>(y) + 0.5f) / steps - 1.0f);
      if (uv.squaredNorm() > 1.0f) continue;
      points += 1;
      for (std::size_t i = 0; i < sums.size(); ++i) {
        const Atom& atom = atoms()[i];
        sums[i] += static_cast<double>(iwls::wendland((uv - atom.center).norm() / atom.support));
      }
    }
  }
  std::vector<float> means;
  for (const double sum : sums) means.push_back(static_cast<float>(sum / points));
  return means;
}

}  // namespace

std::span<const Atom> atoms() {
  static const std::vector<Atom> all = make_atoms();
  return all;
}

std::span<const float> atom_means() {
  static const std::vector<float> all = make_means();
  return all;
}

}  // namespace sheen::fitting::sparse
