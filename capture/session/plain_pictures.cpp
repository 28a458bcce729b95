// SPDX-License-Identifier: MIT
#include "capture/session/plain_pictures.h"

#include "capture/source/image_facts.h"
#include "capture/source/image_folder_source.h"
#include "core/files/read_file.h"

namespace sheen::capture {
namespace {

bool is_plain(const std::filesystem::path& path) {
  const std::string bytes = core::read_file(path);
  const ImageFacts facts =
      read_image_facts({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  const bool is_known = facts.kind == ImageKind::jpeg || facts.kind == ImageKind::png;
  return is_known && facts.orientation.is_upright() && facts.profile.empty() &&
         !facts.is_adobe_rgb && !facts.gamma;
}

}  // namespace

std::vector<std::filesystem::path> plain_pictures(const Session& session,
                                                  std::span<const int> frames) {
  if (!session.image_pattern) return {};
  const auto name = NumberedName::parse(*session.image_pattern);
  if (!name) return {};
  std::error_code no_throw;
  const int first = std::filesystem::exists(session.folder / name->at(0), no_throw) ? 0 : 1;
  std::vector<std::filesystem::path> files;
  for (const int frame : frames) {
    files.push_back(session.folder / name->at(first + frame));
    if (!is_plain(files.back())) return {};
  }
  return files;
}

}  // namespace sheen::capture
