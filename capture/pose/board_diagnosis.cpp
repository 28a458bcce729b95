// SPDX-License-Identifier: MIT
#include "capture/pose/board_diagnosis.h"

#include "capture/pose/board_tags.h"
#include "capture/pose/tag_places.h"
#include "core/numerics/median.h"

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <vector>

namespace sheen::capture {
namespace {

/// What people print, most usual first; a border of its own where the family has one.
struct Print {
  const char* family;
  int border_bits;
};
constexpr std::array<Print, 15> kUsualPrints{{{"tag36h11", 1},
                                              {"tag36h11", 2},
                                              {"tagStandard41h12", 1},
                                              {"tag25h9", 1},
                                              {"tagStandard52h13", 1},
                                              {"tagCircle21h7", 1},
                                              {"tagCustom48h12", 1},
                                              {"DICT_6X6_1000", 1},
                                              {"DICT_5X5_1000", 1},
                                              {"DICT_4X4_1000", 1},
                                              {"DICT_7X7_1000", 1},
                                              {"DICT_ARUCO_ORIGINAL", 1},
                                              {"DICT_APRILTAG_36h11", 1},
                                              {"DICT_APRILTAG_25h9", 1},
                                              {"tag36h10", 1}}};
constexpr std::size_t kFewTags = 3;  // of one family in an image: what noise decodes to is fewer

using Points = std::vector<cv::Point2d>;

/// Plane-to-image maps say whether tags lie as a board says, whatever the lens.
double homography_rms(const Points& plane, const Points& image, cv::Mat& H) {
  H = cv::findHomography(plane, image, 0);
  if (H.empty()) return 1e9;
  Points mapped;
  cv::perspectiveTransform(plane, mapped, H);
  double sum = 0;
  for (std::size_t i = 0; i < mapped.size(); ++i) {
    sum += (mapped[i] - image[i]).ddot(mapped[i] - image[i]);
  }
  return std::sqrt(sum / static_cast<double>(mapped.size()));
}

cv::Point2d point_of(const Eigen::Vector2d& p) {
  return {p.x(), p.y()};
}

/// Where the diagonals of a tag cross: its centre in the image.
Eigen::Vector2d centre_of(const std::array<Eigen::Vector2d, 4>& c) {
  const Eigen::Vector2d a = c[2] - c[0], b = c[3] - c[1], between = c[1] - c[0];
  const double cross = a.x() * b.y() - a.y() * b.x();
  if (std::abs(cross) < 1e-9) return (c[0] + c[1] + c[2] + c[3]) / 4;
  return c[0] + a * (between.x() * b.y() - between.y() * b.x()) / cross;
}

}  // namespace

struct BoardDiagnosis::Impl {
  Impl(const Board& given, const core::CameraModel& lens)
      : board(given), camera(lens), finder(given, lens) {
    is_flat = std::all_of(board.tags.begin(), board.tags.end(), [](const auto& entry) {
      return entry.second.board_from_tag.linear()(2, 2) > 0.99 &&
             std::abs(entry.second.board_from_tag.translation().z()) < 0.2 * entry.second.size_m;
    });
  }

  void look_for_others(const cv::Mat& grey);
  void look_from_behind(const cv::Mat& grey);
  [[nodiscard]] std::size_t known_in(const cv::Mat& grey) const;
  void compare(const std::vector<TagDetection>& tags);

  Board board;
  core::CameraModel camera;
  BoardTagFinder finder;
  bool is_flat = false;
  int images = 0, images_with_tags = 0;
  int images_mirrored = 0, images_inverted = 0, images_repeated = 0;
  std::vector<std::vector<TagDetection>> views;  ///< all tags of the family, each once
  std::set<int> strangers;            ///< ids of the board's family that it does not hold
  std::map<std::string, int> others;  ///< images that show tags of another print
  std::vector<double> sizes;          ///< seen size over stated size, from the tags' distances
  std::vector<double> turns_deg;      ///< of tags as seen against as stated
  std::vector<double> mirrored;       ///< 1 where a tag is seen from behind the board's plane
  std::vector<double> layout_px;      ///< rms of a homography over all corners, in the raw image
  std::vector<double> apart;          ///< centres off any plane, tag sides: more than lenses bend
  std::vector<double> straight_px;    ///< the same with the lens' distortion taken out
};

/// Tags of the board in another picture of the same frame.
std::size_t BoardDiagnosis::Impl::known_in(const cv::Mat& grey) const {
  const auto tags = drop_ambiguous(TagDetector(finder.family()).detect(grey));
  return static_cast<std::size_t>(
      std::count_if(tags.begin(), tags.end(),
                    [this](const TagDetection& tag) { return board.tags.contains(tag.id); }));
}

/// Pictures of selfie cameras are mirrored, prints of some programs white on black.
void BoardDiagnosis::Impl::look_from_behind(const cv::Mat& grey) {
  cv::Mat other;
  cv::flip(grey, other, 1);
  images_mirrored += known_in(other) >= kFewTags ? 1 : 0;
  cv::bitwise_not(grey, other);
  images_inverted += known_in(other) >= kFewTags ? 1 : 0;
}

void BoardDiagnosis::Impl::look_for_others(const cv::Mat& grey) {
  for (const Print& print : kUsualPrints) {
    if (board.family == print.family && board.border_bits == print.border_bits) continue;
    const auto family = find_tag_family(print.family, print.border_bits);
    const bool is_small_code = family && family->library == TagFamily::Library::aruco;
    if (!family || drop_ambiguous(TagDetector(*family, 0).detect(grey)).size() <
                       (is_small_code ? 2 * kFewTags : kFewTags)) {
      continue;
    }
    ++others[fmt::format("{} with a border of {} {}", print.family, print.border_bits,
                         print.border_bits == 1 ? "bit" : "bits")];
    return;
  }
}

void BoardDiagnosis::Impl::compare(const std::vector<TagDetection>& tags) {
  Points centres_plane, centres_image, corners_plane, corners_image, corners_straight;
  for (const TagDetection& tag : tags) {
    const Board::Tag& stated = board.tags.at(tag.id);
    const Eigen::Vector3d centre = stated.board_from_tag.translation();
    centres_plane.emplace_back(centre.x(), centre.y());
    centres_image.push_back(point_of(centre_of(tag.corners_px)));
    const auto corners = stated.corners_in_board();
    for (std::size_t c = 0; c < 4; ++c) {
      corners_plane.emplace_back(corners[c].x(), corners[c].y());
      corners_image.push_back(point_of(tag.corners_px[c]));
      const auto ray = camera.unproject(tag.corners_px[c]);
      const Eigen::Vector2d straight =
          ray ? Eigen::Vector2d(ray->head<2>().cwiseProduct(camera.intrinsics().focal_px))
              : Eigen::Vector2d(tag.corners_px[c]);
      corners_straight.push_back(point_of(straight));
    }
  }
  cv::Mat H;
  layout_px.push_back(homography_rms(corners_plane, corners_image, H));
  straight_px.push_back(homography_rms(corners_plane, corners_straight, H));
  if (tags.size() < 5) return;

  // From the centres alone: do they lie so at all, and how large, how turned do the tags look?
  const double off_px = homography_rms(centres_plane, centres_image, H);
  apart.push_back(off_px / cv::norm(corners_image[1] - corners_image[0]));
  if (H.empty()) return;
  Points mapped;
  cv::perspectiveTransform(corners_image, mapped, H.inv());
  for (std::size_t t = 0; t < tags.size(); ++t) {
    const cv::Point2d side = mapped[4 * t + 1] - mapped[4 * t];
    const cv::Point2d up = mapped[4 * t + 3] - mapped[4 * t];
    const cv::Point2d stated = corners_plane[4 * t + 1] - corners_plane[4 * t];
    const double size_m = std::sqrt(std::abs(side.cross(up)));
    sizes.push_back(size_m / board.tags.at(tags[t].id).size_m);
    mirrored.push_back(side.cross(up) < 0 ? 1 : 0);
    double turn = std::atan2(stated.cross(side), stated.ddot(side)) * 180 / std::numbers::pi;
    turns_deg.push_back(turn < -45 ? turn + 360 : turn);
  }
}

BoardDiagnosis::BoardDiagnosis(const Board& board, const core::CameraModel& camera)
    : impl_(std::make_unique<Impl>(board, camera)) {}
BoardDiagnosis::~BoardDiagnosis() = default;

void BoardDiagnosis::look_at(const Frame& frame) {
  ++impl_->images;
  const cv::Mat& grey = impl_->finder.look_at(frame);
  const auto all = TagDetector(impl_->finder.family()).detect(grey);
  for (const TagDetection& tag : all) {
    if (!impl_->board.tags.contains(tag.id)) impl_->strangers.insert(tag.id);
  }
  impl_->views.push_back(drop_ambiguous(all));
  const std::vector<TagDetection> known = impl_->finder.find();
  std::set<int> ids;
  for (const TagDetection& tag : all) ids.insert(tag.id);
  if (all.size() >= ids.size() + kFewTags) ++impl_->images_repeated;
  if (known.empty() && ids.size() < kFewTags) {
    impl_->look_from_behind(grey);
    impl_->look_for_others(grey);
  }
  if (!known.empty()) ++impl_->images_with_tags;
  if (known.size() >= 2 && impl_->is_flat) impl_->compare(known);
}

PoseCause BoardDiagnosis::cause(PoseRejection refusal) const {
  const Impl& seen = *impl_;
  const std::string family =
      seen.board.border_bits == 1
          ? seen.board.family
          : fmt::format("{} with a border of {} bits", seen.board.family, seen.board.border_bits);
  if (refusal == PoseRejection::blur) {
    return {PoseSuspect::recording, "the images are smeared: the edges of the tags are too wide",
            "record more slowly or with shorter exposure, or raise --max-blur"};
  }
  if (seen.images_repeated > seen.images / 2) {
    return {PoseSuspect::recording, "its images show the same tags more than once",
            "print every id once, on one board"};
  }
  if (seen.images_with_tags == 0 && seen.images_mirrored > 0) {
    return {PoseSuspect::recording,
            "its images are mirrored: the board's tags are there in a mirror",
            "switch the camera's mirroring off, or print the board the right way round"};
  }
  if (seen.images_with_tags == 0 && seen.images_inverted > 0) {
    return {PoseSuspect::recording, "its images show the board's tags white on black",
            "print them black on white"};
  }
  if (seen.images_with_tags == 0) {
    if (!seen.others.empty()) {
      const auto most =
          std::max_element(seen.others.begin(), seen.others.end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
      return {PoseSuspect::board,
              fmt::format("holds tags of {}, the images show tags of {}", family, most->first),
              "give the board.yaml of the board in the images (tag_family, border_bits)"};
    }
    if (seen.strangers.size() >= kFewTags) {
      return {PoseSuspect::board,
              fmt::format("holds none of the tags in the images (ids {}, ...)",
                          *seen.strangers.begin()),
              "give the board.yaml of the board in the images"};
    }
    return {
        PoseSuspect::recording, fmt::format("its images show no tag of {}", family),
        "check that board.yaml describes the printed board and that the board is in view, sharp "
        "and lit",
        false};
  }
  if (refusal == PoseRejection::too_few_tags || refusal == PoseRejection::no_tags) {
    return {PoseSuspect::recording, "its images show too few tags of the board at a time",
            "keep more of the board in view, or lower --min-tags", false};
  }

  // Tags are there but do not fit. Which file is it?
  if (const auto fault = shifted_ids(seen.board, seen.camera, seen.views)) {
    return {PoseSuspect::board, fault->fault, fault->remedy};
  }
  auto apart = seen.apart;
  if (!apart.empty() && core::upper_median(apart) > 1) {
    return {PoseSuspect::board,
            "its tags lie in another order than on the print: their places do not fit each other",
            "give the board.yaml of this print, or correct its ids"};
  }
  auto sizes = seen.sizes, turns = seen.turns_deg, mirrored = seen.mirrored;
  auto layout = seen.layout_px, straight = seen.straight_px;
  if (!mirrored.empty() && core::upper_median(mirrored) > 0.5) {
    return {PoseSuspect::board, "places the tags mirrored against the images",
            "x runs to the right and y up on the print, seen from the front"};
  }
  if (!turns.empty()) {
    const double quarters = core::upper_median(turns) / 90;
    if (std::lround(quarters) != 0 && std::abs(quarters - std::round(quarters)) < 0.1) {
      return {
          PoseSuspect::board,
          fmt::format("its tags are turned by {:.0f} degrees against the images",
                      90 * std::round(quarters)),
          "turn them by qw, qx, qy, qz, or take the family's other library (DICT_APRILTAG_...)"};
    }
  }
  if (!sizes.empty()) {
    const double ratio = core::upper_median(sizes);
    if (ratio > 1.04 || ratio < 0.96) {
      return {PoseSuspect::board,
              fmt::format("its tags look {:.2f} times as large as size says, against the distances "
                          "by x and y",
                          ratio),
              "measure size over the black square's outer edges (tagSpacing: the gap over that)"};
    }
  }
  if (!layout.empty()) {
    const double raw_px = core::upper_median(layout), straight_px = core::upper_median(straight);
    if (straight_px > 2 && raw_px < 0.5 * straight_px) {
      return {PoseSuspect::camera,
              "its distortion does not fit the images: the board lies straighter without it",
              "give the camera file of this lens; is it a fisheye calibration?"};
    }
    if (std::min(raw_px, straight_px) < 1.5) {
      return {PoseSuspect::camera, "its focal length or principal point does not fit the images",
              "give the camera file of this camera at this image size, not cropped or zoomed"};
    }
  }
  return {PoseSuspect::board,
          "the tags do not lie in the images as it says, or camera.yaml is of another lens",
          "check x, y and size of the tags, and that camera.yaml was made with this camera", false};
}

}  // namespace sheen::capture
