// SPDX-License-Identifier: MIT
#include "app/start/desktop_folders.h"

#include "core/diagnostics/error.h"
#include "core/files/read_file.h"
#include "core/files/write_file.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string>

namespace sheen::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostRecent = 8;
constexpr std::size_t kMostBytes = 65536;

fs::path from_environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? fs::path() : fs::path(value);
}

/// A folder of the XDG base directories: the variable's, else that below the home folder.
fs::path base_folder(const char* variable, const char* below_home) {
  const fs::path set = from_environment(variable);
  if (set.is_absolute()) return set;
  const fs::path home = from_environment("HOME");
  return home.empty() ? fs::path() : home / below_home;
}

fs::path recent_list() {
  const fs::path state = base_folder("XDG_STATE_HOME", ".local/state");
  return state.empty() ? fs::path() : state / "sheen" / "recent";
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::vector<std::string> lines;
  try {
    std::istringstream text(core::read_file(file, kMostBytes));
    for (std::string line; std::getline(text, line);) lines.push_back(line);
  } catch (const core::Error&) {  // none yet
  }
  return lines;
}

}  // namespace

fs::path downloads_folder() {
  const fs::path home = from_environment("HOME");
  std::error_code no_throw;
  // XDG_DOWNLOAD_DIR="$HOME/Downloads"
  const std::string key = "XDG_DOWNLOAD_DIR=\"";
  for (const std::string& line :
       lines_of(base_folder("XDG_CONFIG_HOME", ".config") / "user-dirs.dirs")) {
    if (!line.starts_with(key) || !line.ends_with('"') || line.size() == key.size()) continue;
    std::string value = line.substr(key.size(), line.size() - key.size() - 1);
    if (value.starts_with("$HOME")) value.replace(0, 5, home.string());
    if (fs::is_directory(value, no_throw)) return value;
  }
  for (const fs::path& folder : {home / "Downloads", home}) {
    if (!home.empty() && fs::is_directory(folder, no_throw)) return folder;
  }
  return ".";
}

std::vector<fs::path> recent_files() {
  std::vector<fs::path> files;
  for (const std::string& line : lines_of(recent_list())) {
    std::error_code no_throw;
    if (files.size() < kMostRecent && fs::exists(line, no_throw)) files.emplace_back(line);
  }
  return files;
}

void note_recent_file(const fs::path& file) {
  const fs::path list = recent_list();
  std::error_code no_throw;
  const fs::path full = fs::absolute(file, no_throw).lexically_normal();
  if (list.empty() || full.string().find('\n') != std::string::npos) return;
  auto files = recent_files();
  std::erase(files, full);
  files.insert(files.begin(), full);
  std::string text;
  for (std::size_t i = 0; i < std::min(files.size(), kMostRecent); ++i) {
    text += files[i].string() + "\n";
  }
  fs::create_directories(list.parent_path(), no_throw);
  try {
    core::write_file(list, text);
  } catch (const core::Error&) {  // a list of conveniences ends no work
  }
}

}  // namespace sheen::app
