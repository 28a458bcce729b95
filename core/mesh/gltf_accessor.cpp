// SPDX-License-Identifier: MIT
#include "core/mesh/gltf_accessor.h"

#include "core/mesh/gltf_compression.h"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace sheen::core {
namespace {

using nlohmann::json;

constexpr unsigned kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                   kUnsignedInt = 5125, kFloat = 5126;
constexpr std::size_t kMostUnpackedBytes = std::size_t{1} << 31;
constexpr std::size_t kMostNumbers = std::size_t{1} << 28;
constexpr std::size_t kMostZeros = 64;  // elements of an accessor without data, for a byte of file

std::size_t size_of(unsigned component_type) {
  switch (component_type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      throw GltfFault("holds numbers of a type that glTF does not have");
  }
}

template <typename T>
double value_at(const std::byte* bytes) {
  T value{};
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(value);
}

/// One number; normalised integers as glTF maps them.
double number_at(const std::byte* bytes, unsigned component_type, bool is_normalised) {
  switch (component_type) {
    case kByte:
      return is_normalised ? std::max(value_at<std::int8_t>(bytes) / 127, -1.0)
                           : value_at<std::int8_t>(bytes);
    case kUnsignedByte:
      return value_at<std::uint8_t>(bytes) / (is_normalised ? 255 : 1);
    case kShort:
      return is_normalised ? std::max(value_at<std::int16_t>(bytes) / 32767, -1.0)
                           : value_at<std::int16_t>(bytes);
    case kUnsignedShort:
      return value_at<std::uint16_t>(bytes) / (is_normalised ? 65535 : 1);
    case kUnsignedInt:
      return value_at<std::uint32_t>(bytes);
    default:
      return value_at<float>(bytes);
  }
}

/// `count` elements of `components` numbers each from the start of `bytes`, `stride` bytes apart.
template <typename Out>
void read_elements(std::span<const std::byte> bytes, std::size_t stride, std::size_t count,
                   unsigned component_type, bool is_normalised, std::size_t components,
                   std::vector<Out>& values) {
  const std::size_t size = size_of(component_type);
  const std::size_t element = components * size;
  if (stride == 0) stride = element;
  if (count == 0) return;
  if (stride < element || bytes.size() < element || (bytes.size() - element) / stride < count - 1) {
    throw GltfFault("has an array that reaches beyond its data");
  }
  values.reserve(values.size() + count * components);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < components; ++c) {
      values.push_back(static_cast<Out>(
          number_at(bytes.data() + i * stride + c * size, component_type, is_normalised)));
    }
  }
}

unsigned component_type_of(const json& object) {
  return static_cast<unsigned>(
      std::min<std::size_t>(gltf_size(object, "componentType"), 1U << 16U));
}

std::span<const std::byte> from(std::span<const std::byte> bytes, std::size_t offset) {
  if (offset > bytes.size()) throw GltfFault("has an array that reaches beyond its data");
  return bytes.subspan(offset);
}

std::string_view type_name(std::size_t components) {
  constexpr std::string_view names[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  return names[components];
}

bool is_unsigned(unsigned type) {
  return type == kUnsignedByte || type == kUnsignedShort || type == kUnsignedInt;
}

}  // namespace

std::span<const std::byte> GltfAccessors::part_of_buffer(const json& view) const {
  const std::size_t buffer = gltf_size(view, "buffer");
  const std::size_t offset = gltf_size(view, "byteOffset", 0);
  const std::size_t length = gltf_size(view, "byteLength");
  if (buffer >= gltf_.buffers.size()) throw GltfFault("names a buffer that does not exist");
  const auto bytes = gltf_.buffers[buffer];
  if (offset > bytes.size() || length > bytes.size() - offset) {
    throw GltfFault("has a part that reaches beyond its data");
  }
  return bytes.subspan(offset, length);
}

GltfAccessors::View GltfAccessors::view(std::size_t index) {
  const json& view = gltf_entry(gltf_.document, "bufferViews", index);
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    const json* packed = gltf_extension(view, name);
    if (packed == nullptr) continue;
    auto known = unpacked_.find(index);
    if (known == unpacked_.end()) {
      auto bytes = unpack_meshopt(*packed, part_of_buffer(*packed));
      unpacked_bytes_ += bytes.size();
      if (unpacked_bytes_ > kMostUnpackedBytes) throw GltfFault("has arrays of impossible size");
      known = unpacked_.emplace(index, std::move(bytes)).first;
    }
    return {known->second, gltf_size(*packed, "byteStride")};
  }
  return {part_of_buffer(view), gltf_size(view, "byteStride", 0)};
}

std::size_t GltfAccessors::count(std::size_t accessor) const {
  return gltf_size(gltf_entry(gltf_.document, "accessors", accessor), "count");
}

bool GltfAccessors::has_type(std::size_t accessor, std::size_t components) const {
  const json& type = gltf_member(gltf_entry(gltf_.document, "accessors", accessor), "type");
  return type.is_string() && type.get_ref<const std::string&>() == type_name(components);
}

template <typename Out>
void GltfAccessors::read_sparse(const json& sparse, unsigned component_type, bool is_normalised,
                                std::size_t components, std::vector<Out>& values) {
  const std::size_t count = gltf_size(sparse, "count");
  const json& places = gltf_member(sparse, "indices");
  const json& changes = gltf_member(sparse, "values");
  if (!places.is_object() || !changes.is_object()) throw GltfFault("has a sparse array of no form");
  const View place_view = view(gltf_size(places, "bufferView"));
  std::vector<std::uint32_t> where;
  const unsigned place_type = component_type_of(places);
  if (!is_unsigned(place_type)) throw GltfFault("has a sparse array of no form");
  read_elements(from(place_view.bytes, gltf_size(places, "byteOffset", 0)), place_view.stride,
                count, place_type, false, 1, where);
  const View change_view = view(gltf_size(changes, "bufferView"));
  std::vector<Out> changed;
  read_elements(from(change_view.bytes, gltf_size(changes, "byteOffset", 0)), change_view.stride,
                count, component_type, is_normalised, components, changed);
  for (std::size_t i = 0; i < count; ++i) {
    if (where[i] >= values.size() / components) {
      throw GltfFault("has a sparse array that reaches beyond its data");
    }
    std::copy_n(changed.begin() + static_cast<std::ptrdiff_t>(i * components), components,
                values.begin() + static_cast<std::ptrdiff_t>(where[i] * components));
  }
}

template <typename Out>
std::vector<Out> GltfAccessors::read(std::size_t accessor, std::size_t components) {
  const json& object = gltf_entry(gltf_.document, "accessors", accessor);
  if (!has_type(accessor, components)) {
    throw GltfFault("has an array that is not of type " + std::string(type_name(components)));
  }
  const unsigned component_type = component_type_of(object);
  const std::size_t count = gltf_size(object, "count");
  // Everything together: a small file may name one array many times, or claim zeros.
  if (count > kMostNumbers / components || (numbers_read_ += count * components) > kMostNumbers) {
    throw GltfFault("has arrays of impossible size");
  }
  const json& normalised = gltf_member(object, "normalized");
  const bool is_normalised = normalised.is_boolean() && normalised.get<bool>();
  std::vector<Out> values;
  if (object.contains("bufferView")) {
    const View from_view = view(gltf_size(object, "bufferView"));
    read_elements(from(from_view.bytes, gltf_size(object, "byteOffset", 0)), from_view.stride,
                  count, component_type, is_normalised, components, values);
  } else {
    static_cast<void>(size_of(component_type));
    if (count > kMostZeros * gltf_.file.size()) {
      throw GltfFault("has an array without data of impossible size");
    }
    values.assign(count * components, Out{});
  }
  const json& sparse = gltf_member(object, "sparse");
  if (sparse.is_object()) {
    read_sparse(sparse, component_type, is_normalised, components, values);
  }
  return values;
}

std::vector<double> GltfAccessors::numbers(std::size_t accessor, std::size_t components) {
  return read<double>(accessor, components);
}

std::vector<std::uint32_t> GltfAccessors::indices(std::size_t accessor) {
  const json& object = gltf_entry(gltf_.document, "accessors", accessor);
  const unsigned type = component_type_of(object);
  const json& normalised = gltf_member(object, "normalized");
  if (!is_unsigned(type) || (normalised.is_boolean() && normalised.get<bool>())) {
    throw GltfFault("has indices that are no whole numbers from 0");
  }
  return read<std::uint32_t>(accessor, 1);
}

}  // namespace sheen::core
