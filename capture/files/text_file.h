// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace sheen::capture {

/// The whole of a small text file, without a byte-order mark and with \n at the end of lines,
/// whatever the file has (core/text/text_form.h). Throws core::Error (bad_input) when it is
/// missing, is no regular file, cannot be read, or is longer than `max_bytes` (nothing larger is
/// ever allocated).
std::string read_text_file(const std::filesystem::path& path, std::size_t max_bytes);

}  // namespace sheen::capture
