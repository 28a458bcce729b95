// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/sparse/light_field_model.h"

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace sheen::fitting::testing {

/// A patch with a random base, distinct atoms and at most `most_rbfs` RBFs: constant in
/// [0.3, 0.7], the others in [-0.2, 0.2].
inline sparse::PatchModel random_patch(std::mt19937& random, std::size_t most_rbfs) {
  const auto between = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random()) / 4294967296.0f;
  };
  std::vector<std::uint16_t> ids(sparse::atoms().size());
  std::iota(ids.begin(), ids.end(), std::uint16_t{0});
  std::shuffle(ids.begin(), ids.end(), random);
  sparse::PatchModel patch;
  patch.base_terms = random() % 2 == 0 ? sparse::kConstantBase : sparse::kLinearBase;
  patch.rbf_count = random() % (most_rbfs + 1);
  std::copy_n(ids.begin(), patch.rbf_count, patch.atom.begin());
  for (std::size_t term = 0; term < patch.term_count(); ++term) {
    for (float& channel : patch.coefficient[term]) {
      channel = term == 0 ? between(0.3f, 0.7f) : between(-0.2f, 0.2f);
    }
  }
  return patch;
}

/// Random patches; every `unseen_every`-th is unobserved (0: none).
inline sparse::LightFieldModel random_sparse(std::size_t patch_count, std::size_t most_rbfs,
                                             std::size_t unseen_every, unsigned seed) {
  std::mt19937 random(seed);
  sparse::LightFieldModel model(patch_count);
  for (std::size_t i = 0; i < patch_count; ++i) {
    model.store(i, random_patch(random, most_rbfs));
    model.store_observed(i, unseen_every == 0 || i % unseen_every != 0);
  }
  return model;
}

}  // namespace sheen::fitting::testing
