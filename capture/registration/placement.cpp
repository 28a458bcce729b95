// SPDX-License-Identifier: MIT
#include "capture/registration/placement.h"

#include "capture/files/text_file.h"
#include "core/diagnostics/error.h"
#include "core/geometry/principal_axes.h"
#include "core/mesh/bounds.h"


#include <algorithm>
#include <cmath>
#include <locale>
#include <optional>
#include <sstream>
#include <string>

namespace sheen::capture {
namespace {

constexpr std::size_t kMaxPlacementBytes = std::size_t{1} << 20;
constexpr std::size_t kMinPairs = 3;
constexpr double kFarthestM = 1e3;
constexpr double kNarrowest = 1e-3;  // width over length of points that lie on one line
constexpr const char* kRemedy =
    "write one pair a line: x y z in the mesh, x y z on the board, metres";

/// One line without its comment; no value for an empty one.
std::optional<PointPair> parse_line(std::string line, const std::filesystem::path& path,
                                    int number) {
  line.erase(std::min(line.find('#'), line.size()));
  std::istringstream in(line);
  in.imbue(std::locale::classic());
  if ((in >> std::ws).eof()) return std::nullopt;
  PointPair pair;
  for (Eigen::Vector3d* point : {&pair.in_object, &pair.in_board}) {
    for (int i = 0; i < 3; ++i) {
      if (!(in >> (*point)[i]) || !(std::abs((*point)[i]) <= kFarthestM)) {
        throw core::bad_input(path, "line " + std::to_string(number) + " holds no six numbers",
                              kRemedy);
      }
    }
  }
  if (!(in >> std::ws).eof()) {
    throw core::bad_input(path, "line " + std::to_string(number) + " holds more than six numbers",
                          kRemedy);
  }
  return pair;
}

}  // namespace

std::vector<PointPair> read_point_pairs(const std::filesystem::path& path) {
  std::istringstream lines(read_text_file(path, kMaxPlacementBytes));
  std::vector<PointPair> pairs;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    if (const auto pair = parse_line(line, path, ++number)) pairs.push_back(*pair);
  }
  if (pairs.size() < kMinPairs) throw core::bad_input(path, "holds fewer than 3 pairs", kRemedy);
  return pairs;
}

PairPlacement place_by_pairs(const std::vector<PointPair>& pairs,
                             const std::filesystem::path& path) {
  Eigen::Matrix3Xd object(3, static_cast<Eigen::Index>(pairs.size()));
  Eigen::Matrix3Xd board(3, object.cols());
  for (Eigen::Index i = 0; i < object.cols(); ++i) {
    object.col(i) = pairs[static_cast<std::size_t>(i)].in_object;
    board.col(i) = pairs[static_cast<std::size_t>(i)].in_board;
  }
  for (const Eigen::Matrix3Xd& points : {object, board}) {
    const Eigen::Vector3d spread = core::principal_axes(points).spread;
    if (!(spread[1] > kNarrowest * spread[0])) {
      throw core::bad_input(path, "holds points on one line", "pick three that span a triangle");
    }
  }
  PairPlacement placement;
  placement.board_from_object = Eigen::Isometry3d(Eigen::umeyama(object, board, false));
  placement.rms_m = std::sqrt((placement.board_from_object * object - board).squaredNorm() /
                              static_cast<double>(pairs.size()));
  return placement;
}

Eigen::Isometry3d place_upright(const core::Mesh& mesh, double turn_rad) {
  const Eigen::AlignedBox3d box = core::bounds_of(mesh).cast<double>();
  const Eigen::Vector3d foot(box.center().x(), box.center().y(), box.min().z());
  return Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(-foot);
}

}  // namespace sheen::capture
