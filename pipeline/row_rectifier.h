// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/edge_alignment.h"
#include "capture/session/session.h"
#include "capture/source/frame.h"
#include "core/mesh/mesh.h"
#include "core/samples/surface_points.h"
#include "core/samples/vertex_view.h"
#include "core/visibility/depth_image.h"

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace sheen::pipeline {

/// Undoes a rolling shutter (docs/algorithm.md, 10): makes of a frame the image that a global
/// shutter would have taken at its middle, so that whatever comes after knows one pose a frame.
/// What a pixel shows is taken to lie on the mesh, or on the board's plane. Keeps its storage from
/// frame to frame.
class RowRectifier {
 public:
  /// The mesh, which outlives this, may be null: then all lies on the board. Nothing is done before
  /// the first frame in which something moved.
  RowRectifier(const capture::Session& session, const core::Mesh* mesh, int threads);

  /// The frame itself, untouched, where nothing moved. Else without luma (Frame::grey), and of the
  /// image's border what the sensor did not see repeats what it saw.
  capture::Frame rectify(const capture::Frame& frame, const Eigen::Isometry3d& camera_from_board,
                         const capture::Twist& readout_motion);

 private:
  /// What a rolling shutter does to a pixel: where it shows what a global one shows there, px, if
  /// that is infinitely far; how that place changes with the inverse depth, px m; and the inverse
  /// depth of the board, 1/m, 0 above its horizon.
  using Node = Eigen::Matrix<float, 5, 1>;

  void prepare();
  void see(const Eigen::Isometry3d& camera_from_board);
  void place_nodes(const Eigen::Isometry3d& camera_from_board,
                   const capture::Twist& readout_motion);
  void fill_map();
  [[nodiscard]] float inverse_depth_of_mesh(int x, int y) const;

  core::CameraModel camera_;
  Eigen::Isometry3d board_from_object_;
  const core::Mesh* mesh_;
  int threads_;
  std::size_t columns_ = 0, rows_ = 0;                ///< of the grid
  std::vector<std::optional<Eigen::Vector3d>> rays_;  ///< of its nodes, z = 1
  core::SurfacePoints points_;
  std::optional<core::DepthImage> depth_;
  core::VertexView view_;
  std::vector<Node> nodes_;  ///< of the grid, row by row
  cv::Mat map_;              ///< CV_32FC2
};

}  // namespace sheen::pipeline
