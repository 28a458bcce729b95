// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

namespace sheen::fitting::sparse {

/// Rows that a column has room for: the most samples a patch may keep.
inline constexpr std::size_t kColumnRows = 128;
/// Rows are worked on in groups of this many.
inline constexpr std::size_t kRowGroup = 8;

/// One number for each of up to kColumnRows samples.
struct alignas(64) Column {
  float row[kColumnRows];
};

/// Rows rounded up to whole groups. What follows works on whole groups: callers keep the rows
/// behind the last sample so that they add nothing.
constexpr std::size_t padded(std::size_t rows) {
  return (rows + kRowGroup - 1) / kRowGroup * kRowGroup;
}

/// Room for atoms at one sample; they are worked on in groups of kAtomGroup.
inline constexpr std::size_t kAtomPlaces = 320;
inline constexpr std::size_t kAtomGroup = 64;
static_assert(kAtomPlaces % kAtomGroup == 0);
struct alignas(64) AtomLine {
  float atom[kAtomPlaces];
};

/// Atoms' centres and 1 / support^2; up to a whole group, centres far outside the disc.
struct AtomPlaces {
  AtomLine center_u, center_v, per_squared_support;
};

/// The inner loops of sparse fits. Compiled for AVX2 too where the processor has it, with the same
/// results to the bit; `rows` is a multiple of kRowGroup, `atoms` of kAtomGroup.
namespace columns {

/// out = weight * theta(|(u, v) - (center_u, center_v)| / support), theta Wendland's function.
void wendland(const Column& u, const Column& v, const Column& weight, std::size_t rows,
              float center_u, float center_v, float support, Column& out);

/// Sum over the rows of weight * theta(|(u, v) - (center_u, center_v)| / support).
float wendland_sum(const Column& u, const Column& v, const Column& weight, std::size_t rows,
                   float center_u, float center_v, float support);

/// out[i] = sum_j theta(|x_i - x_j| / reach). Rows behind the last sample must lie further than
/// `reach` from all samples.
void kernel_density(const Column& u, const Column& v, std::size_t rows, float reach, Column& out);

/// Places whose distances are measured at a time.
inline constexpr std::size_t kPlaceBlock = 16;
/// out[i] = scale * ((u_i - at_u)^2 + (v_i - at_v)^2), i < kPlaceBlock.
void squared_distances(const std::int16_t* u, const std::int16_t* v, float at_u, float at_v,
                       float scale, float* out);

float dot(const Column& a, const Column& b, std::size_t rows);

/// out[k] = columns[k] . b, k < count.
void dots(const Column* columns, std::size_t count, const Column& b, std::size_t rows, float* out);

/// out -= sum_k factor[k] * columns[k].
void subtract(const Column* columns, std::size_t count, const float* factor, std::size_t rows,
              Column& out);

/// out *= factor.
void scale(const Column& factor, std::size_t rows, Column& out);

/// out[i] = sum_k columns[k][i]^2.
void squared_lengths(const Column* columns, std::size_t count, std::size_t rows, Column& out);

/// The first k < count with the greatest (r_k^2 + g_k^2 + b_k^2) / remainder_k among those whose
/// remainder is greater than `least`; `count` where none is greater than zero. `count` is a
/// multiple of kRowGroup, and the numbers are aligned like columns.
std::size_t best_gain(const float* r, const float* g, const float* b, const float* remainder,
                      std::size_t count, float least);

/// line[i].atom[k] = theta(|(u_i, v_i) - center_k| / support_k), k < atoms, for the first
/// `samples`.
void atom_lines(const Column& u, const Column& v, std::size_t samples, const AtomPlaces& places,
                std::size_t atoms, AtomLine* line);

/// sum[c].atom[k] = sum_i factor[c].row[i] * line[i].atom[k] for the first `samples`, c < 3.
void atom_sums(const AtomLine* line, std::size_t samples, std::size_t atoms, const Column* factor,
               AtomLine* sum);

/// covered.atom[k] = sum_i w_i * line[i].atom[k], squared.atom[k] = sum_i w_i * line[i].atom[k]^2,
/// w the squared weights of the first `samples`.
void atom_squares(const AtomLine* line, std::size_t samples, std::size_t atoms,
                  const Column& squared_weight, AtomLine& covered, AtomLine& squared);

/// With s_k = sum_i factor[j].row[i] * line[i].atom[k]: remainder_k -= s_k^2 and
/// correlation[c]_k -= along[3 j + c] * s_k, c < 3, for j = 0, ... count - 1.
void take_away(const AtomLine* line, std::size_t samples, std::size_t atoms, const Column* factor,
               const float* along, std::size_t count, AtomLine& remainder, AtomLine* correlation);

}  // namespace columns
}  // namespace sheen::fitting::sparse
