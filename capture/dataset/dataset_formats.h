// SPDX-License-Identifier: MIT
#pragma once

#include "capture/dataset/dataset.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

namespace sheen::capture {

/// One format of posed images: all that the program knows of it. `sheen import` and `sheen export`
/// follow from the list in dataset_formats.cpp.
struct DatasetFormat {
  std::string_view name;      ///< on the command line: "colmap"
  std::string_view sentence;  ///< for the help: what it is, in a few words

  /// The file or folder of this format that a user means by `path`; nothing where there is none.
  std::optional<std::filesystem::path> (*find)(const std::filesystem::path& path);

  /// Reads what `find` found; `images` is the folder that the images' names are relative to. Throws
  /// core::Error (bad_input).
  Dataset (*read)(const std::filesystem::path& found, const std::filesystem::path& images);

  /// Writes what describes the images into their folder, which exists; null: only read. Throws
  /// core::Error (bad_input) for what the format cannot hold.
  void (*write)(const std::filesystem::path& folder, const Dataset& dataset);
};

/// In the order in which users should see them.
std::span<const DatasetFormat* const> dataset_formats();

/// Where the images' names are relative to, unless a user says otherwise: the folder of a file, and
/// of a folder itself (transforms.json) or the images/ in it.
std::filesystem::path images_of_dataset(const std::filesystem::path& path);

/// Reads a data set of whatever format. Throws core::Error (bad_input).
Dataset read_dataset(const std::filesystem::path& path, const std::filesystem::path& images);

}  // namespace sheen::capture
