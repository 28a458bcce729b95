// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace sheen::capture {

/// Copies a file beside itself as NAME.before-STEP.EXT, so that a step that replaces it can be
/// taken back; where that exists, as NAME.before-STEP-2.EXT and so on: the first one stays. Returns
/// its path. Throws core::Error.
std::filesystem::path keep_before(const std::filesystem::path& file, const std::string& step);

}  // namespace sheen::capture
