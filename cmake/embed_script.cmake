# SPDX-License-Identifier: MIT
# Writes OUTPUT, a C++ file that defines FUNCTION(name) of NAMESPACE, declared in HEADER: the text of
# every file of FILES (names relative to ROOT).
set(entries "")
foreach(name IN LISTS FILES)
  file(READ "${ROOT}/${name}" text)
  # A string literal may be 65536 bytes long; neighbouring ones are joined.
  string(LENGTH "${text}" length)
  set(literals "")
  foreach(begin RANGE 0 ${length} 16000)
    string(SUBSTRING "${text}" ${begin} 16000 piece)
    string(APPEND literals "\n     R\"embedded(${piece})embedded\"")
  endforeach()
  string(APPEND entries "    {\"${name}\",${literals}},\n")
endforeach()
file(WRITE "${OUTPUT}" "// SPDX-License-Identifier: MIT
#include \"${HEADER}\"

#include <cassert>
#include <utility>

namespace ${NAMESPACE} {

std::string_view ${FUNCTION}(std::string_view name) {
  static constexpr std::pair<std::string_view, std::string_view> texts[] = {
${entries}  };
  for (const auto& [key, text] : texts) {
    if (key == name) return text;
  }
  assert(false && \"no file of this name is embedded\");
  return {};
}

}  // namespace ${NAMESPACE}
")
