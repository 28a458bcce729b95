// SPDX-License-Identifier: MIT
#include "fitting/sparse/model_codec.h"

#include "fitting/sparse/light_field_model.h"

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

void pack(const PatchModel& patch, PackedArrays& packed) {
  packed.shapes.push_back(static_cast<std::uint8_t>(
      patch.rbf_count | (patch.base_terms == kLinearBase ? kLinearBit : 0u)));
  for (std::size_t i = 0; i < patch.rbf_count; ++i) packed.rbfs.push_back(patch.atom[i]);
  for (std::size_t term = 0; term < patch.term_count(); ++term) {
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
  for (std::size_t term = 0; term < patch.term_count(); ++term) {
    patch.coefficient[term] = {static_cast<float>(values[3 * term]),
                               static_cast<float>(values[3 * term + 1]),
                               static_cast<float>(values[3 * term + 2])};
  }
}

}  // namespace

ModelPart encode_model(const LightField& light_field) {
  const auto& model = dynamic_cast<const LightFieldModel&>(light_field);
  const auto packed = std::make_shared<PackedArrays>();
  packed->shapes.reserve(model.patch_count());
  for (std::size_t i = 0; i < model.patch_count(); ++i) pack(model.patch(i), *packed);
  ModelPart part;
  part.observed = std::as_bytes(std::span(model.observed()));
  part.parameters = {{"atoms", atoms_as_json()}};
  part.arrays["shapes"] = std::as_bytes(std::span(packed->shapes));
  // glTF knows no empty bufferView.
  if (!packed->rbfs.empty()) part.arrays["bumps"] = std::as_bytes(std::span(packed->rbfs));
  part.arrays["coefficients"] = std::as_bytes(std::span(packed->coefficients));
  part.owner = packed;
  return part;
}

std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh) {
  auto observed = required_observed(part, mesh.positions.size());
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
    term_count += patch.term_count();
  }
  const auto rbfs =
      rbf_count > 0 ? required_bytes(part, "bumps", 2 * rbf_count) : std::span<const std::byte>();
  const std::vector<Eigen::half> coefficients =
      required_halves(part, "coefficients", 3 * term_count);
  // Take the patches out one after the other.
  auto model = std::make_unique<LightFieldModel>(observed.size());
  std::size_t rbf = 0;
  std::size_t term = 0;
  for (std::size_t i = 0; i < observed.size(); ++i) {
    PatchModel patch = shape_from(shapes[i]);
    read_atoms(rbfs.subspan(2 * rbf, 2 * patch.rbf_count), patch);
    read_coefficients(std::span(coefficients).subspan(3 * term, 3 * patch.term_count()), patch);
    model->store(i, patch);
    model->store_observed(i, observed[i] != 0);
    rbf += patch.rbf_count;
    term += patch.term_count();
  }
  return model;
}

}  // namespace sheen::fitting::sparse
