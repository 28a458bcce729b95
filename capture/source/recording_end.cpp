// SPDX-License-Identifier: MIT
#include "capture/source/recording_end.h"

#include <string>

namespace sheen::capture {

bool is_short(std::optional<int> promised, int decoded, double last_slot) {
  return promised && decoded < *promised - 1 && last_slot < *promised - 1 - 2;
}

core::Error early_end(const std::filesystem::path& path, int decoded, std::optional<int> promised) {
  std::string fault = "decoding stops after " + std::to_string(decoded) + " frames";
  if (promised) fault += " of " + std::to_string(*promised);
  std::string remedy = "the file is truncated or damaged: copy it again";
  if (decoded > 0) remedy += " or choose --end " + std::to_string(decoded);
  return core::bad_input(path, fault, remedy);
}

}  // namespace sheen::capture
