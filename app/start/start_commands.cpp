// SPDX-License-Identifier: MIT
#include "app/start/start_commands.h"

#include "capture/calibration/calibration_images.h"
#include "core/text/lower_case.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace sheen::app {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 7> kFilms{".mp4", ".mov",  ".mkv", ".avi",
                                                 ".m4v", ".webm", ".mts"};

bool is_there(const fs::path& path) {
  std::error_code no_throw;
  return fs::exists(path, no_throw);
}

std::string ending_of(const fs::path& path) {
  return core::lower_case(path.extension().string());
}

bool holds_pictures(const fs::path& folder) {
  std::error_code no_throw;
  for (fs::directory_iterator entry(folder, no_throw), end; !no_throw && entry != end;
       entry.increment(no_throw)) {
    if (capture::is_picture_name(entry->path())) return true;
  }
  return false;
}

/// A model that nothing of that name stands in the way of: NAME.glb and its session NAME.
fs::path free_model(const fs::path& folder, const std::string& name) {
  for (int number = 1;; ++number) {
    const std::string tried = number == 1 ? name : name + "-" + std::to_string(number);
    if (!is_there(folder / tried) && !is_there(folder / (tried + ".glb"))) {
      return folder / (tried + ".glb");
    }
  }
}

Arguments made_and_shown(const fs::path& source, const fs::path& model) {
  return {"replay", source.string(), "-o", model.string(), "--preview"};
}

constexpr std::string_view kPlain = "._-/:@%+=,";  // besides letters and digits

std::string quoted(const std::string& word) {
  if (!word.empty() && std::ranges::all_of(word, [](unsigned char c) {
        return std::isalnum(c) != 0 || kPlain.find(static_cast<char>(c)) != std::string_view::npos;
      })) {
    return word;
  }
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// Behind "HOME/"; nothing for what lies elsewhere.
std::optional<std::string> below_home(const std::string& path) {
  const char* const home = std::getenv("HOME");
  const std::string start = home == nullptr ? "" : std::string(home) + "/";
  if (start.size() < 2 || !path.starts_with(start) || path.size() == start.size()) {
    return std::nullopt;
  }
  return path.substr(start.size());
}

}  // namespace

fs::path sheet_file(const StartChoice& choice) {
  const char* const name = choice.paper == "a4" ? "sheen-board.pdf" : "sheen-board-letter.pdf";
  return choice.sheet_folder / name;
}

Arguments board_arguments(const StartChoice& choice) {
  Arguments arguments{"board", "-o", sheet_file(choice).string()};
  if (choice.paper != "a4") arguments.insert(arguments.end(), {"--paper", choice.paper});
  return arguments;
}

fs::path model_file(const StartChoice& choice) {
  return free_model(choice.model_folder, choice.name);
}

std::optional<Arguments> capture_arguments(const StartChoice& choice) {
  const bool is_name = !choice.name.empty() && choice.name.front() != '.' &&
                       choice.name.find('/') == std::string::npos;
  if (choice.camera.empty() || !is_name) return std::nullopt;
  return Arguments{"capture", choice.camera, "-o", model_file(choice).string()};
}

std::optional<Arguments> open_arguments(const fs::path& path) {
  std::error_code no_throw;
  if (fs::is_regular_file(path, no_throw)) {
    if (ending_of(path) == ".glb") return Arguments{"view", path.string()};
    if (path.filename() == "session.json") return open_arguments(path.parent_path());
    if (std::ranges::find(kFilms, ending_of(path)) == kFilms.end()) return std::nullopt;
    return made_and_shown(path, free_model(path.parent_path(), path.stem().string()));
  }
  if (!fs::is_directory(path, no_throw)) return std::nullopt;
  // "walk/" and "walk" are the same folder; a capture to walk.glb lies beside it.
  const fs::path folder = path.has_filename() ? path : path.parent_path();
  if (is_there(folder / "session.json")) {
    const fs::path inside = folder / "model.glb";
    const fs::path beside = folder.parent_path() / (folder.filename().string() + ".glb");
    for (const fs::path& model : {inside, beside}) {
      if (is_there(model)) return Arguments{"view", model.string()};
    }
    return made_and_shown(folder, inside);
  }
  if (!holds_pictures(folder)) return std::nullopt;
  return made_and_shown(folder,
                        free_model(folder.parent_path(), folder.filename().string() + "-model"));
}

fs::path model_of(const Arguments& arguments) {
  const auto output = std::ranges::find(arguments, "-o");
  if (arguments.empty() || arguments.front() == "board") return {};
  if (arguments.front() == "view") return arguments.at(1);
  return output == arguments.end() ? fs::path() : fs::path(*std::next(output));
}

std::string shown_path(const fs::path& path) {
  const auto rest = below_home(path.string());
  return rest ? "~/" + *rest : path.string();
}

std::string as_typed(const std::string& program, const Arguments& arguments) {
  std::string text = quoted(program);
  for (const std::string& argument : arguments) {
    const auto rest = below_home(argument);
    text += rest ? " ~/" : " ";
    text += quoted(rest ? *rest : argument);
  }
  return text;
}

}  // namespace sheen::app
