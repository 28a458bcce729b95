// SPDX-License-Identifier: MIT
#include "fitting/iwls/wendland.h"
#include "fitting/sparse/patch_model.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <vector>

namespace sheen::fitting::sparse {
namespace {

// Bumps overlap widely: with supports of 1.25 cells, as near to cells as they can be, the study's
// scene is at 37.3 dB with levels 2 to 8 and 38.6 dB with 16 added; with 3.5 cells at 41 and 44.5.
struct Level {
  int side;
  float support_in_cells;
};
constexpr std::array<Level, 4> kLevels{{{2, 3.5f}, {4, 3.5f}, {8, 3.5f}, {16, 5.0f}}};

// Cells of one level that meet the disc, row by row from (-1, -1).
void add_level(const Level& level, std::vector<Atom>& atoms) {
  const int side = level.side;
  const float cell = 2.0f / static_cast<float>(side);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const Eigen::Vector2f center =
          cell * Eigen::Vector2f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f) -
          Eigen::Vector2f::Ones();
      const Eigen::Vector2f nearest =
          (center.cwiseAbs() - Eigen::Vector2f::Constant(cell / 2)).cwiseMax(0.0f);
      if (nearest.squaredNorm() < 1.0f)
        atoms.push_back({center, level.support_in_cells * cell, cell});
    }
  }
}

std::vector<Atom> make_atoms() {
  std::vector<Atom> atoms;
  for (const Level& level : kLevels) add_level(level, atoms);
  assert(atoms.size() <= kMaxAtoms);
  return atoms;
}

// By a grid over the square: with 256 steps the means are good to four digits, more than a vertex
// colour shows.
constexpr int kSteps = 256;

Eigen::Vector2f grid_point(int x, int y) {
  return {2.0f * (static_cast<float>(x) + 0.5f) / kSteps - 1.0f,
          2.0f * (static_cast<float>(y) + 0.5f) / kSteps - 1.0f};
}

double points_on_disc() {
  double points = 0;
  for (int y = 0; y < kSteps; ++y) {
    for (int x = 0; x < kSteps; ++x) points += grid_point(x, y).squaredNorm() > 1.0f ? 0 : 1;
  }
  return points;
}

double sum_over_disc(const Atom& atom) {
  const auto step_at = [](float place) {
    return std::clamp(static_cast<int>((place + 1.0f) * (kSteps / 2.0f)), 0, kSteps - 1);
  };
  double sum = 0;
  for (int y = step_at(atom.center.y() - atom.support);
       y <= step_at(atom.center.y() + atom.support); ++y) {
    for (int x = step_at(atom.center.x() - atom.support);
         x <= step_at(atom.center.x() + atom.support); ++x) {
      const Eigen::Vector2f uv = grid_point(x, y);
      if (uv.squaredNorm() > 1.0f) continue;
      sum += static_cast<double>(iwls::wendland((uv - atom.center).norm() / atom.support));
    }
  }
  return sum;
}

/// Whether one is the other mirrored.
bool are_mirrored(const Atom& a, const Atom& b) {
  const Eigen::Vector2f at = a.center.cwiseAbs();
  const Eigen::Vector2f other = b.center.cwiseAbs();
  return a.support == b.support && (at == other || at == other.reverse());
}

// Eight atoms, mirrored, have one mean.
std::vector<float> make_means() {
  const std::span<const Atom> all = atoms();
  const double points = points_on_disc();
  std::vector<float> means;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::size_t first = 0;
    while (first < i && !are_mirrored(all[first], all[i])) ++first;
    means.push_back(first < i ? means[first] : static_cast<float>(sum_over_disc(all[i]) / points));
  }
  return means;
}

// Lists for the cells of the finest grid: coarser cells are unions of them.
class Neighbourhoods {
 public:
  Neighbourhoods() {
    for (int cell = 0; cell < kSide * kSide; ++cell) {
      first_.push_back(ids_.size());
      const Eigen::Vector2f center = Eigen::Vector2f(static_cast<float>(cell % kSide) + 0.5f,
                                                     static_cast<float>(cell / kSide) + 0.5f) *
                                         (2.0f / kSide) -
                                     Eigen::Vector2f::Ones();
      add_atoms_round(center);
    }
    first_.push_back(ids_.size());
  }
  [[nodiscard]] std::span<const std::uint16_t> at(const Eigen::Vector2f& uv) const {
    const auto along = [](float x) {
      return std::clamp(static_cast<int>((x + 1.0f) * (kSide / 2.0f)), 0, kSide - 1);
    };
    const auto cell = static_cast<std::size_t>(along(uv.y()) * kSide + along(uv.x()));
    return std::span(ids_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
  }

 private:
  static constexpr int kSide = kLevels.back().side;

  void add_atoms_round(const Eigen::Vector2f& uv) {
    for (std::size_t idx = 0; idx < atoms().size(); ++idx) {
      // A neighbouring cell's centre is at most a cell and a half away.
      const float reach = 1.5f * atoms()[idx].cell;
      if ((atoms()[idx].center - uv).cwiseAbs().maxCoeff() < reach) {
        ids_.push_back(static_cast<std::uint16_t>(idx));
      }
    }
  }

  std::vector<std::uint16_t> ids_;
  std::vector<std::size_t> first_;
};

// Sets for the cells of a grid twice as fine as the finest level's.
class FeltAtoms {
 public:
  FeltAtoms() {
    for (int cell = 0; cell < kSide * kSide; ++cell) {
      const Eigen::Vector2f center =
          kCell * Eigen::Vector2f(static_cast<float>(cell % kSide) + 0.5f,
                                  static_cast<float>(cell / kSide) + 0.5f) -
          Eigen::Vector2f::Ones();
      set_[static_cast<std::size_t>(cell)] = felt_in(center);
    }
  }
  [[nodiscard]] const AtomSet& at(const Eigen::Vector2f& uv) const {
    const auto along = [](float x) {
      return std::clamp(static_cast<int>((x + 1.0f) / kCell), 0, kSide - 1);
    };
    return set_[static_cast<std::size_t>(along(uv.y()) * kSide + along(uv.x()))];
  }

 private:
  static constexpr int kSide = 2 * kLevels.back().side;
  static constexpr float kCell = 2.0f / kSide;

  // Of a cell about `center`: by its nearest point.
  static AtomSet felt_in(const Eigen::Vector2f& center) {
    constexpr float reach = 0.78f;  // supports; Wendland's function is .0097 there
    AtomSet felt{};
    for (std::size_t idx = 0; idx < atoms().size(); ++idx) {
      const Atom& atom = atoms()[idx];
      const Eigen::Vector2f nearest =
          ((atom.center - center).cwiseAbs() - Eigen::Vector2f::Constant(kCell / 2)).cwiseMax(0.0f);
      if (nearest.norm() < reach * atom.support) felt[idx / 64] |= std::uint64_t{1} << idx % 64;
    }
    return felt;
  }

  std::array<AtomSet, std::size_t{kSide} * kSide> set_;
};

}  // namespace

std::span<const std::uint16_t> atoms_round(const Eigen::Vector2f& uv) {
  static const Neighbourhoods all;
  return all.at(uv);
}

const AtomSet& atoms_felt_at(const Eigen::Vector2f& uv) {
  static const FeltAtoms all;
  return all.at(uv);
}

std::span<const Atom> atoms() {
  static const std::vector<Atom> all = make_atoms();
  return all;
}

std::span<const float> atom_means() {
  static const std::vector<float> all = make_means();
  return all;
}

}  // namespace sheen::fitting::sparse
