// SPDX-License-Identifier: MIT
#include "app/preview/reasons.h"

#include <array>
#include <utility>

namespace sheen::app {

std::string reason_in_words(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 7> words{{
      {"no_tags", "no tag in view: show the board"},
      {"too_few_tags", "too few tags in view"},
      {"reprojection", "tags do not agree: board moved or bent?"},
      {"blur", "moving too fast: blur"},
      {"no_pose_in_file", "no pose on file for this frame"},
      {"exposure_step", "brightness has jumped: lock the exposure"},
      {"mismatch", "disagrees with the model: moved or covered?"},
  }};
  for (const auto& [key, text] : words) {
    if (key == name) return std::string(text);
  }
  return std::string(name);
}

}  // namespace sheen::app
