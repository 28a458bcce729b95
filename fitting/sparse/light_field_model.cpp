// SPDX-License-Identifier: MIT
#include "fitting/sparse/light_field_model.h"

#include "core/geometry/disc_map.h"
#include "fitting/iwls/wendland.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace sheen::fitting::sparse {
namespace {

constexpr float kLargestHalf = 65504.0f;
// Blocks grow in steps of this many terms, so that a patch that wins and loses a RBF stays put.
constexpr std::size_t kBlockTerms = 4;

template <typename Colour>
Eigen::Vector3f as_floats(const Colour& colour) {
  return {static_cast<float>(colour[0]), static_cast<float>(colour[1]),
          static_cast<float>(colour[2])};
}

}  // namespace

LightFieldModel::LightFieldModel(std::size_t patch_count)
    : slots_(patch_count), observed_(patch_count, 0) {
  for (Slot& slot : slots_) slot.constant.fill(Eigen::half(0.5f));
}

WeightedColour LightFieldModel::evaluate(std::size_t patch_idx, const Eigen::Vector2f& uv) const {
  const float weight = observed_[patch_idx] != 0 ? 1.0f : kUnseenWeight;
  return {weight * colour(patch_idx, uv), weight};
}

// As sparse::evaluate, on what is stored: predictions of samples need nothing unpacked.
Eigen::Vector3f LightFieldModel::colour(std::size_t patch_idx, const Eigen::Vector2f& uv) const {
  const Slot& slot = slots_[patch_idx];
  Eigen::Vector3f sum = as_floats(slot.constant);
  const std::size_t further = base_terms(slot) + rbf_count(slot) - 1;
  if (further == 0) return sum;
  const Eigen::Vector3f direction = core::hemisphere_from_disc(uv);
  const std::span<const Atom> dictionary = atoms();
  std::size_t term = 0;
  for (; term + 1 < base_terms(slot); ++term) {
    sum += direction[static_cast<Eigen::Index>(term)] * as_floats(slot.further[term].colour);
  }
  for (; term < further; ++term) {
    const Atom& atom = dictionary[slot.further[term].atom];
    const float squared = (direction.head<2>() - atom.center).squaredNorm();
    if (squared >= atom.support * atom.support) continue;
    sum += iwls::wendland(std::sqrt(squared) / atom.support) * as_floats(slot.further[term].colour);
  }
  return sum;
}

Eigen::Vector3f LightFieldModel::mean_colour(std::size_t patch_idx) const {
  return disc_mean(patch(patch_idx)).cwiseMax(0.0f).cwiseMin(1.0f);
}

std::size_t LightFieldModel::coefficient_count() const {
  std::size_t count = 0;
  for (const Slot& slot : slots_) count += 3 * base_terms(slot) + 4 * rbf_count(slot);
  return count;
}

PatchModel LightFieldModel::patch(std::size_t patch_idx) const {
  const Slot& slot = slots_[patch_idx];
  PatchModel model;
  model.base_terms = base_terms(slot);
  model.rbf_count = rbf_count(slot);
  model.coefficient[0] = as_floats(slot.constant);
  for (std::size_t term = 1; term < model.term_count(); ++term) {
    const Term& stored = slot.further[term - 1];
    model.coefficient[term] = as_floats(stored.colour);
    if (term >= model.base_terms) {
      model.atom[term - model.base_terms] = stored.atom;
    }
  }
  return model;
}

std::size_t LightFieldModel::term_count(std::size_t patch_idx) const {
  return base_terms(slots_[patch_idx]) + rbf_count(slots_[patch_idx]);
}

bool LightFieldModel::store(std::size_t patch_idx, const PatchModel& model) {
  assert(model.base_terms == kConstantBase || model.base_terms == kLinearBase);
  assert(model.rbf_count <= kMaxRbfs);
  // Make room.
  Slot& slot = slots_[patch_idx];
  const std::size_t terms = model.term_count();
  reserve(slot, terms - 1);
  // Write what differs.
  const auto shape = static_cast<std::uint8_t>(model.rbf_count |
                                               (model.base_terms == kLinearBase ? kLinearBit : 0u));
  bool changed = std::exchange(slot.shape, shape) != shape;
  changed |= replace(slot.constant, rounded(model.coefficient[0]));
  for (std::size_t term = 1; term < terms; ++term) {
    Term& place = slot.further[term - 1];
    const std::uint16_t atom =
        term < model.base_terms ? std::uint16_t{0} : model.atom[term - model.base_terms];
    assert(atom < atoms().size());
    changed |= std::exchange(place.atom, atom) != atom;
    changed |= replace(place.colour, rounded(model.coefficient[term]));
  }
  return changed;
}

bool LightFieldModel::follow_mean(std::size_t patch_idx, const Eigen::Vector3f& rgb,
                                  std::size_t count) {
  Slot& slot = slots_[patch_idx];
  if (slot.shape != 0) return false;
  const Eigen::Vector3f mean = as_floats(slot.constant);
  return replace(slot.constant, rounded(mean + (rgb - mean) / static_cast<float>(count)));
}

bool LightFieldModel::store_observed(std::size_t patch_idx, bool observed) {
  const std::uint8_t flag = observed ? 1 : 0;
  return std::exchange(observed_[patch_idx], flag) != flag;
}

LightFieldModel::StoredColour LightFieldModel::rounded(const Eigen::Vector3f& colour) {
  assert(colour.allFinite());
  StoredColour result;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    result[channel] = Eigen::half(
        std::clamp(colour[static_cast<Eigen::Index>(channel)], -kLargestHalf, kLargestHalf));
  }
  return result;
}

bool LightFieldModel::replace(StoredColour& place, const StoredColour& value) {
  bool changed = false;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    changed |= place[channel].x != value[channel].x;
    place[channel] = value[channel];
  }
  return changed;
}

std::size_t LightFieldModel::base_terms(const Slot& slot) {
  return (slot.shape & kLinearBit) != 0 ? kLinearBase : kConstantBase;
}

std::size_t LightFieldModel::rbf_count(const Slot& slot) {
  return slot.shape & static_cast<std::uint8_t>(~kLinearBit);
}

void LightFieldModel::reserve(Slot& slot, std::size_t further_terms) {
  if (further_terms <= slot.capacity) return;
  const std::size_t capacity = (further_terms + kBlockTerms - 1) / kBlockTerms * kBlockTerms;
  auto block = std::make_unique<Term[]>(capacity);
  std::copy_n(slot.further.get(), slot.capacity, block.get());
  slot.further = std::move(block);
  slot.capacity = static_cast<std::uint8_t>(capacity);
}

}  // namespace sheen::fitting::sparse
