// SPDX-License-Identifier: MIT
#pragma once

#include "capture/registration/contour.h"
#include "core/geometry/camera.h"
#include "core/mesh/mesh.h"
#include "pipeline/evidence/finding.h"
#include "pipeline/thinned.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace sheen::pipeline {

/// Where the images have the object's outline, against where mesh and pose put it: a mesh of
/// another size or place is off in all views alike, an object that was moved is off from some frame
/// on, and a mesh of another shape, or turned, cannot be placed so that it fits.
class OutlineEvidence {
 public:
  /// `mesh` must outlive this. Of the frames that come every `spacing`-th is looked at, and fewer
  /// than `most` are kept.
  explicit OutlineEvidence(const core::Mesh& mesh, std::size_t most = 24, std::size_t spacing = 4);

  /// `image` is CV_8UC3, BGR.
  void look_at(int frame_index, const cv::Mat& image, const core::CameraModel& camera,
               const Eigen::Isometry3d& camera_from_object);

  [[nodiscard]] std::vector<Finding> findings() const;

  static constexpr int kUnknowns = 7;  ///< shift, turn about the middle, growth; all in metres
  using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;

  /// A place of the outline that the image shows, too.
  struct Match {
    Vector outward_by_unknown;  ///< px per metre, object frame
    double offset_px = 0;       ///< of the image's edge, outwards
    double weight = 0;
  };
  struct View {
    int frame_index = 0;
    int points = 0;  ///< matched or not
    double px_per_m = 0;
    std::vector<Match> matches;
  };

  /// One motion and growth of the object for all views.
  struct Misplacement {
    Vector unknowns = Vector::Zero();
    [[nodiscard]] Eigen::Vector3d shift_m() const { return unknowns.head<3>(); }
    [[nodiscard]] double growth_m() const { return unknowns[6]; }  ///< at the radius
    double shift_sigma_m = 0;   ///< of the shift, worst direction, from the views' disagreement
    double growth_sigma_m = 0;  ///< of the growth at the radius
    double residual_px = 0;     ///< median distance that is left
  };
  [[nodiscard]] std::optional<Misplacement> misplacement() const;

  /// Share of the mesh's outline, placed so, along which the image has one, too: of the view at the
  /// upper quartile, so that half of the views may be disturbed.
  [[nodiscard]] double agreement(const Misplacement& placed) const;
  /// Too little of it: the mesh is turned, or another object's, and no placement is to be believed.
  [[nodiscard]] bool is_another_shape(const Misplacement& placed) const;

  /// A shift that begins with one frame.
  struct Jump {
    int frame_index = 0;
    Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
    double sigma_m = 0;
  };
  [[nodiscard]] std::optional<Jump> jump() const;

  [[nodiscard]] double radius_m() const { return radius_m_; }
  [[nodiscard]] double px_per_m() const;

 private:
  capture::ContourFinder contours_;
  double radius_m_ = 0;
  bool is_grey_ = true;  ///< no view has shown a colour
  Thinned<View> views_;
};

}  // namespace sheen::pipeline
