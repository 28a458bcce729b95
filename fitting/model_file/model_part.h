// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace sheen::fitting {

class SurfaceTexture;

/// What is wrong with a model file, without its name: `read_model` adds it.
class ModelFault : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One representation's part of a model file (docs/formats.md, "model").
struct ModelPart {
  nlohmann::json parameters = nlohmann::json::object();
  /// Named arrays; in the file each is one bufferView. They point into the light field, the file or
  /// `owner`.
  std::map<std::string, std::span<const std::byte>> arrays;
  /// Of patches only: one flag each, 1 where the patch was seen in the fit.
  std::span<const std::byte> observed{};
  /// Colours between the patches, or null; in the file it is an image that every viewer shows.
  /// Belongs to the light field or, while a file is read, to the reader.
  const SurfaceTexture* texture = nullptr;
  /// Keeps alive what `encode` had to make for the arrays.
  std::shared_ptr<const void> owner;
};

/// Member `name` of an object, or ModelFault.
const nlohmann::json& required(const nlohmann::json& object, const char* name);
/// The same as an integer in [0, 2^53], a finite number, a string.
std::size_t required_size(const nlohmann::json& object, const char* name);
double required_number(const nlohmann::json& object, const char* name);
std::string required_string(const nlohmann::json& object, const char* name);

/// An array of the part that has `size` bytes, or ModelFault.
std::span<const std::byte> required_bytes(const ModelPart& part, const char* name,
                                          std::size_t size);

/// An array of the part as `count` finite half floats, or ModelFault.
std::vector<Eigen::half> required_halves(const ModelPart& part, const char* name,
                                         std::size_t count);

/// The flags of `patch_count` patches, 0 or 1 each, or ModelFault.
std::vector<std::uint8_t> required_observed(const ModelPart& part, std::size_t patch_count);

}  // namespace sheen::fitting
