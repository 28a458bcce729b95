// SPDX-License-Identifier: MIT
#include "exporters/viewer/page.h"

#include "core/diagnostics/error.h"
#include "core/files/read_file.h"
#include "core/mesh/bounds.h"
#include "core/text/script_text.h"
#include "exporters/viewer/first_view.h"
#include "exporters/viewer/packed_arrays.h"
#include "exporters/viewer/patch_texels.h"
#include "exporters/viewer/surface_tables.h"
#include "exporters/viewer/web_text.h"
#include "fitting/confidence/confidence.h"
#include "fitting/model_file/texture_image.h"
#include "fitting/patch_light_field.h"
#include "fitting/texture/surface_texture.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

namespace sheen::exporters::viewer {
namespace {

using nlohmann::json;

std::string as_html(std::string_view text) {
  std::string html;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      default:
        html += letter;
    }
  }
  return html;
}

/// Bytes in pieces that the page can count while it is being loaded.
std::string in_pieces(std::string_view bytes, const std::string& kind) {
  constexpr std::size_t piece = 3 * 65536;  // of three, so that each piece can be read on its own
  std::string html;
  for (std::size_t begin = 0; begin < bytes.size(); begin += piece) {
    html += "<script type=\"application/octet-stream\" data-part=\"" + kind + "\">" +
            base64(bytes.substr(begin, piece)) + "</script>\n";
  }
  return html;
}

std::string data_url(std::string_view bytes) {
  return "data:image/png;base64," + base64(bytes);
}

std::string poster_element(const std::filesystem::path& path) {
  if (path.empty()) return {};
  constexpr std::size_t most_bytes = 16u << 20;
  const std::string bytes = core::read_file(path, most_bytes);
  if (!bytes.starts_with("\x89PNG\r\n\x1a\n")) {
    throw core::bad_input(path, "is no PNG", "give --poster a PNG picture");
  }
  return "<img id=\"poster\" alt=\"\" src=\"" + data_url(bytes) + "\">";
}

void add_means(const fitting::PatchLightField& patches, PackedArrays& tables) {
  std::vector<std::int32_t> means;
  for (std::size_t patch = 0; patch < patches.patch_count(); ++patch) {
    for (const float channel : patches.mean_colour(patch)) {
      means.push_back(
          static_cast<std::int32_t>(std::lround(255.0f * std::clamp(channel, 0.0f, 1.0f))));
    }
  }
  tables.add("means", means, 3, 1);
}

void add_confidence(const fitting::SeenDirections& seen, PackedArrays& tables) {
  if (seen.empty()) return;
  std::vector<std::int32_t> cells;
  cells.reserve(seen.size() * fitting::guidance::kCellCount);
  for (const fitting::guidance::DirectionCells patch : seen) {
    const auto values = fitting::confidence_cells(patch);
    cells.insert(cells.end(), values.begin(), values.end());
  }
  tables.add("confidence", cells, fitting::guidance::kCellCount, 1);
}

json add_anchors(const AnchorTexels& anchors, PackedArrays& tables) {
  const std::vector<std::int32_t> values(anchors.values.begin(), anchors.values.end());
  tables.add("anchors", values, 4 * anchors.texels_per_anchor, 2);
  tables.add("anchorVertices", anchors.vertices, 1, 4);
  tables.add("blended", anchors.blended, anchors.blended_per_vertex, 4);
  tables.add("blendWeights", anchors.weights, anchors.blended_per_vertex, 2);
  return {{"texels", anchors.texels_per_anchor},
          {"step", anchors.step},
          {"lastStep", 1},
          {"mirrored", anchors.mirrored}};
}

json size_mm(const core::Mesh& mesh) {
  const Eigen::Vector3f size = 1000 * core::bounds_of(mesh).sizes();
  return {std::lround(size.x()), std::lround(size.y()), std::lround(size.z())};
}

/// The template with each {{NAME}} replaced; texts that are put in are not looked at again.
std::string filled(std::string_view text,
                   const std::vector<std::pair<std::string_view, std::string_view>>& values) {
  std::string result;
  while (true) {
    const std::size_t open = text.find("{{");
    result += text.substr(0, open);
    if (open == std::string_view::npos) return result;
    const std::size_t close = text.find("}}", open);
    const std::string_view name = text.substr(open + 2, close - open - 2);
    for (const auto& [key, value] : values) {
      if (key == name) result += value;
    }
    text.remove_prefix(close + 2);
  }
}

}  // namespace

Page make_page(const fitting::Model& model, const Options& options) {
  // Round.
  const auto& patches = fitting::require_patches(*model.light_field, "the web viewer");
  PatchTexels texels = patch_texels(model.mesh, *model.light_field);
  const fitting::SurfaceTexture* const texture = patches.texture_between_patches();

  // Pack the surface and what lies on it.
  PackedArrays tables;
  std::optional<core::AtlasVertices> split;
  if (texture != nullptr) split = core::split_at_seams(model.mesh, texture->atlas());
  json document;
  document["surface"] = add_surface(model.mesh, split ? &*split : nullptr, tables);
  const std::vector<std::int32_t> values(texels.values.begin(), texels.values.end());
  tables.add("patches", values, 4 * texels.texels_per_patch, 2);
  if (texels.anchors) document["anchors"] = add_anchors(*texels.anchors, tables);
  if (texture == nullptr) add_means(patches, tables);
  add_confidence(model.seen, tables);
  const std::string packed = tables.compressed();
  std::string image;
  if (texture != nullptr) {
    const auto png = fitting::encode_texture(*texture);
    image.assign(png.begin(), png.end());
  }

  // Say what it is.
  const auto& observed = patches.observed();
  document["tables"] = tables.tables();
  document["unpackedBytes"] = tables.unpacked_bytes();
  document["pieces"] = (packed.size() + image.size()) / (3 * 65536) + 1;
  document["patch"] = {
      {"texels", texels.texels_per_patch}, {"step", texels.step}, {"lastStep", texels.last_step}};
  document["patch"].update(texels.shader);
  document["background"] = options.background;
  document["up"] = options.up;
  const FirstView first = first_view(model.mesh, model.seen, options.up);
  document["home"] = {{"azimuth", first.azimuth_rad}, {"elevation", first.elevation_rad}};
  document["facts"] = {{"representation", model.light_field->representation()},
                       {"patches", patches.patch_count()},
                       {"observed", std::count(observed.begin(), observed.end(), std::uint8_t{1})},
                       {"triangles", model.mesh.triangles.size()},
                       {"numbers", model.light_field->coefficient_count()},
                       {"size_mm", size_mm(model.mesh)}};
  if (texture != nullptr) {
    document["facts"]["texture"] = {texture->atlas().width, texture->atlas().height};
  }

  // Fill the page.
  const std::string data = in_pieces(packed, "tables") + in_pieces(image, "texture");
  const std::string title = as_html(options.title);
  const std::string poster = poster_element(options.poster);
  const std::string facts =
      core::in_script(document.dump(-1, ' ', true, json::error_handler_t::replace));
  Page page;
  page.html = filled(web_text("page.html"), {{"TITLE", title},
                                             {"STYLE", web_text("viewer.css")},
                                             {"POSTER", poster},
                                             {"MODEL", facts},
                                             {"SCRIPT", web_text("viewer.js")},
                                             {"DATA", data}});
  page.model.mesh = rounded_surface(model.mesh);
  page.model.light_field = std::move(texels.rounded);
  page.model.seen = model.seen;
  return page;
}

}  // namespace sheen::exporters::viewer
