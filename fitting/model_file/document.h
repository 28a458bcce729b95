// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <span>
#include <string>

namespace sheen::fitting {

/// Name of the vendor extension, and what its version 1 fixes for every model.
inline constexpr const char* kExtension = "SHEEN_surface_light_field";
inline constexpr unsigned kExtensionVersion = 1;
inline constexpr const char* kDirectionMap = "orthographic";  ///< eq. 3
inline constexpr const char* kTangentFrame = "duff-2017";     ///< core/geometry/tangent_frame.h
inline constexpr const char* kColourSpace = "srgb";           ///< of the coefficients

/// glTF's numbers.
inline constexpr unsigned kFloat = 5126;
inline constexpr unsigned kUnsignedInt = 5125;
inline constexpr unsigned kUnsignedShort = 5123;
inline constexpr unsigned kArrayBuffer = 34962;
inline constexpr unsigned kElementArrayBuffer = 34963;
inline constexpr unsigned kLinear = 9729;
inline constexpr unsigned kClampToEdge = 33071;

/// A glTF document with one buffer while it is being written.
struct DocumentBuilder {
  nlohmann::json document = nlohmann::json::object();
  std::string binary;

  /// Appends the bytes, padded to 4; `target` 0 leaves it out. Returns the bufferView's index.
  std::size_t add_view(std::span<const std::byte> bytes, unsigned target = 0);

  /// Returns the accessor's index.
  std::size_t add_accessor(std::span<const std::byte> bytes, unsigned target,
                           unsigned component_type, const char* type, std::size_t count);
};

}  // namespace sheen::fitting
