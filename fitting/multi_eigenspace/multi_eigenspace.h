// SPDX-License-Identifier: MIT
#pragma once

#include "core/directions/view_sphere.h"
#include "fitting/light_field.h"
#include "fitting/mean/mean_light_field.h"
#include "fitting/multi_eigenspace/options.h"
#include "fitting/multi_eigenspace/picture_frame.h"

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace sheen::fitting::multi_eigenspace {

/// Pictures that are mean + sum_k coefficient_k * image_k. 8 bits a number, as in the model file.
struct Eigenspace {
  cv::Mat mean;                 ///< CV_8UC4: blue, green, red, coverage
  std::vector<cv::Mat> images;  ///< CV_8SC4, in steps of `steps`
  std::vector<float> steps;     ///< grey levels at coefficient 1; coefficients are in [-1, 1]
};

/// What a view is in a space: its own, or one of its neighbours' for the transition.
struct ViewInSpace {
  std::uint32_t view_idx;
  std::uint32_t space_idx;
  std::vector<std::int16_t> coefficients;  ///< one per eigenimage, over 32767
};

/// A part of what is drawn: a space, how much of it, and its coefficients in [-1, 1].
struct SpaceShare {
  std::uint32_t space_idx;
  float share;
  std::vector<float> coefficients;
};

/// Views of the object as a whole, rectified to pictures and packed into several eigenspaces of few
/// dimensions each (docs/systems.md); after Leonardis, Bischof and Maver, "Multiple eigenspaces"
/// (2002), from headings to all directions. The mean colours of the vertices are for programs that
/// know nothing of it.
class MultiEigenspace final : public LightField {
 public:
  /// Without any view.
  MultiEigenspace(const Options& options, std::size_t vertex_count);

  [[nodiscard]] std::string_view representation() const override { return "multi-eigenspace"; }
  /// Values of pictures, coefficients of views, three per vertex.
  [[nodiscard]] std::size_t coefficient_count() const override;
  /// Eigenspaces.
  [[nodiscard]] std::size_t element_count() const override { return spaces_.size(); }
  [[nodiscard]] std::vector<Eigen::Vector3f> vertex_colours(const core::Mesh& mesh) const override {
    return means_.vertex_colours(mesh);
  }

  [[nodiscard]] const Options& options() const { return options_; }
  [[nodiscard]] const PictureFrame& frame() const { return frame_; }
  /// From the middle of the frame to the eye of every view, unit vectors.
  [[nodiscard]] const std::vector<Eigen::Vector3d>& directions() const { return directions_; }
  [[nodiscard]] const std::vector<std::uint32_t>& owners() const { return owners_; }
  [[nodiscard]] const std::vector<Eigenspace>& spaces() const { return spaces_; }
  [[nodiscard]] const std::vector<ViewInSpace>& views() const { return views_; }
  [[nodiscard]] const mean::MeanLightField& means() const { return means_; }

  void set_means(const mean::MeanLightField& means) { means_ = means; }
  /// One owner for every direction; every view in its own space at least.
  void set_spaces(const PictureFrame& frame, std::vector<Eigen::Vector3d> directions,
                  std::vector<std::uint32_t> owners, std::vector<Eigenspace> spaces,
                  std::vector<ViewInSpace> views);

  /// What is drawn towards a direction (unit, from the middle of the frame): one space or, between
  /// views of different ones and unless switching is hard, up to three. Shares sum to 1; nothing
  /// where there is no view. Continuous but for hard switches.
  [[nodiscard]] std::vector<SpaceShare> shares(const Eigen::Vector3d& direction) const;

  /// That as a picture: CV_32FC4, 0 to 255 or a little beyond; empty where there is no view.
  [[nodiscard]] cv::Mat picture(const Eigen::Vector3d& direction) const;

 private:
  [[nodiscard]] const ViewInSpace* find(std::uint32_t view_idx, std::uint32_t space_idx) const;

  Options options_;
  PictureFrame frame_{Eigen::Vector3d::Zero(), 1, Eigen::Vector3d::UnitZ()};
  std::vector<Eigen::Vector3d> directions_;
  core::ViewSphere sphere_{{}};
  std::vector<std::uint32_t> owners_;
  std::vector<Eigenspace> spaces_;
  std::vector<ViewInSpace> views_;          ///< by view, then by space
  std::vector<std::size_t> first_of_view_;  ///< in views_; one more than views
  mean::MeanLightField means_;
};

}  // namespace sheen::fitting::multi_eigenspace
