// SPDX-License-Identifier: MIT
#include "fitting/depth_quads/model_codec.h"

#include "fitting/depth_quads/depth_quads.h"
#include "fitting/kept_views/view_codec.h"
#include "fitting/mean/model_codec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace sheen::fitting::depth_quads {
namespace {

using DepthRange = std::array<float, 2>;

struct PackedQuads {
  std::shared_ptr<const void> views;
  std::vector<DepthRange> ranges;
  std::vector<std::uint16_t> codes;
};

constexpr const char* kWeighted = "weighted";
constexpr const char* kHard = "hard";

int small_number(const ModelPart& part, const char* name) {
  constexpr std::size_t most = 1000;
  return static_cast<int>(std::min(required_size(part.parameters, name), most));
}

Options options_from(const ModelPart& part, int cache_mb) {
  const std::string blending = required_string(part.parameters, "blending");
  if (blending != kWeighted && blending != kHard) throw ModelFault("its blending is unknown");
  Options options;
  options.spacing_px = small_number(part, "spacing");
  options.levels = small_number(part, "levels");
  options.enlargement = required_number(part.parameters, "enlargement");
  options.cameras = small_number(part, "camerasDrawn");
  options.blending = blending == kHard ? Blending::hard : Blending::weighted;
  options.views.cache_mb = cache_mb;
  try {
    options.check();
  } catch (const std::invalid_argument& fault) {
    throw ModelFault(std::string("its ") + fault.what());
  }
  return options;
}

std::size_t cell_count(const KeptView& view, const Options& options) {
  std::size_t count = 0;
  for (const QuadLevel& level : quad_levels(view.crop.size(), options.spacing_px, options.levels)) {
    count += level.size();
  }
  return count;
}

QuadDepths depths_from(const DepthRange& range, std::span<const std::byte> bytes) {
  if (!(range[0] > 0.0f && range[1] >= range[0] && std::isfinite(range[1]))) {
    throw ModelFault("the depths of a view have no range");
  }
  QuadDepths depths{range[0], range[1], {}};
  depths.codes.resize(bytes.size() / sizeof(std::uint16_t));
  std::memcpy(depths.codes.data(), bytes.data(), bytes.size());
  return depths;
}

}  // namespace

ModelPart encode_model(const LightField& light_field) {
  const auto& model = dynamic_cast<const DepthQuads&>(light_field);
  const Options& options = model.options();
  ModelPart part = mean::encode_model(model.means());
  encode_views(model.photographs(), options.views.cache_mb, part);
  const auto packed = std::make_shared<PackedQuads>();
  for (std::size_t i = 0; i < model.element_count(); ++i) {
    const QuadDepths& depths = model.quads(i).depths;
    packed->ranges.push_back({depths.nearest_m, depths.farthest_m});
    packed->codes.insert(packed->codes.end(), depths.codes.begin(), depths.codes.end());
  }
  part.parameters["spacing"] = static_cast<unsigned>(options.spacing_px);
  part.parameters["levels"] = static_cast<unsigned>(options.levels);
  part.parameters["enlargement"] = options.enlargement;
  part.parameters["camerasDrawn"] = static_cast<unsigned>(options.cameras);
  part.parameters["blending"] = options.blending == Blending::hard ? kHard : kWeighted;
  if (!packed->codes.empty()) {
    part.arrays["depthRanges"] = std::as_bytes(std::span(packed->ranges));
    part.arrays["depths"] = std::as_bytes(std::span(packed->codes));
  }
  packed->views = std::move(part.owner);
  part.owner = packed;
  return part;
}

std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh) {
  const auto means = mean::decode_model(part, mesh);
  DecodedViews decoded = decode_views(part);
  const Options options = options_from(part, decoded.cache_mb);
  auto model = std::make_unique<DepthQuads>(options, mesh.positions.size());
  model->set_means(dynamic_cast<const mean::MeanLightField&>(*means));
  if (decoded.views.empty()) return model;

  std::vector<DepthRange> ranges(decoded.views.size());
  const auto range_bytes = required_bytes(part, "depthRanges", ranges.size() * sizeof(DepthRange));
  std::memcpy(ranges.data(), range_bytes.data(), range_bytes.size());
  std::size_t cells = 0;
  for (const KeptView& view : decoded.views) cells += cell_count(view, options);
  auto codes = required_bytes(part, "depths", cells * sizeof(std::uint16_t));
  for (std::size_t i = 0; i < decoded.views.size(); ++i) {
    KeptView& view = decoded.views[i];
    const auto own = codes.first(cell_count(view, options) * sizeof(std::uint16_t));
    codes = codes.subspan(own.size());
    model->add(std::move(view), depths_from(ranges[i], own));
  }
  return model;
}

}  // namespace sheen::fitting::depth_quads
