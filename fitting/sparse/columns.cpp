// SPDX-License-Identifier: MIT
#include "fitting/sparse/columns.h"

#include "fitting/every_processor.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace sheen::fitting::sparse::columns {
namespace {

using Group = float __attribute__((vector_size(kRowGroup * sizeof(float))));
static_assert(alignof(Column) % sizeof(Group) == 0);

SHEEN_INLINE const Group& group(const Column& column, std::size_t row) {
  return *reinterpret_cast<const Group*>(column.row + row);
}

SHEEN_INLINE Group& group(Column& column, std::size_t row) {
  return *reinterpret_cast<Group*>(column.row + row);
}

SHEEN_INLINE float total(const Group& sum) {
  return ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
}

// Squared distances in units of the support, at most 1.
SHEEN_INLINE void relative_distances(const Column& u, const Column& v, std::size_t rows,
                                     float center_u, float center_v, float support, Column& out) {
  const float per_squared_support = 1.0f / (support * support);
  for (std::size_t row = 0; row < rows; ++row) {
    const float du = u.row[row] - center_u;
    const float dv = v.row[row] - center_v;
    const float squared = per_squared_support * (du * du + dv * dv);
    out.row[row] = squared < 1.0f ? squared : 1.0f;
  }
}

// Without a branch, so that it runs over several rows at a time.
SHEEN_INLINE void wendland_of_squared(std::size_t rows, Column& out) {
  for (std::size_t row = 0; row < rows; ++row) {
    const float distance = __builtin_sqrtf(out.row[row]);
    const float rest = 1.0f - distance;
    const float rest2 = rest * rest;
    out.row[row] = rest2 * rest2 * (4.0f * distance + 1.0f);
  }
}

SHEEN_INLINE Group wendland_of_squared(Group squared) {
  Group distance;
  for (std::size_t k = 0; k < kRowGroup; ++k) distance[k] = __builtin_sqrtf(squared[k]);
  const Group rest = 1.0f - distance;
  const Group rest2 = rest * rest;
  return rest2 * rest2 * (4.0f * distance + 1.0f);
}

}  // namespace

SHEEN_FOR_EVERY_PROCESSOR
void wendland(const Column& u, const Column& v, const Column& weight, std::size_t rows,
              float center_u, float center_v, float support, Column& out) {
  relative_distances(u, v, rows, center_u, center_v, support, out);
  wendland_of_squared(rows, out);
  for (std::size_t row = 0; row < rows; row += kRowGroup) group(out, row) *= group(weight, row);
}

SHEEN_FOR_EVERY_PROCESSOR
float wendland_sum(const Column& u, const Column& v, const Column& weight, std::size_t rows,
                   float center_u, float center_v, float support) {
  Column theta;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled below
  relative_distances(u, v, rows, center_u, center_v, support, theta);
  wendland_of_squared(rows, theta);
  Group sums{};
  for (std::size_t row = 0; row < rows; row += kRowGroup) {
    sums += group(weight, row) * group(theta, row);
  }
  return total(sums);
}

SHEEN_FOR_EVERY_PROCESSOR
void kernel_density(const Column& u, const Column& v, std::size_t rows, float reach, Column& out) {
  // Every pair once: a sample with those of its own group, and with the groups behind, which get
  // their part at the same time.
  const float per_squared_reach = 1.0f / (reach * reach);
  for (std::size_t row = 0; row < rows; row += kRowGroup) group(out, row) = Group{};
  for (std::size_t i = 0; i < rows; ++i) {
    const std::size_t own = i / kRowGroup * kRowGroup;
    Group sums{};
    for (std::size_t row = own; row < rows; row += kRowGroup) {
      const Group du = group(u, row) - u.row[i];
      const Group dv = group(v, row) - v.row[i];
      const Group squared = per_squared_reach * (du * du + dv * dv);
      const Group theta = wendland_of_squared(squared < 1.0f ? squared : Group{} + 1.0f);
      sums += theta;
      if (row > own) group(out, row) += theta;
    }
    out.row[i] += total(sums);
  }
}

SHEEN_FOR_EVERY_PROCESSOR
void squared_distances(const std::int16_t* u, const std::int16_t* v, float at_u, float at_v,
                       float scale, float* out) {
  for (std::size_t i = 0; i < kPlaceBlock; ++i) {
    const float du = static_cast<float>(u[i]) - at_u;
    const float dv = static_cast<float>(v[i]) - at_v;
    out[i] = (du * du + dv * dv) * scale;
  }
}

SHEEN_FOR_EVERY_PROCESSOR
float dot(const Column& a, const Column& b, std::size_t rows) {
  Group sums{};
  for (std::size_t row = 0; row < rows; row += kRowGroup) sums += group(a, row) * group(b, row);
  return total(sums);
}

SHEEN_FOR_EVERY_PROCESSOR
void dots(const Column* columns, std::size_t count, const Column& b, std::size_t rows, float* out) {
  std::size_t k = 0;
  for (; k + 4 <= count; k += 4) {
    Group sum0{}, sum1{}, sum2{}, sum3{};
    for (std::size_t row = 0; row < rows; row += kRowGroup) {
      const Group factor = group(b, row);
      sum0 += group(columns[k], row) * factor;
      sum1 += group(columns[k + 1], row) * factor;
      sum2 += group(columns[k + 2], row) * factor;
      sum3 += group(columns[k + 3], row) * factor;
    }
    out[k] = total(sum0);
    out[k + 1] = total(sum1);
    out[k + 2] = total(sum2);
    out[k + 3] = total(sum3);
  }
  for (; k < count; ++k) {
    Group sums{};
    for (std::size_t row = 0; row < rows; row += kRowGroup) {
      sums += group(columns[k], row) * group(b, row);
    }
    out[k] = total(sums);
  }
}

SHEEN_FOR_EVERY_PROCESSOR
void subtract(const Column* columns, std::size_t count, const float* factor, std::size_t rows,
              Column& out) {
  for (std::size_t row = 0; row < rows; row += kRowGroup) {
    Group rest = group(out, row);
    for (std::size_t k = 0; k < count; ++k) rest -= factor[k] * group(columns[k], row);
    group(out, row) = rest;
  }
}

SHEEN_FOR_EVERY_PROCESSOR
void scale(const Column& factor, std::size_t rows, Column& out) {
  for (std::size_t row = 0; row < rows; row += kRowGroup) group(out, row) *= group(factor, row);
}

SHEEN_FOR_EVERY_PROCESSOR
void squared_lengths(const Column* columns, std::size_t count, std::size_t rows, Column& out) {
  for (std::size_t row = 0; row < rows; row += kRowGroup) {
    Group sums{};
    for (std::size_t k = 0; k < count; ++k) sums += group(columns[k], row) * group(columns[k], row);
    group(out, row) = sums;
  }
}

SHEEN_FOR_EVERY_PROCESSOR
std::size_t best_gain(const float* r, const float* g, const float* b, const float* remainder,
                      std::size_t count, float least) {
  using Indices = std::int32_t __attribute__((vector_size(kRowGroup * sizeof(std::int32_t))));
  const auto at = [](const float* numbers, std::size_t k) SHEEN_INLINE_LAMBDA -> const Group& {
    return *reinterpret_cast<const Group*>(numbers + k);
  };
  // The best of every place in the groups, then the best of these.
  Group greatest{};
  Indices where = static_cast<std::int32_t>(count) + Indices{};
  Indices here{0, 1, 2, 3, 4, 5, 6, 7};
  for (std::size_t k = 0; k < count; k += kRowGroup, here += kRowGroup) {
    const Group divisor = at(remainder, k);
    const Group squared = at(r, k) * at(r, k) + at(g, k) * at(g, k) + at(b, k) * at(b, k);
    const Group gain = divisor > least ? squared / (divisor > least ? divisor : Group{} + 1) : 0;
    where = gain > greatest ? here : where;
    greatest = gain > greatest ? gain : greatest;
  }
  std::size_t best = 0;
  for (std::size_t place = 1; place < kRowGroup; ++place) {
    const bool first = greatest[place] == greatest[best] && where[place] < where[best];
    if (greatest[place] > greatest[best] || first) best = place;
  }
  return static_cast<std::size_t>(where[best]);
}

namespace {

constexpr std::size_t kGroupsAtOnce = kAtomGroup / kRowGroup;
static_assert(alignof(AtomLine) % sizeof(Group) == 0);

SHEEN_INLINE const Group& group(const AtomLine& line, std::size_t atom) {
  return *reinterpret_cast<const Group*>(line.atom + atom);
}

SHEEN_INLINE Group& group(AtomLine& line, std::size_t atom) {
  return *reinterpret_cast<Group*>(line.atom + atom);
}

}  // namespace

SHEEN_FOR_EVERY_PROCESSOR
void atom_lines(const Column& u, const Column& v, std::size_t samples, const AtomPlaces& places,
                std::size_t atoms, AtomLine* line) {
  for (std::size_t row = 0; row < samples; ++row) {
    float* out = line[row].atom;
    for (std::size_t atom = 0; atom < atoms; ++atom) {
      const float du = u.row[row] - places.center_u.atom[atom];
      const float dv = v.row[row] - places.center_v.atom[atom];
      const float squared = places.per_squared_support.atom[atom] * (du * du + dv * dv);
      const float distance = __builtin_sqrtf(squared < 1.0f ? squared : 1.0f);
      const float rest = 1.0f - distance;
      const float rest2 = rest * rest;
      out[atom] = rest2 * rest2 * (4.0f * distance + 1.0f);
    }
  }
}

SHEEN_FOR_EVERY_PROCESSOR
void atom_sums(const AtomLine* line, std::size_t samples, std::size_t atoms, const Column* factor,
               AtomLine* sum) {
  constexpr std::size_t groups = 4;  // times three sums: as many as there are registers
  for (std::size_t atom = 0; atom < atoms; atom += groups * kRowGroup) {
    Group r[groups]{}, g[groups]{}, b[groups]{};
    for (std::size_t row = 0; row < samples; ++row) {
      for (std::size_t k = 0; k < groups; ++k) {
        const Group value = group(line[row], atom + k * kRowGroup);
        r[k] += value * factor[0].row[row];
        g[k] += value * factor[1].row[row];
        b[k] += value * factor[2].row[row];
      }
    }
    for (std::size_t k = 0; k < groups; ++k) {
      group(sum[0], atom + k * kRowGroup) = r[k];
      group(sum[1], atom + k * kRowGroup) = g[k];
      group(sum[2], atom + k * kRowGroup) = b[k];
    }
  }
}

SHEEN_FOR_EVERY_PROCESSOR
void atom_squares(const AtomLine* line, std::size_t samples, std::size_t atoms,
                  const Column& squared_weight, AtomLine& covered, AtomLine& squared) {
  constexpr std::size_t groups = 4;
  for (std::size_t atom = 0; atom < atoms; atom += groups * kRowGroup) {
    Group first[groups]{}, second[groups]{};
    for (std::size_t row = 0; row < samples; ++row) {
      for (std::size_t k = 0; k < groups; ++k) {
        const Group value = group(line[row], atom + k * kRowGroup);
        const Group weighted = value * squared_weight.row[row];
        first[k] += weighted;
        second[k] += weighted * value;
      }
    }
    for (std::size_t k = 0; k < groups; ++k) {
      group(covered, atom + k * kRowGroup) = first[k];
      group(squared, atom + k * kRowGroup) = second[k];
    }
  }
}

SHEEN_FOR_EVERY_PROCESSOR
void take_away(const AtomLine* line, std::size_t samples, std::size_t atoms, const Column* factor,
               const float* along, std::size_t count, AtomLine& remainder, AtomLine* correlation) {
  for (std::size_t atom = 0; atom < atoms; atom += kAtomGroup) {
    for (std::size_t j = 0; j < count; ++j) {
      Group shared[kGroupsAtOnce]{};
      for (std::size_t row = 0; row < samples; ++row) {
        const float by = factor[j].row[row];
        for (std::size_t k = 0; k < kGroupsAtOnce; ++k) {
          shared[k] += group(line[row], atom + k * kRowGroup) * by;
        }
      }
      for (std::size_t k = 0; k < kGroupsAtOnce; ++k) {
        const std::size_t at = atom + k * kRowGroup;
        group(remainder, at) -= shared[k] * shared[k];
        for (std::size_t c = 0; c < 3; ++c) {
          group(correlation[c], at) -= along[3 * j + c] * shared[k];
        }
      }
    }
  }
}

}  // namespace sheen::fitting::sparse::columns
