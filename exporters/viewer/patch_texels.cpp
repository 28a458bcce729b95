// SPDX-License-Identifier: MIT
#include "exporters/viewer/patch_texels.h"

#include "core/diagnostics/error.h"
#include "fitting/detail/detail_light_field.h"
#include "fitting/half.h"
#include "fitting/iwls/light_field_model.h"
#include "fitting/mean/mean_light_field.h"
#include "fitting/sparse/light_field_model.h"
#include "fitting/spherical_harmonics/light_field_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace sheen::exporters::viewer {
namespace {

/// Coefficients are rounded to multiples of this, sRGB. A rounding error is even within half a
/// step: 0.0003 root mean square, so that ten of them add 0.001 to an error that is seldom below
/// 0.01.
constexpr double kFinestStep = 1.0 / 1024.0;
constexpr int kLargest = std::numeric_limits<std::int16_t>::max();
/// Weights of patches are multiples of that of a patch nobody saw.
constexpr double kWeightStep = static_cast<double>(fitting::kUnseenWeight);

/// The step for coefficients up to `largest`; coarser than the finest one where they would not fit.
double step_for(float largest) {
  return std::max(kFinestStep, static_cast<double>(largest) / kLargest);
}

double step_for(std::span<const Eigen::half> values) {
  float largest = 0;
  for (const Eigen::half value : values)
    largest = std::max(largest, std::abs(static_cast<float>(value)));
  return step_for(largest);
}

std::int16_t in_steps(float value, double step) {
  const long steps = std::lround(static_cast<double>(value) / step);
  return static_cast<std::int16_t>(std::clamp<long>(steps, -kLargest, kLargest));
}

float rounded(float value, double step) {
  return static_cast<float>(in_steps(value, step) * step);
}

std::vector<Eigen::half> rounded(std::span<const Eigen::half> values, double step) {
  std::vector<Eigen::half> result;
  result.reserve(values.size());
  for (const Eigen::half value : values)
    result.emplace_back(rounded(static_cast<float>(value), step));
  return result;
}

std::int16_t weight_in_steps(bool observed) {
  return static_cast<std::int16_t>(std::lround((observed ? 1.0 : kWeightStep) / kWeightStep));
}

// A list of colours per patch, and its weight in the fourth place of the first (mean and
// harmonics).
PatchTexels colour_texels(std::span<const Eigen::half> colours,
                          const std::vector<std::uint8_t>& observed) {
  PatchTexels texels;
  texels.step = step_for(colours);
  texels.last_step = kWeightStep;
  texels.texels_per_patch = colours.size() / 3 / observed.size();
  texels.values.resize(4 * colours.size() / 3, 0);
  for (std::size_t i = 0; i < colours.size(); ++i) {
    texels.values[i / 3 * 4 + i % 3] = in_steps(static_cast<float>(colours[i]), texels.step);
  }
  for (std::size_t patch = 0; patch < observed.size(); ++patch) {
    texels.values[4 * texels.texels_per_patch * patch + 3] = weight_in_steps(observed[patch] != 0);
  }
  return texels;
}

PatchTexels mean_texels(const core::Mesh& /*mesh*/, const fitting::LightField& light_field) {
  const auto& model = dynamic_cast<const fitting::mean::MeanLightField&>(light_field);
  PatchTexels texels = colour_texels(model.coefficients(), model.observed());
  texels.shader = {{"shader", "mean"}};
  texels.rounded = std::make_unique<fitting::mean::MeanLightField>(
      rounded(model.coefficients(), texels.step), model.observed());
  return texels;
}

PatchTexels harmonics_texels(const core::Mesh& /*mesh*/, const fitting::LightField& light_field) {
  using fitting::spherical_harmonics::LightFieldModel;
  const auto& model = dynamic_cast<const LightFieldModel&>(light_field);
  PatchTexels texels = colour_texels(model.coefficients(), model.observed());
  texels.shader = {{"shader", "harmonics"}};
  texels.rounded = std::make_unique<LightFieldModel>(
      model.degree(), rounded(model.coefficients(), texels.step), model.observed());
  return texels;
}

PatchTexels iwls_texels(const core::Mesh& /*mesh*/, const fitting::LightField& light_field) {
  using fitting::iwls::LightFieldModel;
  const auto& model = dynamic_cast<const LightFieldModel&>(light_field);
  PatchTexels texels;
  texels.step = texels.last_step = step_for(model.coefficients());
  texels.texels_per_patch = 1 + model.coefficients_per_patch() / 4;
  texels.values.reserve(4 * texels.texels_per_patch * model.patch_count());
  for (std::size_t patch = 0; patch < model.patch_count(); ++patch) {
    // The weight stands in a texel of its own, in units of that of a patch nobody saw.
    texels.values.insert(texels.values.end(), 4, weight_in_steps(model.observed()[patch] != 0));
    for (const Eigen::half value : model.coefficients(patch)) {
      texels.values.push_back(in_steps(static_cast<float>(value), texels.step));
    }
  }
  nlohmann::json centers = nlohmann::json::array();
  for (std::size_t i = 0; i < model.slots_u().size(); ++i) {
    centers.push_back(
        {static_cast<double>(model.slots_u()[i]), static_cast<double>(model.slots_v()[i])});
  }
  texels.shader = {{"shader", "iwls"},
                   {"terms", model.shape().terms},
                   {"supportRadius", static_cast<double>(model.shape().support_radius)},
                   {"centers", std::move(centers)}};
  texels.rounded = std::make_unique<LightFieldModel>(
      model.shape(), rounded(model.coefficients_by_center(), texels.step), model.observed());
  return texels;
}

using SparseModel = fitting::sparse::LightFieldModel;
using fitting::sparse::kLinearBase;
using fitting::sparse::PatchModel;

float largest_coefficient(const SparseModel& model) {
  float largest = 0;
  for (std::size_t i = 0; i < model.patch_count(); ++i) {
    const PatchModel patch = model.patch(i);
    for (std::size_t term = 0; term < patch.term_count(); ++term) {
      largest = std::max(largest, patch.coefficient[term].cwiseAbs().maxCoeff());
    }
  }
  return largest;
}

/// RBFs by the number of their atom: their order means nothing, and neighbours' lists look alike.
PatchModel in_order(const PatchModel& patch) {
  std::vector<std::size_t> order(patch.rbf_count);
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, {}, [&](std::size_t i) { return patch.atom[i]; });
  PatchModel result = patch;
  for (std::size_t i = 0; i < order.size(); ++i) {
    result.atom[i] = patch.atom[order[i]];
    result.coefficient[patch.base_terms + i] = patch.coefficient[patch.base_terms + order[i]];
  }
  return result;
}

// As render/sparse/sparse.glsl reads a patch.
void write_patch(const PatchModel& patch, bool observed, double step, std::int16_t* texels) {
  constexpr int linear_flag = 32;
  constexpr int observed_flag = 64;
  for (std::size_t term = 0; term < patch.term_count(); ++term) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      texels[4 * term + channel] =
          in_steps(patch.coefficient[term][static_cast<Eigen::Index>(channel)], step);
    }
    if (term >= patch.base_terms) {
      texels[4 * term + 3] = static_cast<std::int16_t>(patch.atom[term - patch.base_terms]);
    }
  }
  texels[3] = static_cast<std::int16_t>(static_cast<int>(patch.rbf_count) +
                                        (patch.base_terms == kLinearBase ? linear_flag : 0) +
                                        (observed ? observed_flag : 0));
}

nlohmann::json sparse_shader() {
  nlohmann::json atoms = nlohmann::json::array();
  for (const fitting::sparse::Atom& atom : fitting::sparse::atoms()) {
    atoms.push_back({static_cast<double>(atom.center.x()), static_cast<double>(atom.center.y()),
                     static_cast<double>(atom.support)});
  }
  return {{"shader", "sparse"}, {"atoms", std::move(atoms)}};
}

std::pair<PatchTexels, SparseModel> rounded_patches(const SparseModel& model) {
  PatchTexels texels;
  texels.step = step_for(largest_coefficient(model));
  for (std::size_t i = 0; i < model.patch_count(); ++i) {
    texels.texels_per_patch = std::max(texels.texels_per_patch, model.term_count(i));
  }
  texels.values.resize(4 * texels.texels_per_patch * model.patch_count(), 0);
  texels.shader = sparse_shader();
  SparseModel rounded_model(model.patch_count());
  for (std::size_t i = 0; i < model.patch_count(); ++i) {
    PatchModel patch = in_order(model.patch(i));
    const bool observed = model.observed()[i] != 0;
    write_patch(patch, observed, texels.step, &texels.values[4 * texels.texels_per_patch * i]);
    for (std::size_t term = 0; term < patch.term_count(); ++term) {
      for (float& channel : patch.coefficient[term]) channel = rounded(channel, texels.step);
    }
    rounded_model.store(i, patch);
    rounded_model.store_observed(i, observed);
  }
  return {std::move(texels), std::move(rounded_model)};
}

PatchTexels sparse_texels(const core::Mesh& /*mesh*/, const fitting::LightField& light_field) {
  auto [texels, model] = rounded_patches(dynamic_cast<const SparseModel&>(light_field));
  texels.rounded = std::make_unique<SparseModel>(std::move(model));
  return std::move(texels);
}

using fitting::detail::AnchoredOffsets;

/// What every vertex blends, level after level.
void add_blends(const core::Mesh& mesh, const AnchoredOffsets& anchors, AnchorTexels& texels) {
  constexpr float weight_steps = 65535.0f;
  constexpr std::size_t per_level = fitting::detail::kMostBlended;
  texels.blended_per_vertex = per_level * anchors.levels().size();
  texels.blended.assign(texels.blended_per_vertex * mesh.positions.size(), 0);
  texels.weights = texels.blended;
  for (std::size_t level = 0; level < anchors.levels().size(); ++level) {
    const auto& [vertices, spacing_m] = anchors.levels()[level];
    texels.vertices.insert(texels.vertices.end(), vertices.begin(), vertices.end());
    const auto blends = fitting::detail::blend_anchors(mesh, vertices, spacing_m);
    for (std::size_t vertex = 0; vertex < blends.size(); ++vertex) {
      for (std::size_t i = 0; i < per_level && blends[vertex].weight[i] > 0.0f; ++i) {
        const std::size_t at = vertex * texels.blended_per_vertex + per_level * level + i;
        texels.blended[at] =
            static_cast<std::int32_t>(anchors.first_of(level) + blends[vertex].anchor[i]);
        texels.weights[at] =
            static_cast<std::int32_t>(std::lround(weight_steps * blends[vertex].weight[i]));
      }
    }
  }
}

std::pair<std::unique_ptr<const AnchorTexels>, std::shared_ptr<const AnchoredOffsets>>
anchor_texels(const core::Mesh& mesh, const AnchoredOffsets& anchors) {
  auto [patches, rounded_models] = rounded_patches(anchors.models());
  auto texels = std::make_unique<AnchorTexels>();
  texels->texels_per_anchor = patches.texels_per_patch;
  texels->values = std::move(patches.values);
  texels->step = patches.step;
  texels->mirrored = anchors.asked() == fitting::detail::AskedDirection::mirrored;
  add_blends(mesh, anchors, *texels);
  return {std::move(texels),
          std::make_shared<const AnchoredOffsets>(mesh, anchors.levels(), anchors.asked(),
                                                  std::move(rounded_models))};
}

PatchTexels detail_texels(const core::Mesh& mesh, const fitting::LightField& light_field) {
  using fitting::detail::DetailLightField;
  const auto& detail = dynamic_cast<const DetailLightField&>(light_field);
  auto [texels, offsets] = rounded_patches(detail.offsets());
  auto rounded_model =
      std::make_unique<DetailLightField>(mesh, detail.texture(), std::move(offsets));
  if (detail.anchors()) {
    auto [anchors, rounded_anchors] = anchor_texels(mesh, *detail.anchors());
    texels.anchors = std::move(anchors);
    rounded_model->set_anchors(std::move(rounded_anchors));
  }
  texels.rounded = std::move(rounded_model);
  return std::move(texels);
}

using MakeTexels = PatchTexels (*)(const core::Mesh&, const fitting::LightField&);

/// One line per representation.
constexpr std::pair<std::string_view, MakeTexels> kTexels[] = {
    {"detail", detail_texels}, {"iwls", iwls_texels},     {"mean", mean_texels},
    {"sh", harmonics_texels},  {"sparse", sparse_texels},
};

}  // namespace

PatchTexels patch_texels(const core::Mesh& mesh, const fitting::LightField& light_field) {
  for (const auto& [name, make] : kTexels) {
    if (name == light_field.representation()) return make(mesh, light_field);
  }
  throw core::bad_input("representation " + std::string(light_field.representation()),
                        "cannot be shown in the web viewer",
                        "fit with --representation sparse, detail, iwls, sh or mean");
}

}  // namespace sheen::exporters::viewer
