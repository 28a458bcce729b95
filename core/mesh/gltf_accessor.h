// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/gltf_container.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace sheen::core {

/// Reads the arrays of a glTF file: packed, strided, sparse, quantised, normalised, compressed by
/// meshopt. Everything is checked against the bytes that are there. Throws GltfFault.
class GltfAccessors {
 public:
  /// `gltf` must outlive this.
  explicit GltfAccessors(const GltfContainer& gltf) : gltf_(gltf) {}

  /// Elements of the accessor, `components` numbers each: the type it must have. Normalised
  /// integers come as numbers in [-1, 1].
  [[nodiscard]] std::vector<double> numbers(std::size_t accessor, std::size_t components);

  /// Whole numbers of an accessor of scalars, such as indices.
  [[nodiscard]] std::vector<std::uint32_t> indices(std::size_t accessor);

  [[nodiscard]] std::size_t count(std::size_t accessor) const;

  /// Whether its elements are of so many components, 1 to 4.
  [[nodiscard]] bool has_type(std::size_t accessor, std::size_t components) const;

  /// The bytes of a buffer view and the distance of its elements, 0 where it states none.
  struct View {
    std::span<const std::byte> bytes;
    std::size_t stride = 0;
  };
  [[nodiscard]] View view(std::size_t index);

 private:
  template <typename Out>
  std::vector<Out> read(std::size_t accessor, std::size_t components);
  template <typename Out>
  void read_sparse(const nlohmann::json& sparse, unsigned component_type, bool is_normalised,
                   std::size_t components, std::vector<Out>& values);
  [[nodiscard]] std::span<const std::byte> part_of_buffer(const nlohmann::json& view) const;

  const GltfContainer& gltf_;
  std::size_t numbers_read_ = 0;
  std::size_t unpacked_bytes_ = 0;
  std::map<std::size_t, std::vector<std::byte>> unpacked_;  ///< compressed views, by index
};

}  // namespace sheen::core
