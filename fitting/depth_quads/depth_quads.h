// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/depth_quads/options.h"
#include "fitting/depth_quads/quad_grid.h"
#include "fitting/kept_views/kept_view.h"
#include "fitting/light_field.h"
#include "fitting/mean/mean_light_field.h"

#include <Eigen/Core>

#include <vector>

namespace sheen::fitting::depth_quads {

/// A photograph cut into squares that stand at the depth of what they show, parallel to the image.
struct QuadView {
  QuadDepths depths;
  std::vector<QuadLevel> levels;
  std::vector<Eigen::Vector3d> probes;  ///< middles of a few quads, object frame, metres; not empty
};

/// Photographs and the depths of what they show, drawn as small quads, for which no mesh is needed;
/// after Evers-Senne and Koch, "Image Based Rendering from Handheld Cameras using Quad Primitives"
/// (2003). The mean colours of the vertices are for programs that know nothing of quads.
class DepthQuads final : public LightField {
 public:
  DepthQuads(const Options& options, std::size_t vertex_count)
      : options_(options), means_(vertex_count) {}

  [[nodiscard]] std::string_view representation() const override { return "depth-quads"; }
  /// Three per pixel kept, one per cell of every level, three per vertex.
  [[nodiscard]] std::size_t coefficient_count() const override;
  /// Photographs.
  [[nodiscard]] std::size_t element_count() const override { return photographs_.size(); }
  [[nodiscard]] std::vector<Eigen::Vector3f> vertex_colours(const core::Mesh& mesh) const override {
    return means_.vertex_colours(mesh);
  }

  [[nodiscard]] const Options& options() const { return options_; }
  [[nodiscard]] const std::vector<KeptView>& photographs() const { return photographs_; }
  [[nodiscard]] const QuadView& quads(std::size_t photograph_idx) const {
    return quads_[photograph_idx];
  }
  [[nodiscard]] const mean::MeanLightField& means() const { return means_; }

  /// Adds a photograph, with a code for every cell of its levels, not all of them 0.
  void add(KeptView photograph, QuadDepths depths);
  void set_means(const mean::MeanLightField& means) { means_ = means; }

 private:
  Options options_;
  std::vector<KeptView> photographs_;
  std::vector<QuadView> quads_;
  mean::MeanLightField means_;
};

}  // namespace sheen::fitting::depth_quads
