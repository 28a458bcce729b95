// SPDX-License-Identifier: MIT
#include "capture/dataset/colmap_files.h"
#include "core/geometry/camera.h"
#include "fuzz/reader.h"

#include <array>

namespace {

using sheen::capture::ColmapForm;

/// Writes a model of one camera and one image into `folder`.
void write_sound_model(const std::filesystem::path& folder, ColmapForm form) {
  sheen::core::CameraModel::Intrinsics lens;
  lens.width_px = 160;
  lens.height_px = 120;
  lens.focal_px = {150, 150};
  lens.principal_px = {79.5, 59.5};
  sheen::capture::Dataset dataset;
  dataset.cameras.emplace_back(lens);
  dataset.frames.push_back({.image = "0000.png"});
  std::filesystem::create_directories(folder);
  sheen::capture::write_colmap_model(folder, dataset, form);
}

}  // namespace

// The first byte says which file of a model the others are; the model's other file is sound.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static constexpr std::array names{"cameras.bin", "images.bin", "cameras.txt", "images.txt"};
  if (size == 0) return 0;
  const std::size_t file = bytes[0] % names.size();
  return sheen::fuzz::read_input(
      bytes + 1, size - 1, names[file], [file](const std::filesystem::path& path) {
        const bool is_binary = file < 2;
        const std::filesystem::path model = path.parent_path() / (is_binary ? "binary" : "text");
        write_sound_model(model, is_binary ? ColmapForm::binary : ColmapForm::text);
        std::filesystem::rename(path, model / names[file]);
        sheen::capture::read_colmap_model(model);
      });
}
