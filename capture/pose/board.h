// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <filesystem>
#include <map>
#include <string>

namespace sheen::capture {

/// A rigid arrangement of tags: the board. Board frame: metres, z up out of the printed plane.
struct Board {
  struct Tag {
    double size_m = 0;  ///< side of the black square
    Eigen::Isometry3d board_from_tag =
        Eigen::Isometry3d::Identity();  ///< tag: x right, y up on the print

    /// Corners of the black square in the board frame: lower left, lower right, upper right,
    /// upper left of the tag as printed.
    [[nodiscard]] std::array<Eigen::Vector3d, 4> corners_in_board() const;
  };
  std::string family;   ///< libapriltag family ("tag36h11") or OpenCV dictionary ("DICT_6X6_250")
  int border_bits = 1;  ///< width of the black border; 2 for Kalibr's aprilgrid
  std::map<int, Tag> tags;  ///< by id
};

/// board.yaml: AprilTag bundle or Kalibr aprilgrid (docs/session-format.md). Throws core::Error
/// (bad_input): unknown family, duplicate ids, sizes that are not positive, nothing usable.
Board read_board(const std::filesystem::path& path);

/// Writes the bundle layout.
void write_board(const std::filesystem::path& path, const Board& board);

}  // namespace sheen::capture
