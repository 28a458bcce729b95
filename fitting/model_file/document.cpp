// SPDX-License-Identifier: MIT
#include "fitting/model_file/document.h"

namespace sheen::fitting {

std::size_t DocumentBuilder::add_view(std::span<const std::byte> bytes, unsigned target) {
  nlohmann::json view = {
      {"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
  if (target != 0) view["target"] = target;
  binary.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  binary.append((4 - binary.size() % 4) % 4, '\0');
  nlohmann::json& views = document["bufferViews"];
  views.push_back(std::move(view));
  return views.size() - 1;
}

std::size_t DocumentBuilder::add_accessor(std::span<const std::byte> bytes, unsigned target,
                                          unsigned component_type, const char* type,
                                          std::size_t count) {
  const std::size_t view = add_view(bytes, target);
  nlohmann::json& accessors = document["accessors"];
  accessors.push_back(
      {{"bufferView", view}, {"componentType", component_type}, {"type", type}, {"count", count}});
  return accessors.size() - 1;
}

}  // namespace sheen::fitting
