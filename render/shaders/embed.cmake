# SPDX-License-Identifier: MIT
# Writes OUTPUT, a C++ file with the text of every file of SHADERS (names relative to ROOT).
set(entries "")
foreach(shader IN LISTS SHADERS)
  file(READ "${ROOT}/${shader}" text)
  string(APPEND entries "    {\"${shader}\", R\"glsl(${text})glsl\"},\n")
endforeach()
file(WRITE "${OUTPUT}" "// SPDX-License-Identifier: MIT
#include \"render/shaders/shader_text.h\"

#include <cassert>
#include <utility>

namespace sheen::render {

std::string_view shader_text(std::string_view name) {
  static constexpr std::pair<std::string_view, std::string_view> texts[] = {
${entries}  };
  for (const auto& [key, text] : texts) {
    if (key == name) return text;
  }
  assert(false && \"no shader of this name is listed in render/CMakeLists.txt\");
  return {};
}

}  // namespace sheen::render
")
