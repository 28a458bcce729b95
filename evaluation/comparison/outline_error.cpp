// SPDX-License-Identifier: MIT
#include "evaluation/comparison/outline_error.h"

#include "core/image/metrics.h"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace sheen::evaluation {
namespace {

constexpr int kErosion_px = 2;
constexpr int kBand_px = 3;
/// Depths that differ by more than so many pixels' angle between neighbours are a jump; a surface
/// at a cosine of .2 changes by 5.
constexpr float kJumpPixels = 12.0f;
constexpr double kEqual_db = 99;

cv::Mat square(int reach_px) {
  return cv::getStructuringElement(cv::MORPH_RECT, {2 * reach_px + 1, 2 * reach_px + 1});
}

cv::Mat on_black(const cv::Mat& image, const cv::Mat& mask) {
  cv::Mat shown(image.size(), image.type(), cv::Scalar::all(0));
  image.copyTo(shown, mask);
  return shown;
}

double psnr_db(const cv::Mat& a, const cv::Mat& b) {
  const double squared = cv::norm(a, b, cv::NORM_L2SQR) /
                         (255.0 * 255.0 * static_cast<double>(a.total()) * a.channels());
  return squared > 0 ? std::min(-10 * std::log10(squared), kEqual_db) : kEqual_db;
}

}  // namespace

EdgeBand::EdgeBand(const core::Mesh& mesh, int threads)
    : points_(core::surface_points(mesh)), depth_(mesh, threads), threads_(threads) {}

cv::Mat EdgeBand::seen_by(const core::CameraModel& camera,
                          const Eigen::Isometry3d& camera_from_object) {
  const cv::Size size(camera.width_px(), camera.height_px());
  cv::Mat band(size, CV_8UC1, cv::Scalar(0));
  core::project_vertices(points_, camera, camera_from_object, {}, threads_, view_);
  depth_.draw(view_, size, camera_from_object);
  if (depth_.box().empty()) return band;
  // The border of the box is no edge where it is the image's: there the object goes on.
  cv::Mat depth_m(size, CV_32FC1, cv::Scalar(0));
  depth_.depth_m().copyTo(depth_m(depth_.box()));
  cv::Mat nearest, farthest;
  cv::erode(depth_m, nearest, square(1));
  cv::dilate(depth_m, farthest, square(1));
  const auto pixel_angle = 1.0f / static_cast<float>(camera.intrinsics().focal_px.minCoeff());
  const cv::Mat edges =
      (farthest > 0.0f) &
      ((nearest <= 0.0f) | (farthest - nearest > kJumpPixels * pixel_angle * farthest));
  cv::dilate(edges, band, square(kBand_px - 1));
  return band & (depth_m > 0.0f);
}

OutlineError outline_error(const render::RenderedView& rendered, const cv::Mat& photograph,
                           const cv::Mat& mask, const cv::Mat& edge_band) {
  const cv::Mat drawn = on_black(rendered.image, rendered.mask);
  OutlineError error;
  const cv::Rect object = cv::boundingRect(mask);
  const cv::Rect box = cv::Rect(object.tl() - cv::Point(kBand_px, kBand_px),
                                object.br() + cv::Point(kBand_px, kBand_px)) &
                       cv::Rect({}, mask.size());
  error.box_psnr_db = psnr_db(drawn(box), on_black(photograph, mask)(box));
  const int band_px = cv::countNonZero(edge_band);
  error.edge_difference =
      cv::norm(drawn, photograph, cv::NORM_L1, edge_band) / (3.0 * std::max(band_px, 1));
  const cv::Mat counted = core::eroded(mask, kErosion_px);
  error.hole_fraction = static_cast<double>(cv::countNonZero(counted & (rendered.mask == 0))) /
                        std::max(cv::countNonZero(counted), 1);
  return error;
}

}  // namespace sheen::evaluation
