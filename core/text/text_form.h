// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace sheen::core {

/// Brings the text of a file into the form that parsers expect: a byte-order mark of UTF-8 at the
/// start goes, lines end with \n whether the file had \n, \r\n or \r. Throws Error (bad_input) for
/// UTF-16, which no parser here reads; `path` is for that message only.
void normalise_text(std::string& text, const std::filesystem::path& path);

}  // namespace sheen::core
