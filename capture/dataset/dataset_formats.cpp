// SPDX-License-Identifier: MIT
#include "capture/dataset/dataset_formats.h"

#include "capture/dataset/bundler_file.h"
#include "capture/dataset/colmap_files.h"
#include "capture/dataset/metashape_file.h"
#include "capture/dataset/transforms_file.h"
#include "core/diagnostics/error.h"

#include <array>

namespace sheen::capture {

std::span<const DatasetFormat* const> dataset_formats() {
  static constexpr std::array<const DatasetFormat*, 5> all{
      &kNerfstudioFormat, &kColmapFormat, &kColmapTextFormat, &kBundlerFormat, &kMetashapeFormat};
  return all;
}

std::filesystem::path images_of_dataset(const std::filesystem::path& path) {
  std::error_code no_throw;
  if (!std::filesystem::is_directory(path, no_throw)) return path.parent_path();
  return std::filesystem::exists(path / "transforms.json", no_throw) ? path : path / "images";
}

Dataset read_dataset(const std::filesystem::path& path, const std::filesystem::path& images) {
  std::error_code no_throw;
  if (!std::filesystem::exists(path, no_throw)) {
    throw core::bad_input(path, "there is no such file or folder", "check the path");
  }
  for (const DatasetFormat* format : dataset_formats()) {
    if (const auto found = format->find(path)) return format->read(*found, images);
  }
  std::string known;
  for (const DatasetFormat* format : dataset_formats()) {
    known += (known.empty() ? "" : ", ") + std::string(format->name);
  }
  throw core::bad_input(path, "holds no data set of a known format (" + known + ")",
                        "name the file, or the folder that holds it");
}

}  // namespace sheen::capture
