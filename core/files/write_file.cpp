// SPDX-License-Identifier: MIT
#include "core/files/write_file.h"

#include "core/diagnostics/error.h"
#include "core/files/staged_output.h"

#include <fstream>

namespace sheen::core {

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  StagedOutput output(path);
  std::ofstream file(output.path(), std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) {
    throw Error(Error::Kind::run_failed, path, "cannot be written",
                "check free space and permissions");
  }
  output.commit();
}

}  // namespace sheen::core
