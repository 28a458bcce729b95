// SPDX-License-Identifier: MIT
#include "capture/plausibility/scene_check.h"

#include "capture/plausibility/board_check.h"
#include "capture/plausibility/unit_guess.h"
#include "core/diagnostics/error.h"
#include "core/mesh/bounds.h"
#include "core/numerics/median.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sheen::capture {
namespace {

constexpr double kTagPerObject = 10;    // a board whose tags are larger shows nothing of the object
constexpr double kObjectPerBoard = 20;  // an object as much larger than its board hides it
constexpr double kDoubtfulBoard = 60;   // boards over object: a grain of sand on a sheet
constexpr double kReach = 10;           // sizes of board and object between them
constexpr double kFewPixels = 12;       // across the object: nothing to see
constexpr double kDoubtfulPixels = 40;
constexpr double kUsualPrint_m = 0.3;  // tags above it are no sheets of paper
constexpr double kTinyObject_m = 0.005;
constexpr double kNearestFocus_m = 0.06;  // nobody holds a camera nearer
constexpr int kDirections = 128;
constexpr std::size_t kMostVertices = 100'000;

/// Spread evenly over the sphere, by the golden angle.
std::vector<Eigen::Vector3d> spread_directions() {
  std::vector<Eigen::Vector3d> directions;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2 * i + 1) / static_cast<double>(kDirections);
    const double r = std::sqrt(1 - z * z);
    directions.emplace_back(r * std::cos(golden * i), r * std::sin(golden * i), z);
  }
  return directions;
}

std::string name_of(const std::filesystem::path& path) {
  return path.filename().string();
}

}  // namespace

SceneCheck::SceneCheck(const Session& session, const core::Mesh& mesh, const Board* board)
    : session_(session),
      board_(board),
      box_(core::bounds_of(mesh).cast<double>()),
      size_m_(box_.sizes().maxCoeff()),
      diagonal_m_(box_.diagonal().norm()),
      directions_(spread_directions()) {
  supports_m_.assign(directions_.size(), -1e300);
  const std::size_t stride = 1 + mesh.positions.size() / kMostVertices;
  for (std::size_t i = 0; i < mesh.positions.size(); i += stride) {
    const Eigen::Vector3d position = mesh.positions[i].cast<double>();
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      supports_m_[d] = std::max(supports_m_[d], directions_[d].dot(position));
    }
  }
}

std::vector<std::string> SceneCheck::check_sizes() const {
  if (board_ == nullptr || !session_.board) return {};
  // Tags against each other, against the object, against what can be printed.
  const double tag_m = typical_tag_m(*board_);
  const double extent_m = board_extent_m(*board_);
  std::vector<std::string> doubts = check_tag_layout(*board_, *session_.board);
  const std::string tag =
      fmt::format("a tag is {} wide and the object {}", length_text(tag_m), length_text(size_m_));
  const std::string question =
      unit_question(extent_m, 0.7 * size_m_, 8 * size_m_, "give board and mesh in metres");
  if (tag_m > kTagPerObject * size_m_ && tag_m > kUsualPrint_m) {
    throw core::bad_input(*session_.board, tag, question);
  }
  if (tag_m > kTagPerObject * size_m_ && size_m_ < kTinyObject_m) {
    throw core::bad_input(session_.mesh, tag, "scale the mesh to its true size in metres");
  }
  for (std::string& doubt : check_tag_size(*board_, *session_.board)) {
    doubts.push_back(std::move(doubt));
  }
  for (std::string& doubt : doubts) doubt = fmt::format("{}: {}", session_.board->string(), doubt);
  if (size_m_ > kObjectPerBoard * extent_m) {
    throw core::bad_input(
        session_.mesh,
        fmt::format("the object is {} across and the board {}", length_text(size_m_),
                    length_text(extent_m)),
        unit_question(size_m_, 0.05 * extent_m, 3 * extent_m, "give board and mesh in metres"));
  }
  if (extent_m > kDoubtfulBoard * size_m_) {
    doubts.push_back(fmt::format("{}: {}; {}", session_.board->string(), tag, question));
  }

  // The place of the object on it.
  Eigen::AlignedBox3d board_box;
  for (const auto& [id, entry] : board_->tags) {
    board_box.extend(entry.board_from_tag.translation());
  }
  const double away_m = (session_.board_from_object * box_.center() - board_box.center()).norm();
  const double reach_m = extent_m + diagonal_m_;
  if (away_m > kReach * reach_m) {
    throw core::bad_input(
        session_.folder / "session.json",
        fmt::format("T_stage_object puts the object {} from the middle of a board {} across",
                    length_text(away_m), length_text(extent_m)),
        session_.mesh_offset.isZero()
            ? unit_question(away_m, 0.01 * reach_m, reach_m, "give the place in metres") +
                  " (translation of T_stage_object)"
            : fmt::format("the mesh lies {} from its own origin: T_stage_object must bring it here",
                          length_text(session_.mesh_offset.norm())));
  }
  return doubts;
}

bool SceneCheck::is_inside(const Eigen::Vector3d& camera_in_mesh) const {
  for (std::size_t d = 0; d < directions_.size(); ++d) {
    if (directions_[d].dot(camera_in_mesh) > supports_m_[d]) return false;
  }
  return true;
}

void SceneCheck::see(const Eigen::Isometry3d& camera_from_board) {
  const Eigen::Isometry3d camera_from_mesh = camera_from_board * session_.board_from_object;
  const double distance_m = (camera_from_mesh * box_.center()).norm();
  const double focal_px = session_.camera.intrinsics().focal_px.mean();
  distances_m_.push_back(distance_m);
  widths_px_.push_back(focal_px * diagonal_m_ / std::max(distance_m, diagonal_m_ / 2));
  if (is_inside(camera_from_mesh.inverse().translation())) ++inside_;
  const auto middle = session_.camera.project(camera_from_mesh * box_.center());
  const Eigen::AlignedBox2d image(
      Eigen::Vector2d(0, 0),
      Eigen::Vector2d(session_.camera.width_px() - 1, session_.camera.height_px() - 1));
  if (!middle || !image.contains(*middle)) ++outside_;
  reach_m_ = std::max(reach_m_, camera_from_board.inverse().translation().norm());
}

double SceneCheck::median_width_px() const {
  auto widths = widths_px_;
  return core::upper_median(widths);
}

double SceneCheck::median_distance_m() const {
  auto distances = distances_m_;
  return core::upper_median(distances);
}

void SceneCheck::refuse_small_object() const {
  const std::string small =
      fmt::format("the object, {} across, is {:.2g} pixels wide in the images",
                  length_text(size_m_), median_width_px());
  const double distance_m = median_distance_m();
  const double least_m = 0.6 * diagonal_m_, most_m = 15 * diagonal_m_;
  if (board_ != nullptr && session_.board) {
    const double tag_m = typical_tag_m(*board_);
    throw core::bad_input(
        tag_m > kUsualPrint_m || tag_m > size_m_ ? *session_.board : session_.mesh,
        fmt::format("{}, seen from {} over tags {} wide", small, length_text(distance_m),
                    length_text(tag_m)),
        unit_question(distance_m, least_m, most_m, "give board and mesh in metres"));
  }
  // The cameras stand round their origin and the object was put far from it.
  const double away_m = (session_.board_from_object * box_.center()).norm();
  if (away_m > kReach * (reach_m_ + diagonal_m_)) {
    throw core::bad_input(
        session_.folder / "session.json",
        fmt::format("{}: T_stage_object puts it {} from the origin of the poses, the cameras {}",
                    small, length_text(away_m), length_text(reach_m_)),
        unit_question(away_m, 0.01 * reach_m_, reach_m_, "give the place in metres") +
            " (translation of T_stage_object)");
  }
  throw core::bad_input(
      session_.poses.value_or(session_.folder),
      fmt::format("{}, seen from {}", small, length_text(distance_m)),
      unit_question(distance_m, least_m, most_m,
                    "poses and mesh must be of one scale, metres: give the poses the mesh's"));
}

void SceneCheck::refuse_inside() const {
  const double distance_m = median_distance_m();
  const std::string fault = fmt::format(
      "the camera stands inside of the object in {} of {} views: the object is {} "
      "across and the camera {} from its middle",
      inside_, views(), length_text(size_m_), length_text(distance_m));
  if (distance_m < kNearestFocus_m) {
    throw core::bad_input(board_ != nullptr && session_.board
                              ? *session_.board
                              : session_.poses.value_or(session_.folder),
                          fault,
                          board_ != nullptr ? "give the tags' sizes and places in metres"
                                            : "give the poses in metres, in the scale of the mesh");
  }
  throw core::bad_input(
      session_.mesh, fault,
      unit_question(size_m_, 0.15 * distance_m, 1.6 * distance_m,
                    board_ != nullptr
                        ? "check T_stage_object, and that board and mesh are in metres"
                        : "check T_stage_object, and that poses and mesh are of one scale"));
}

void SceneCheck::check_views() const {
  if (views() == 0) return;
  if (2 * inside_ > views()) refuse_inside();
  if (median_width_px() < kFewPixels) refuse_small_object();
}

std::string SceneCheck::description() const {
  if (views() == 0) return "the object is " + length_text(size_m_) + " across";
  return fmt::format("the object is {} across and the camera {} from its middle",
                     length_text(size_m_), length_text(median_distance_m()));
}

std::vector<std::string> SceneCheck::doubts() const {
  std::vector<std::string> doubts;
  if (views() == 0) return doubts;
  if (inside_ > 0) {
    doubts.push_back(fmt::format(
        "{}: the camera stands inside of the object's hull in {} of {} views; is the object where "
        "T_stage_object says, and of that size?",
        name_of(session_.mesh), inside_, views()));
  }
  if (2 * outside_ > views()) {
    doubts.push_back(
        fmt::format("{}: the middle of the object is outside of the image in {} of {} views; are "
                    "T_stage_object and the poses right?",
                    name_of(session_.mesh), outside_, views()));
  }
  const double width_px = median_width_px();
  if (width_px < kDoubtfulPixels) {
    doubts.push_back(
        fmt::format("{}: the object, {} across, is only {:.0f} pixels wide in the images; are all "
                    "files in metres?",
                    name_of(session_.mesh), length_text(size_m_), width_px));
  }
  return doubts;
}

}  // namespace sheen::capture
