// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/kept_views/kept_view.h"
#include "fitting/light_field.h"
#include "fitting/mean/mean_light_field.h"
#include "fitting/view_dependent_texture/options.h"

#include <utility>
#include <vector>

namespace sheen::fitting::view_dependent_texture {

/// All photographs, projected onto the mesh from where they were taken and blended anew for every
/// pixel; after Buehler et al., "Unstructured Lumigraph Rendering" (2001). Where none sees the
/// surface, the mean colours of the vertices.
class ViewTexture final : public LightField {
 public:
  ViewTexture(const Options& options, std::size_t vertex_count)
      : options_(options), means_(vertex_count) {}

  [[nodiscard]] std::string_view representation() const override {
    return "view-dependent-texture";
  }
  /// Three per pixel kept and per vertex.
  [[nodiscard]] std::size_t coefficient_count() const override {
    std::size_t count = means_.coefficient_count();
    for (const KeptView& view : photographs_) {
      count += 3 * static_cast<std::size_t>(view.crop.area());
    }
    return count;
  }
  /// Photographs.
  [[nodiscard]] std::size_t element_count() const override { return photographs_.size(); }
  [[nodiscard]] std::vector<Eigen::Vector3f> vertex_colours(const core::Mesh& mesh) const override {
    return means_.vertex_colours(mesh);
  }

  [[nodiscard]] const Options& options() const { return options_; }
  [[nodiscard]] const std::vector<KeptView>& photographs() const { return photographs_; }
  [[nodiscard]] const mean::MeanLightField& means() const { return means_; }

  void add(KeptView photograph) { photographs_.push_back(std::move(photograph)); }
  void set_means(const mean::MeanLightField& means) { means_ = means; }

 private:
  Options options_;
  std::vector<KeptView> photographs_;
  mean::MeanLightField means_;
};

}  // namespace sheen::fitting::view_dependent_texture
