// SPDX-License-Identifier: MIT
#include "fitting/detail/patch_kernels.h"

#include "fitting/every_processor.h"
#include "fitting/sparse/columns.h"

#include <array>
#include <cstring>
#include <span>

namespace sheen::fitting::detail {
namespace {

constexpr std::size_t kGroup = sparse::kRowGroup;
using Group = float __attribute__((vector_size(kGroup * sizeof(float))));
using GroupInts = std::int32_t __attribute__((vector_size(kGroup * sizeof(float))));
using Vector = std::array<float, 3>;

SHEEN_INLINE Group load(const float* rows) {
  Group group;
  std::memcpy(&group, rows, sizeof(group));
  return group;
}

SHEEN_INLINE void store(const Group& group, float* rows) {
  std::memcpy(rows, &group, sizeof(group));
}

SHEEN_INLINE Group root(const Group& squared) {
  Group result;
  for (std::size_t k = 0; k < kGroup; ++k) result[k] = __builtin_sqrtf(squared[k]);
  return result;
}

/// On the patch's tangent plane, and height above it.
struct Asked {
  Group u, v, height;
};

/// AskedPatch in plain numbers.
struct Asking {
  Vector tangent, bitangent, normal, at;
  float side;  ///< -1 where it is mirrored
};

Vector vector(const Eigen::Vector3f& v) {
  return {v.x(), v.y(), v.z()};
}

Asking asking(const AskedPatch& asked) {
  return {vector(asked.frame.tangent), vector(asked.frame.bitangent), vector(asked.frame.normal),
          vector(asked.normal), asked.is_mirrored ? -1.0f : 1.0f};
}

SHEEN_INLINE Group dot(const Vector& a, const Group& x, const Group& y, const Group& z) {
  return a[0] * x + a[1] * y + a[2] * z;
}

// Mirroring at the place, less the sign: -r = w - 2 (n . w) n; mirroring at the patch turns it once
// more and leaves -r on its tangent plane.
SHEEN_INLINE Asked ask(const Asking& asking, const DirectionRows& w, std::size_t row) {
  Group x = load(w.x + row);
  Group y = load(w.y + row);
  Group z = load(w.z + row);
  if (asking.side < 0.0f) {
    const Group twice = 2.0f * dot(asking.at, x, y, z);
    x -= twice * asking.at[0];
    y -= twice * asking.at[1];
    z -= twice * asking.at[2];
  }
  Asked asked{dot(asking.tangent, x, y, z), dot(asking.bitangent, x, y, z), {}};
  const Group squared = asked.u * asked.u + asked.v * asked.v;
  const GroupInts is_behind = (asking.side * dot(asking.normal, x, y, z) < 0.0f) & (squared > 0.0f);
  const GroupInts is_on_rim = is_behind | (squared >= 1.0f);
  const Group one = 1.0f - Group{};
  const Group to_rim = one / root(is_on_rim ? squared : one);
  asked.u *= to_rim;
  asked.v *= to_rim;
  asked.height = root(is_on_rim ? Group{} : one - squared);
  return asked;
}

SHEEN_INLINE Group wendland(const sparse::Atom& atom, const Group& u, const Group& v) {
  const Group du = u - atom.center.x();
  const Group dv = v - atom.center.y();
  const Group squared = (du * du + dv * dv) * (1.0f / (atom.support * atom.support));
  const Group distance = root(squared < 1.0f ? squared : 1.0f - Group{});
  const Group rest = 1.0f - distance;
  const Group rest2 = rest * rest;
  return rest2 * rest2 * (4.0f * distance + 1.0f);
}

}  // namespace

SHEEN_FOR_EVERY_PROCESSOR
void asked_directions(const AskedPatch& patch, const DirectionRows& w, float* u, float* v) {
  const Asking from = asking(patch);
  for (std::size_t row = 0; row < w.count; row += kGroup) {
    const Asked asked = ask(from, w, row);
    store(asked.u, u + row);
    store(asked.v, v + row);
  }
}

SHEEN_FOR_EVERY_PROCESSOR
void add_patch(const AskedPatch& patch, const sparse::PatchModel& model, float weight,
               const DirectionRows& w, const ColourRows& sum) {
  const Asking from = asking(patch);
  const std::span<const sparse::Atom> dictionary = sparse::atoms();
  std::array<Vector, sparse::kLinearBase + sparse::kMaxRbfs> factor;
  for (std::size_t term = 0; term < model.term_count(); ++term) {
    factor[term] = vector(weight * model.coefficient[term]);
  }
  for (std::size_t row = 0; row < w.count; row += kGroup) {
    const Asked asked = ask(from, w, row);
    Group r = load(sum.r + row) + factor[0][0];
    Group g = load(sum.g + row) + factor[0][1];
    Group b = load(sum.b + row) + factor[0][2];
    const auto add = [&](const Group& height, const Vector& of) SHEEN_INLINE_LAMBDA {
      r += height * of[0];
      g += height * of[1];
      b += height * of[2];
    };
    if (model.base_terms == sparse::kLinearBase) {
      add(asked.u, factor[1]);
      add(asked.v, factor[2]);
      add(asked.height, factor[3]);
    }
    for (std::size_t rbf = 0; rbf < model.rbf_count; ++rbf) {
      add(wendland(dictionary[model.atom[rbf]], asked.u, asked.v), factor[model.base_terms + rbf]);
    }
    store(r, sum.r + row);
    store(g, sum.g + row);
    store(b, sum.b + row);
  }
}

}  // namespace sheen::fitting::detail
