// SPDX-License-Identifier: MIT
#include "app/batch/session_links.h"

#include <fstream>

namespace sheen::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = ".links";  // in folders that this made

}  // namespace

void link_session(const fs::path& from, const fs::path& to, const fs::path& replaced) {
  const bool holds_links = fs::exists(from / kMark);
  fs::create_directories(to / replaced.parent_path());
  std::ofstream(to / kMark).flush();
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path name = entry.path().filename();
    if (name.string().starts_with('.') || name == replaced) continue;
    if (!replaced.parent_path().empty() && name == *replaced.begin()) {
      link_session(entry.path(), to / name, replaced.lexically_relative(name));
    } else if (holds_links && !entry.is_symlink()) {
      fs::copy(entry.path(), to / name, fs::copy_options::recursive);
    } else {
      fs::create_symlink(fs::canonical(entry.path()), to / name);
    }
  }
}

}  // namespace sheen::app
