// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sheen::app {

/// What is typed behind `sheen`.
using Arguments = std::vector<std::string>;

/// What a newcomer has chosen so far; drawing it is another matter (start_window.h).
struct StartChoice {
  std::string paper = "a4";            ///< a4 or letter
  std::filesystem::path sheet_folder;  ///< where the sheet's PDF goes
  std::string camera;                  ///< a device, or an address in the network
  std::filesystem::path model_folder;  ///< where a capture goes; empty: the present one
  std::string name = "object";         ///< of the capture: a file's name without ending
};

/// The sheet's PDF, named after its paper.
std::filesystem::path sheet_file(const StartChoice& choice);

/// Prints nothing itself: the PDF is shown by the desktop, whose dialog prints it.
Arguments board_arguments(const StartChoice& choice);

/// The file that a capture makes: the chosen name, with a number where a model or a session of that
/// name is there already.
std::filesystem::path model_file(const StartChoice& choice);

/// Nothing before a camera and a usable name are chosen.
std::optional<Arguments> capture_arguments(const StartChoice& choice);

/// How a file or folder is looked at: a model, or a session that has one, is viewed; a session
/// without one, a film or a folder of pictures becomes a light field in a window first. Nothing for
/// what is neither.
std::optional<Arguments> open_arguments(const std::filesystem::path& path);

/// The model that a command makes or shows; empty for others.
std::filesystem::path model_of(const Arguments& arguments);

/// A path as people write it: the home folder is ~.
std::string shown_path(const std::filesystem::path& path);

/// The command as one types it in a shell: words quoted where they must be, ~ for the home folder.
std::string as_typed(const std::string& program, const Arguments& arguments);

}  // namespace sheen::app
