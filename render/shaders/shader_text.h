// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace sheen::render {

/// Text of a GLSL file of this module, embedded by the build; `name` is its path below render/, as
/// listed in render/CMakeLists.txt. Lives as long as the program.
std::string_view shader_text(std::string_view name);

}  // namespace sheen::render
