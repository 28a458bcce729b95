// SPDX-License-Identifier: MIT
#include "evaluation/stress/stress_recording.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace sheen::evaluation {
namespace {

using Damage = std::function<void(StressRecording&, double)>;

Eigen::Isometry3d between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double t) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() =
      Eigen::Quaterniond(a.linear()).slerp(t, Eigen::Quaterniond(b.linear())).toRotationMatrix();
  pose.translation() = (1 - t) * a.translation() + t * b.translation();
  return pose;
}

/// Where a pixel of `now` lies in the image taken from `taken`, by the plane z = 0 of the board;
/// itself where the ray meets no board. What stands above the board moves as if it lay on it.
cv::Point2f off_the_board(const core::CameraModel& camera, const Eigen::Isometry3d& now,
                          const Eigen::Isometry3d& taken, cv::Point pixel) {
  const cv::Point2f same(static_cast<float>(pixel.x), static_cast<float>(pixel.y));
  const auto ray = camera.unproject({pixel.x, pixel.y});
  if (!ray) return same;
  const Eigen::Vector3d direction = now.linear() * *ray;
  if (direction.z() > -1e-6) return same;
  const Eigen::Vector3d point =
      now.translation() - now.translation().z() / direction.z() * direction;
  const auto seen = camera.project(taken.inverse() * point);
  return seen ? cv::Point2f(seen->cast<float>().x(), seen->cast<float>().y()) : same;
}

/// The share of the way to the next frame on which the board's middle moves by `px`; the direction
/// of the walk with it. At most one, which is as far as the truth reaches.
double share_of_step(const StressRecording& recording, std::size_t i, double px) {
  const auto& poses = recording.board_from_camera;
  const auto a = recording.camera.project(poses[i].inverse() * Eigen::Vector3d::Zero());
  const auto b = recording.camera.project(between(poses[i], poses[i + 1], 0.1).inverse() *
                                          Eigen::Vector3d(0.1, 0, 0));
  const auto a_side = recording.camera.project(poses[i].inverse() * Eigen::Vector3d(0.1, 0, 0));
  if (!a || !b || !a_side) return 0;
  return std::min(1.0, 0.1 * px / std::max((*b - *a_side).norm(), 1e-3));
}

/// The image as it would be had row y been taken at `when(y)`, in steps to the next frame.
cv::Mat retaken(const StressRecording& recording, std::size_t i,
                const std::function<double(int row)>& when) {
  const cv::Mat& light = recording.light[i];
  const Eigen::Isometry3d& taken = recording.board_from_camera[i];
  const Eigen::Isometry3d& next = recording.board_from_camera[i + 1];
  cv::Mat map(light.size(), CV_32FC2);
  for (int y = 0; y < light.rows; ++y) {
    const Eigen::Isometry3d now = between(taken, next, when(y));
    for (int x = 0; x < light.cols; ++x) {
      map.at<cv::Point2f>(y, x) = off_the_board(recording.camera, now, taken, {x, y});
    }
  }
  cv::Mat image;
  cv::remap(light, image, map, {}, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return image;
}

void for_each_moving(StressRecording& recording,
                     const std::function<cv::Mat(std::size_t frame)>& make) {
  std::vector<cv::Mat> images = recording.light;
  for (std::size_t i = 0; i + 1 < images.size(); ++i) images[i] = make(i);
  recording.light = std::move(images);
}

void blur_by_motion(StressRecording& recording, double px) {
  constexpr int shutter_steps = 7;
  for_each_moving(recording, [&](std::size_t i) {
    const double share = share_of_step(recording, i, px);
    cv::Mat sum = cv::Mat::zeros(recording.light[i].size(), CV_32FC3);
    for (int k = 0; k < shutter_steps; ++k) {
      const double t = share * (static_cast<double>(k) / (shutter_steps - 1) - 0.5);
      sum += retaken(recording, i, [t](int) { return t; });
    }
    return cv::Mat(sum / shutter_steps);
  });
}

void roll_shutter(StressRecording& recording, double px) {
  for_each_moving(recording, [&](std::size_t i) {
    const double share = share_of_step(recording, i, px);
    const double rows = recording.light[i].rows;
    return retaken(recording, i, [&](int y) { return share * (y / rows - 0.5); });
  });
}

void defocus(StressRecording& recording, double sigma_px) {
  for (cv::Mat& light : recording.light) {
    cv::Mat blurred;
    cv::GaussianBlur(light, blurred, {}, sigma_px);
    light = blurred;
  }
}

/// Less light, amplified: `stops` halvings of what the sensor collects.
void take_light(StressRecording& recording, double stops) {
  const auto gain = static_cast<float>(std::exp2(stops));
  recording.noise.read *= gain;
  recording.noise.shot *= gain;
}

/// Gains drift as one slow wave over the recording, from -amplitude to amplitude, in stops; each
/// channel by its own share.
Damage drift_of(const cv::Vec3d& shares) {
  return [shares](StressRecording& recording, double stops) {
    const auto frames = static_cast<double>(recording.light.size());
    for (std::size_t i = 0; i < recording.light.size(); ++i) {
      const double wave = stops * std::sin(2 * std::numbers::pi * static_cast<double>(i) / frames);
      cv::Scalar gains;
      for (int channel = 0; channel < 3; ++channel)
        gains[channel] = std::exp2(wave * shares[channel]);
      cv::Mat light;
      cv::multiply(recording.light[i], gains, light);
      recording.light[i] = light;
    }
  };
}

void change_first_radial_term(StressRecording& recording, double change) {
  auto intrinsics = recording.camera.intrinsics();
  intrinsics.distortion[0] += change;
  recording.camera = core::CameraModel(intrinsics);
}

void change_focal_length(StressRecording& recording, double percent) {
  auto intrinsics = recording.camera.intrinsics();
  intrinsics.focal_px *= 1 + percent / 100;
  recording.camera = core::CameraModel(intrinsics);
}

void shift_principal_point(StressRecording& recording, double px) {
  auto intrinsics = recording.camera.intrinsics();
  intrinsics.principal_px.x() += px;
  recording.camera = core::CameraModel(intrinsics);
}

/// The file says that the board is a bowl, the print is flat; relative to each other it is the
/// same.
void curl_board(StressRecording& recording, double rise_m) {
  double farthest = 0;
  for (const auto& [id, tag] : recording.board.tags) {
    farthest = std::max(farthest, tag.board_from_tag.translation().head<2>().norm());
  }
  for (auto& [id, tag] : recording.board.tags) {
    const double r = tag.board_from_tag.translation().x() / farthest;
    tag.board_from_tag.translation().z() += rise_m * r * r;
  }
}

void keep_tags(StressRecording& recording, double count) {
  auto& tags = recording.board.tags;
  tags.erase(
      std::next(tags.begin(), std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(count),
                                                       static_cast<std::ptrdiff_t>(tags.size()))),
      tags.end());
}

/// Where a camera sees points of the board's frame; those that it does not see are left out.
std::vector<cv::Point2f> pixels_of(const StressRecording& recording, std::size_t frame,
                                   const std::vector<Eigen::Vector3d>& in_board) {
  const Eigen::Isometry3d camera_from_board = recording.board_from_camera[frame].inverse();
  std::vector<cv::Point2f> pixels;
  for (const Eigen::Vector3d& point : in_board) {
    const auto seen = recording.camera.project(camera_from_board * point);
    if (seen) pixels.emplace_back(static_cast<float>(seen->x()), static_cast<float>(seen->y()));
  }
  return pixels;
}

/// The corners of a sheet over the tag, half as large again, board frame.
std::vector<Eigen::Vector3d> sheet_over(const capture::Board::Tag& tag) {
  const Eigen::Vector3d middle = tag.board_from_tag.translation();
  std::vector<Eigen::Vector3d> corners;
  for (const Eigen::Vector3d& corner : tag.corners_in_board()) {
    corners.push_back(middle + 1.5 * (corner - middle));
  }
  return corners;
}

/// Grey paper on all tags but the first `count` in every second frame; none over the object.
void cover_tags(StressRecording& recording, double count) {
  std::vector<Eigen::Vector3d> object;
  for (const Eigen::Vector3f& position : recording.mesh.positions) {
    object.push_back(recording.board_from_object * position.cast<double>());
  }
  const auto& tags = recording.board.tags;
  const auto first = std::next(tags.begin(), std::min(static_cast<std::ptrdiff_t>(count),
                                                      static_cast<std::ptrdiff_t>(tags.size())));
  for (std::size_t i = 0; i < recording.light.size(); i += 2) {
    cv::Mat light = recording.light[i].clone();
    const auto object_pixels = pixels_of(recording, i, object);
    for (auto tag = first; tag != tags.end(); ++tag) {
      const auto corners = pixels_of(recording, i, sheet_over(tag->second));
      if (corners.size() < 4) continue;
      const bool is_behind_object = std::ranges::any_of(object_pixels, [&](const auto& pixel) {
        return cv::pointPolygonTest(corners, pixel, false) >= 0;
      });
      if (is_behind_object) continue;
      const std::vector<cv::Point> square(corners.begin(), corners.end());  // rounded
      cv::fillConvexPoly(light, square, {0.4, 0.4, 0.4});
    }
    recording.light[i] = light;
  }
}

/// An ellipse of skin across the object's middle in every second frame; `share` of the image's
/// height is its half length.
void hold_hand_in_front(StressRecording& recording, double share) {
  for (std::size_t i = 0; i < recording.light.size(); i += 2) {
    cv::Mat light = recording.light[i].clone();
    const int length = static_cast<int>(share * light.rows);
    cv::ellipse(light, {light.cols / 2 - length / 2, light.rows / 2}, {length, length / 2},
                10.0 * static_cast<double>(i), 0, 360, {0.45, 0.25, 0.18}, cv::FILLED);
    recording.light[i] = light;
  }
}

/// From the middle on the object lies elsewhere than the poses say: the poses come from a file,
/// moved the other way.
void nudge_object(StressRecording& recording, double distance_m) {
  recording.posed_from_file = recording.board_from_camera;
  for (std::size_t i = recording.light.size() / 2; i < recording.light.size(); ++i) {
    recording.posed_from_file[i].pretranslate(Eigen::Vector3d(distance_m, 0, 0));
  }
}

void scale_mesh(StressRecording& recording, double percent) {
  for (Eigen::Vector3f& position : recording.mesh.positions) {
    position *= static_cast<float>(1 + percent / 100);
  }
}

void shift_mesh(StressRecording& recording, double metres) {
  for (Eigen::Vector3f& position : recording.mesh.positions) {
    position.x() += static_cast<float>(metres);
  }
}

/// Rounds of the umbrella operator: every vertex to the mean of its neighbours.
void smooth_mesh(StressRecording& recording, double rounds) {
  core::Mesh& mesh = recording.mesh;
  for (int round = 0; round < static_cast<int>(rounds); ++round) {
    std::vector<Eigen::Vector3f> sums(mesh.positions.size(), Eigen::Vector3f::Zero());
    std::vector<float> counts(mesh.positions.size(), 0);
    for (const auto& triangle : mesh.triangles) {
      for (int corner = 0; corner < 3; ++corner) {
        const auto from = triangle[corner], to = triangle[(corner + 1) % 3];
        sums[from] += mesh.positions[to];
        counts[from] += 1;
      }
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
      if (counts[i] > 0) mesh.positions[i] = sums[i] / counts[i];
    }
  }
}

void keep_frames(StressRecording& recording, const std::function<bool(std::size_t)>& is_kept) {
  StressRecording kept = recording;
  kept.light.clear();
  kept.board_from_camera.clear();
  for (std::size_t i = 0; i < recording.light.size(); ++i) {
    if (!is_kept(i)) continue;
    kept.light.push_back(recording.light[i]);
    kept.board_from_camera.push_back(recording.board_from_camera[i]);
  }
  recording = std::move(kept);
}

void keep_count(StressRecording& recording, double count) {
  const std::size_t all = recording.light.size();
  const auto wanted = std::min(static_cast<std::size_t>(count), all);
  keep_frames(recording, [=](std::size_t i) { return (i + 1) * wanted / all != i * wanted / all; });
}

void keep_side(StressRecording& recording, double degrees) {
  keep_frames(recording, [&](std::size_t i) {
    const Eigen::Vector3d eye = recording.board_from_camera[i].translation();
    return std::abs(std::atan2(eye.y(), eye.x())) <= degrees / 360 * std::numbers::pi;
  });
}

}  // namespace

std::vector<StressKind> stress_kinds() {
  return {
      {"none", "", {0}, [](StressRecording&, double) {}},
      {"motion-blur", "px", {2, 5, 10, 20}, blur_by_motion},
      {"low-light", "stops less", {2, 4, 6}, take_light},
      {"exposure-drift", "stops", {0.1, 0.3, 1}, drift_of({1, 1, 1})},
      {"white-balance-drift", "stops", {0.1, 0.3, 1}, drift_of({1, 0, -1})},
      {"rolling-shutter", "px over the image", {2, 5, 10, 20}, roll_shutter},
      {"defocus", "px sigma", {1, 2, 4}, defocus},
      {"lens", "error of k1", {0.03, 0.1, 0.3}, change_first_radial_term},
      {"focal-length", "%", {1, 3, 10}, change_focal_length},
      {"principal-point", "px", {2, 6, 20}, shift_principal_point},
      {"curled-board", "m rise at the edge", {0.002, 0.005, 0.015}, curl_board},
      {"tags-left", "tags", {8, 3, 1}, keep_tags},
      {"tags-covered", "tags left in every second frame", {8, 3, 1}, cover_tags},
      {"hand", "image heights", {0.1, 0.2, 0.4}, hold_hand_in_front},
      {"nudge", "m", {0.001, 0.003, 0.01}, nudge_object},
      {"mesh-scale", "%", {1, 3, 10}, scale_mesh},
      {"mesh-offset", "m", {0.001, 0.003, 0.01}, shift_mesh},
      {"mesh-smoothing", "rounds", {2, 10, 50}, smooth_mesh},
      {"frames", "frames", {40, 20, 10, 5}, keep_count},
      {"one-side", "degrees of azimuth", {180, 90, 45}, keep_side},
  };
}

}  // namespace sheen::evaluation
