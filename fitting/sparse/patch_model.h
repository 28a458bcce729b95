// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace sheen::fitting::sparse {

/// A compactly supported RBF on the disc of directions: Wendland's function (eq. 5) round a cell
/// of the quadtree.
struct Atom {
  Eigen::Vector2f center;  ///< on the unit disc's plane
  float support;           ///< radius in disc units
  float cell;              ///< side of the cell that it stands for, disc units
};

/// Ids are below this: larger ones would not be exact in the half floats of textures.
inline constexpr std::size_t kMaxAtoms = 304;
static_assert(kMaxAtoms <= 2048);

/// The fixed dictionary: cells of 2x2, 4x4, 8x8 and 16x16 grids over [-1, 1]^2 that meet the disc,
/// coarse to fine; support 3.5 cells, of the finest level 5. The index is the atom's id in models
/// and files; at most kMaxAtoms.
std::span<const Atom> atoms();

/// Ids of the atoms round a direction: of each level the cell that holds it and the eight about it.
std::span<const std::uint16_t> atoms_round(const Eigen::Vector2f& uv);

/// A set of atoms, a bit for each.
using AtomSet = std::array<std::uint64_t, (kMaxAtoms + 63) / 64>;

/// Atoms that a sample towards `uv` tells something of: all whose RBF is more than 1 % of its
/// height there, and a few more.
const AtomSet& atoms_felt_at(const Eigen::Vector2f& uv);

/// Mean of every atom's RBF over the unit disc, as if its colour were 1 (by area of the disc).
std::span<const float> atom_means();

/// Terms of the base: the constant, or the constant and the direction's x, y, z in the patch frame.
inline constexpr std::size_t kConstantBase = 1;
inline constexpr std::size_t kLinearBase = 4;
inline constexpr std::size_t kMaxRbfs = 24;

/// Radiance of one patch: colour(x) = base(x) + sum_k c_k theta(|x - center_k| / support_k).
struct PatchModel {
  std::size_t base_terms = kConstantBase;      ///< kConstantBase or kLinearBase
  std::size_t rbf_count = 0;                   ///< <= kMaxRbfs
  std::array<std::uint16_t, kMaxRbfs> atom{};  ///< ids, distinct
  /// Base terms first, then one per RBF; RGB, display-referred sRGB.
  std::array<Eigen::Vector3f, kLinearBase + kMaxRbfs> coefficient{};

  [[nodiscard]] std::size_t term_count() const { return base_terms + rbf_count; }
};

/// Value of a patch towards `uv` (clamped to the disc), not clamped to [0, 1].
Eigen::Vector3f evaluate(const PatchModel& model, const Eigen::Vector2f& uv);

/// Mean of a patch over the unit disc (by area of the disc), not clamped to [0, 1].
Eigen::Vector3f disc_mean(const PatchModel& model);

}  // namespace sheen::fitting::sparse
