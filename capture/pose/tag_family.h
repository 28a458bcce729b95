// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace sheen::capture {

/// Which library reads a board's tags, and how wide their black square is.
struct TagFamily {
  enum class Library { apriltag, aruco };
  Library library = Library::apriltag;
  std::string name;              ///< name within that library
  int aruco_dictionary_id = -1;  ///< cv::aruco::PREDEFINED_DICTIONARY_NAME, -1 for libapriltag
  /// OpenCV's AprilTag dictionaries print every code turned by 180 degrees against libapriltag. Set
  /// where corners found by OpenCV must be counted as libapriltag would.
  bool half_turn = false;
  int modules = 8;  ///< bits across the black square, both borders included
};

/// Looks a family up by the name that stands in board.yaml: one of libapriltag's ("tag36h11") or an
/// OpenCV ArUco dictionary ("DICT_6X6_250"). libapriltag knows one-bit borders only; wider ones of
/// the families that OpenCV has too are read by OpenCV. No value for an unknown name or a border
/// that neither library reads.
std::optional<TagFamily> find_tag_family(const std::string& name, int border_bits);

/// Number of codes: ids run from 0 to this minus one.
int code_count(const TagFamily& family);

}  // namespace sheen::capture
