// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"
#include "core/text/lower_case.h"
#include "exporters/format.h"
#include "exporters/gltf/gltf_format.h"
#include "exporters/obj/obj_format.h"
#include "exporters/ply/ply_format.h"
#include "exporters/splats/splat_ply_format.h"
#include "exporters/splats/spz_format.h"
#include "exporters/usd/usd_format.h"
#include "exporters/viewer/viewer_format.h"

#include <array>

namespace sheen::exporters {

std::span<const Format* const> formats() {
  static constexpr std::array<const Format*, 7> all{
      &viewer::kFormat, &gltf::kFormat,   &obj::kFormat, &ply::kFormat,
      &usd::kFormat,    &kSplatPlyFormat, &kSpzFormat};
  return all;
}

const Format& format_of(const std::filesystem::path& path) {
  const std::string name = core::lower_case(path.filename().string());
  const Format* found = nullptr;
  std::size_t longest = 0;
  std::string known;
  for (const Format* format : formats()) {
    for (const std::string_view ending : format->endings) {
      known += (known.empty() ? "" : ", ") + std::string(ending);
      if (!name.ends_with(ending) || ending.size() <= longest) continue;
      longest = ending.size();
      found = format;
    }
  }
  if (found != nullptr) return *found;
  throw core::bad_input(path, "has no ending that a format is known by",
                        "end the name with one of " + known);
}

}  // namespace sheen::exporters
