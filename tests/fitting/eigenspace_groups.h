// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace sheen::fitting::testing {

/// Pictures of a made-up turntable, grouped and packed: owners, eigenimages and coefficients as
/// bytes. By the library.
std::vector<std::uint8_t> packed_bytes();

/// By the same sources, compiled without Eigen's vector instructions and with sums in whatever
/// order the compiler likes (tests/fitting/CMakeLists.txt).
std::vector<std::uint8_t> packed_bytes_otherwise();

}  // namespace sheen::fitting::testing
