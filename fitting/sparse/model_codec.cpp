// SPDX-License-Identifier: MIT
#include "fitting/sparse/model_codec.h"

#include <bitset>
#include <cstring>
#include <utility>

namespace sheen::fitting::sparse {
namespace {

using nlohmann::json;

constexpr std::uint8_t kLinearBit = 0x80;

struct PackedArrays {
  std::vector<std::uint8_t> shapes;
  std::vector<std::uint16_t> rbfs;
  std::vector<Eigen::half> coefficients;
};

json atoms_as_json() {
  json list = json::array();
  for (const Atom& atom : atoms()) {
    list.push_back({static_cast<double>(atom.center.x()), static_cast<double>(atom.center.y()),
                    static_cast<double>(atom.support)});
  }
  return list;
}

/// Terms that a patch has in the file.
std::size_t stored_terms(const PatchModel& patch, SingleColours single_colours) {
  const bool is_zero = single_colours == SingleColours::zero && patch.term_count() == 1;
  return is_zero ? 0 : patch.term_count();
}

void pack(const PatchModel& patch, SingleColours single_colours, PackedArrays& packed) {
  packed.shapes.push_back(static_cast<std::uint8_t>(
      patch.rbf_count | (patch.base_terms == kLinearBase ? kLinearBit : 0u)));
  for (std::size_t i = 0; i < patch.rbf_count; ++i) packed.rbfs.push_back(patch.atom[i]);
  for (std::size_t term = 0; term < stored_terms(patch, single_colours); ++term) {
    for (const float channel : patch.coefficient[term]) {
      packed.coefficients.emplace_back(channel);
    }
  }
}

// Shape of one patch, without atoms and coefficients.
PatchModel shape_from(std::byte code) {
  const auto value = std::to_integer<std::uint8_t>(code);
  PatchModel patch;
  patch.base_terms = (value & kLinearBit) != 0 ? kLinearBase : kConstantBase;
  patch.rbf_count = value & static_cast<std::uint8_t>(~kLinearBit);
  if (patch.rbf_count > kMaxRbfs) throw ModelFault("a patch has more RBFs than sheen allows");
  return patch;
}

void read_atoms(std::span<const std::byte> codes, PatchModel& patch) {
  std::bitset<kMaxAtoms> seen;
  for (std::size_t i = 0; i < patch.rbf_count; ++i) {
    std::uint16_t id = 0;
    std::memcpy(&id, codes.data() + 2 * i, sizeof id);
    if (id >= atoms().size()) throw ModelFault("a RBF names an atom that does not exist");
    if (seen[id]) throw ModelFault("a patch has two RBFs of the same atom");
    seen.set(id);
    patch.atom[i] = id;
  }
}

void read_coefficients(std::span<const Eigen::half> values, PatchModel& patch) {
  patch.coefficient[0].setZero();
  for (std::size_t term = 0; 3 * term < values.size(); ++term) {
    patch.coefficient[term] = {static_cast<float>(values[3 * term]),
                               static_cast<float>(values[3 * term + 1]),
                               static_cast<float>(values[3 * term + 2])};
  }
}

}  // namespace

ModelPart encode_patches(const LightFieldModel& model, SingleColours single_colours) {
  const auto packed = std::make_shared<PackedArrays>();
  packed->shapes.reserve(model.patch_count());
  for (std::size_t i = 0; i < model.patch_count(); ++i)
    pack(model.patch(i), single_colours, *packed);
  ModelPart part;
  part.observed = std::as_bytes(std::span(model.observed()));
  part.parameters = {{"atoms", atoms_as_json()}};
  part.arrays["shapes"] = std::as_bytes(std::span(packed->shapes));
  // glTF knows no empty bufferView.
  if (!packed->rbfs.empty()) part.arrays["bumps"] = std::as_bytes(std::span(packed->rbfs));
  if (!packed->coefficients.empty()) {
    part.arrays["coefficients"] = std::as_bytes(std::span(packed->coefficients));
  }
  part.owner = packed;
  return part;
}

LightFieldModel decode_patches(const ModelPart& part, std::span<const std::uint8_t> observed,
                               SingleColours single_colours) {
  if (required(part.parameters, "atoms") != atoms_as_json()) {
    throw ModelFault("its \"atoms\" are not those of this version of sheen");
  }
  // Count first: the shapes say how long the other arrays must be.
  const auto shapes = required_bytes(part, "shapes", observed.size());
  std::size_t rbf_count = 0;
  std::size_t term_count = 0;
  for (const std::byte code : shapes) {
    const PatchModel patch = shape_from(code);
    rbf_count += patch.rbf_count;
    term_count += stored_terms(patch, single_colours);
  }
  const auto rbfs =
      rbf_count > 0 ? required_bytes(part, "bumps", 2 * rbf_count) : std::span<const std::byte>();
  const std::vector<Eigen::half> coefficients =
      term_count > 0 ? required_halves(part, "coefficients", 3 * term_count)
                     : std::vector<Eigen::half>();
  // Take the patches out one after the other.
  LightFieldModel model(observed.size());
  std::size_t rbf = 0;
  std::size_t term = 0;
  for (std::size_t i = 0; i < observed.size(); ++i) {
    PatchModel patch = shape_from(shapes[i]);
    read_atoms(rbfs.subspan(2 * rbf, 2 * patch.rbf_count), patch);
    const std::size_t terms = stored_terms(patch, single_colours);
    read_coefficients(std::span(coefficients).subspan(3 * term, 3 * terms), patch);
    model.store(i, patch);
    model.store_observed(i, observed[i] != 0);
    rbf += patch.rbf_count;
    term += terms;
  }
  return model;
}

ModelPart encode_model(const LightField& light_field) {
  return encode_patches(dynamic_cast<const LightFieldModel&>(light_field), SingleColours::stored);
}

std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh) {
  return std::make_unique<LightFieldModel>(
      decode_patches(part, required_observed(part, mesh.positions.size()), SingleColours::stored));
}

}  // namespace sheen::fitting::sparse
