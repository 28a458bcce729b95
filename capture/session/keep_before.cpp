// SPDX-License-Identifier: MIT
#include "capture/session/keep_before.h"

#include "core/diagnostics/error.h"
#include "core/files/staged_output.h"

#include <string>

namespace sheen::capture {

std::filesystem::path keep_before(const std::filesystem::path& file, const std::string& step) {
  const std::string name = file.stem().string() + ".before-" + step;
  auto copy = file;
  copy.replace_filename(name + file.extension().string());
  std::error_code failure;
  for (int count = 2; std::filesystem::exists(copy, failure); ++count) {
    copy.replace_filename(name + "-" + std::to_string(count) + file.extension().string());
  }
  core::StagedOutput staged(copy);
  std::filesystem::copy_file(file, staged.path(), failure);
  if (failure) {
    throw core::Error(core::Error::Kind::run_failed, copy, "cannot be written",
                      "check free space and permissions");
  }
  staged.commit();
  return copy;
}

}  // namespace sheen::capture
