// SPDX-License-Identifier: MIT
#include "fitting/model_file/model_part.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace sheen::fitting {

const nlohmann::json& required(const nlohmann::json& object, const char* name) {
  if (object.is_object()) {
    const auto member = object.find(name);
    if (member != object.end()) return *member;
  }
  throw ModelFault(std::string("it has no \"") + name + "\"");
}

std::size_t required_size(const nlohmann::json& object, const char* name) {
  const nlohmann::json& value = required(object, name);
  constexpr std::uint64_t largest = std::uint64_t{1} << 53;  // JSON numbers are exact up to here
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > largest) {
    throw ModelFault(std::string("its \"") + name + "\" is not a count");
  }
  return value.get<std::size_t>();
}

double required_number(const nlohmann::json& object, const char* name) {
  const nlohmann::json& value = required(object, name);
  if (!value.is_number() || !std::isfinite(value.get<double>())) {
    throw ModelFault(std::string("its \"") + name + "\" is not a number");
  }
  return value.get<double>();
}

std::string required_string(const nlohmann::json& object, const char* name) {
  const nlohmann::json& value = required(object, name);
  if (!value.is_string()) throw ModelFault(std::string("its \"") + name + "\" is not a text");
  return value.get<std::string>();
}

std::span<const std::byte> required_bytes(const ModelPart& part, const char* name,
                                          std::size_t size) {
  const auto found = part.arrays.find(name);
  if (found == part.arrays.end()) throw ModelFault(std::string("it has no array \"") + name + "\"");
  if (found->second.size() != size) {
    throw ModelFault(std::string("its array \"") + name + "\" has " +
                     std::to_string(found->second.size()) + " bytes instead of " +
                     std::to_string(size));
  }
  return found->second;
}

std::vector<Eigen::half> required_halves(const ModelPart& part, const char* name,
                                         std::size_t count) {
  // A count that no memory could hold must not wrap around when it becomes bytes.
  if (count > std::numeric_limits<std::size_t>::max() / sizeof(Eigen::half)) {
    throw ModelFault(std::string("its array \"") + name + "\" cannot be that large");
  }
  const auto bytes = required_bytes(part, name, count * sizeof(Eigen::half));
  std::vector<Eigen::half> values(count);
  if (count > 0) std::memcpy(values.data(), bytes.data(), bytes.size());
  for (const Eigen::half value : values) {
    if (!(Eigen::numext::isfinite)(value)) {
      throw ModelFault(std::string("its array \"") + name + "\" holds NaN or infinity");
    }
  }
  return values;
}

std::vector<std::uint8_t> required_observed(const ModelPart& part, std::size_t patch_count) {
  if (part.observed.size() != patch_count) {
    throw ModelFault("it has not one observed flag per vertex");
  }
  std::vector<std::uint8_t> observed(patch_count);
  if (patch_count > 0) std::memcpy(observed.data(), part.observed.data(), patch_count);
  if (std::any_of(observed.begin(), observed.end(), [](std::uint8_t flag) { return flag > 1; })) {
    throw ModelFault("an observed flag is neither 0 nor 1");
  }
  return observed;
}

}  // namespace sheen::fitting
