// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/billboard/frame.h"
#include "fitting/billboard/options.h"
#include "fitting/light_field.h"
#include "fitting/mean/mean_light_field.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sheen::fitting::billboard {

/// A frame as a model keeps it.
struct Frame {
  cv::Rect crop;                     ///< FrameImage; empty: not baked, or nothing to be seen
  std::vector<std::uint8_t> colour;  ///< a JPEG
  std::vector<std::uint8_t> shape;   ///< a PNG
};

/// `quality` of the JPEG in [1, 100].
Frame encode(const FrameImage& image, int quality);
/// Of a crop that is not empty. Throws core::Error (bad_input) when its bytes cannot be decoded.
FrameImage decode(const Frame& frame);

/// One image of the object for each of many directions, drawn on a square that faces there
/// (docs/systems.md). The mean colours of the vertices are for programs that know nothing of
/// billboards.
class Billboards final : public LightField {
 public:
  Billboards(const Options& options, const Sphere& sphere, std::size_t vertex_count);

  [[nodiscard]] std::string_view representation() const override { return "billboard"; }
  /// Five per pixel kept: colour, coverage, depth; three per vertex.
  [[nodiscard]] std::size_t coefficient_count() const override;
  /// Frames.
  [[nodiscard]] std::size_t element_count() const override { return frames_.size(); }
  [[nodiscard]] std::vector<Eigen::Vector3f> vertex_colours(const core::Mesh& mesh) const override {
    return means_.vertex_colours(mesh);
  }

  [[nodiscard]] const Options& options() const { return options_; }
  [[nodiscard]] const Sphere& sphere() const { return sphere_; }
  /// One per frame.
  [[nodiscard]] std::span<const Eigen::Vector3f> directions() const { return directions_; }
  [[nodiscard]] const Frame& frame(std::size_t frame_idx) const { return frames_[frame_idx]; }
  [[nodiscard]] FrameCamera camera(std::size_t frame_idx) const {
    return frame_camera(sphere_, directions_[frame_idx], options_.field_of_view_deg,
                        options_.side_px);
  }
  [[nodiscard]] const mean::MeanLightField& means() const { return means_; }

  /// Different frames may be set by different threads.
  void set_frame(std::size_t frame_idx, Frame frame) { frames_[frame_idx] = std::move(frame); }
  void set_means(const mean::MeanLightField& means) { means_ = means; }

 private:
  Options options_;
  Sphere sphere_;
  std::vector<Eigen::Vector3f> directions_;
  std::vector<Frame> frames_;
  mean::MeanLightField means_;
};

}  // namespace sheen::fitting::billboard
