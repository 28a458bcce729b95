// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/session/session.h"
#include "core/mesh/mesh.h"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace sheen::capture {

/// The one place that states which sizes of board, object and camera positions fit each other.
/// Nobody can know the unit of a number in a file, but all must be of one scale: the object against
/// the board, the cameras outside of the object, and the object large enough in the images.
class SceneCheck {
 public:
  /// `mesh` is the session's, and the session has taken its offset. `board` is the one that gives
  /// the poses; null where they come from a file. All are borrowed.
  SceneCheck(const Session& session, const core::Mesh& mesh, const Board* board);

  /// What can be told before any image is looked at: throws core::Error (bad_input) for what cannot
  /// be, naming the file and the unit that would explain it; returns what is doubtful.
  [[nodiscard]] std::vector<std::string> check_sizes() const;

  /// Takes a posed view into account.
  void see(const Eigen::Isometry3d& camera_from_board);

  /// Views so far.
  [[nodiscard]] std::size_t views() const { return widths_px_.size(); }

  /// Throws core::Error (bad_input) when most views cannot be: cameras inside of the object, the
  /// object too small in the images to be an object at all. Nothing without views.
  void check_views() const;

  /// How large the object is and from how far it was seen, for messages.
  [[nodiscard]] std::string description() const;

  /// What is doubtful about the views, one line each.
  [[nodiscard]] std::vector<std::string> doubts() const;

 private:
  [[nodiscard]] double median_width_px() const;
  [[nodiscard]] double median_distance_m() const;
  [[nodiscard]] bool is_inside(const Eigen::Vector3d& camera_in_mesh) const;
  [[noreturn]] void refuse_small_object() const;
  [[noreturn]] void refuse_inside() const;

  const Session& session_;
  const Board* board_;
  Eigen::AlignedBox3d box_;  ///< of the mesh, in its own frame
  double size_m_ = 0;        ///< longest side of the box
  double diagonal_m_ = 0;
  std::vector<Eigen::Vector3d> directions_;  ///< unit vectors, spread evenly
  std::vector<double> supports_m_;           ///< farthest the mesh reaches along each
  std::vector<double> widths_px_;            ///< of the object in each view, about
  std::vector<double> distances_m_;          ///< of the camera from the object's middle
  std::size_t inside_ = 0;                   ///< views from inside of the mesh's convex hull
  std::size_t outside_ = 0;                  ///< views without the object's middle in the image
  double reach_m_ = 0;                       ///< farthest camera from the origin of the poses
};

}  // namespace sheen::capture
