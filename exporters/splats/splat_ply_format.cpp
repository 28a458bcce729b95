// SPDX-License-Identifier: MIT
#include "exporters/splats/splat_ply_format.h"

#include "core/files/write_file.h"
#include "exporters/splats/splats.h"
#include "exporters/upright.h"

#include <bit>
#include <cmath>

namespace sheen::exporters {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

constexpr std::string_view kSplatPlyEndings[] = {".splat.ply"};

void append_float(std::string& bytes, float value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string splat_ply_header(std::size_t count) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(count) + "\n";
  const auto add = [&](const std::string& name) { text += "property float " + name + "\n"; };
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) add(name);
  for (int i = 0; i < 3; ++i) add("f_dc_" + std::to_string(i));
  for (int i = 0; i < 45; ++i) add("f_rest_" + std::to_string(i));
  add("opacity");
  for (int i = 0; i < 3; ++i) add("scale_" + std::to_string(i));
  for (int i = 0; i < 4; ++i) add("rot_" + std::to_string(i));
  return text + "end_header\n";
}

std::string splat_ply_bytes(const Splats& splats) {
  std::string bytes = splat_ply_header(splats.splats.size());
  for (const Splat& splat : splats.splats) {
    for (const float value : splat.position) append_float(bytes, value);
    const Eigen::Vector3f normal = splat.rotation * Eigen::Vector3f::UnitZ();
    for (const float value : normal) append_float(bytes, value);
    for (const float value : splat.harmonics[0]) append_float(bytes, value);
    for (int channel = 0; channel < 3; ++channel) {  // all of red, then green, then blue
      for (std::size_t term = 1; term < 16; ++term) {
        append_float(bytes, splat.harmonics[term][channel]);
      }
    }
    append_float(bytes, std::log(splat.opacity / (1 - splat.opacity)));
    for (const float value : splat.sigma) append_float(bytes, std::log(value));
    const Eigen::Quaternionf& q = splat.rotation;
    for (const float value : {q.w(), q.x(), q.y(), q.z()}) append_float(bytes, value);
  }
  return bytes;
}

Written write_splat_ply(const fitting::Model& model, const std::filesystem::path& path,
                        const fitting::FitOptions& options) {
  // Half a turn about x: y down, as the images have it that the reference learns from.
  const Eigen::Matrix3f y_down = Eigen::Vector3f(1, -1, -1).asDiagonal() *
                                 y_up_from_object(fitting::options_as<UprightOptions>(options).up);
  const Splats splats = make_splats(model, y_down);
  core::write_file(path, splat_ply_bytes(splats));
  return {.files = {path},
          .as_read = splat_model(model, splats, y_down),
          .remarks = splat_remarks(model)};
}

}  // namespace

constinit const Format kSplatPlyFormat{
    .name = "Gaussian splats",
    .endings = kSplatPlyEndings,
    .sentence = "Gaussian splats as 3DGS has them, harmonics of degree 3",
    .default_options = fitting::new_options<UprightOptions>,
    .write = write_splat_ply};

}  // namespace sheen::exporters
