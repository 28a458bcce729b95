// SPDX-License-Identifier: MIT
#include "exporters/usd/usd_format.h"

#include "core/files/write_file.h"
#include "exporters/linear_colour.h"
#include "exporters/surface/mean_texture.h"
#include "exporters/surface/vertex_confidence.h"
#include "exporters/upright.h"

#include <fmt/format.h>

#include <iterator>

namespace sheen::exporters::usd {
namespace {

constexpr std::string_view kEndings[] = {".usda"};

void add_vectors(std::string& text, const std::vector<Eigen::Vector3f>& vectors) {
  text += '[';
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    const Eigen::Vector3f& v = vectors[i];
    fmt::format_to(std::back_inserter(text), "{}({:.9g}, {:.9g}, {:.9g})", i == 0 ? "" : ", ",
                   v.x(), v.y(), v.z());
  }
  text += ']';
}

std::vector<Eigen::Vector3f> linear(std::vector<Eigen::Vector3f> colours) {
  for (Eigen::Vector3f& colour : colours) colour = colour.unaryExpr(&linear_from_srgb);
  return colours;
}

void add_confidence(std::string& text, const std::vector<core::VertexConfidence>& confidence) {
  if (confidence.empty()) return;
  text += "        float[] primvars:confidence = [";
  for (std::size_t i = 0; i < confidence.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{}{:.3f}", i == 0 ? "" : ", ", confidence[i].mean);
  }
  text += "] (\n            interpolation = \"vertex\"\n        )\n";
}

std::string usd_text(const core::Mesh& mesh, const std::vector<Eigen::Vector3f>& colours,
                     const std::vector<core::VertexConfidence>& confidence) {
  std::string text = R"(#usda 1.0
(
    defaultPrim = "Object"
    metersPerUnit = 1
    upAxis = "Y"
)

def Xform "Object" (
    kind = "component"
)
{
)";
  const auto out = std::back_inserter(text);
  if (!mesh.offset.isZero()) {
    fmt::format_to(out,
                   "    double3 xformOp:translate = ({:.17g}, {:.17g}, {:.17g})\n"
                   "    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n",
                   mesh.offset.x(), mesh.offset.y(), mesh.offset.z());
  }
  text += "    def Mesh \"Surface\"\n    {\n        int[] faceVertexCounts = [";
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) text += t == 0 ? "3" : ", 3";
  text += "]\n        int[] faceVertexIndices = [";
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    fmt::format_to(out, "{}{}, {}, {}", t == 0 ? "" : ", ", corners[0], corners[1], corners[2]);
  }
  text += "]\n        normal3f[] normals = ";
  add_vectors(text, mesh.normals);
  text += " (\n            interpolation = \"vertex\"\n        )\n        point3f[] points = ";
  add_vectors(text, mesh.positions);
  text += "\n        color3f[] primvars:displayColor = ";
  add_vectors(text, linear(colours));
  text += " (\n            interpolation = \"vertex\"\n        )\n";
  add_confidence(text, confidence);
  text += "        uniform token subdivisionScheme = \"none\"\n    }\n}\n";
  return text;
}

Written write(const fitting::Model& model, const std::filesystem::path& path,
              const fitting::FitOptions& options) {
  const auto& up = fitting::options_as<UprightOptions>(options).up;
  const auto colours = model.light_field->vertex_colours(model.mesh);
  core::write_file(
      path, usd_text(turned(model.mesh, y_up_from_object(up)), colours, vertex_confidence(model)));
  return {.files = {path}, .as_read = coloured_model(model, colours), .remarks = {}};
}

}  // namespace

constinit const Format kFormat{.name = "USD mesh",
                               .endings = kEndings,
                               .sentence = "Universal Scene Description: mesh with displayColor",
                               .default_options = fitting::new_options<UprightOptions>,
                               .write = write};

}  // namespace sheen::exporters::usd
