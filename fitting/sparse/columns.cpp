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

SHEEN_INLINE float sum(const Column& column, std::size_t rows) {
  Group sums{};
  for (std::size_t row = 0; row < rows; row += kRowGroup) sums += group(column, row);
  return total(sums);
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
  Column near;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled below
  const auto all = static_cast<float>(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    relative_distances(u, v, rows, u.row[i], v.row[i], reach, near);
    // Most samples stand alone: only their own distance is below 1.
    if (sum(near, rows) >= all - 1.0f) {
      out.row[i] = 1.0f;
      continue;
    }
    wendland_of_squared(rows, near);
    out.row[i] = sum(near, rows);
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

}  // namespace sheen::fitting::sparse::columns
