// SPDX-License-Identifier: MIT
#include "tests/capture/rendered_board.h"

#include "capture/pose/apriltag_family.h"
#include "capture/pose/tag_family.h"

#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace sheen::capture::test {
namespace {

/// A tag as printed, one value per module, row 0 on top, with whatever surrounds the square.
cv::Mat draw_code(const Board& board, int id) {
  const TagFamily family = find_tag_family(board.family, board.border_bits).value();
  cv::Mat code;
  if (family.library == TagFamily::Library::aruco) {
    cv::aruco::getPredefinedDictionary(family.aruco_dictionary_id)
        ->drawMarker(id, family.modules, code, board.border_bits);
    // Kalibr's print: OpenCV's turned by 180 degrees.
    if (family.half_turn) cv::rotate(code, code, cv::ROTATE_180);
    return code;
  }
  const auto codes = AprilTagFamily::find(family.name).value();
  image_u8_t* image = apriltag_to_image(codes.get(), id);
  cv::Mat(image->height, image->width, CV_8U, image->buf, static_cast<std::size_t>(image->stride))
      .copyTo(code);
  image_u8_destroy(image);
  return code;
}

/// Row and column of a tag's code as affine functions of a point of the board (metres): plain
/// numbers, since every sample of every image asks every tag.
struct PrintedTag {
  double column[4];  ///< factors of x, y, z; constant
  double row[4];
  cv::Mat code;
};

double affine(const double (&f)[4], const Eigen::Vector3d& point) {
  const double* p = point.data();
  return f[0] * p[0] + f[1] * p[1] + f[2] * p[2] + f[3];
}

class Print {
 public:
  explicit Print(const Board& board) {
    const int modules = find_tag_family(board.family, board.border_bits).value().modules;
    for (const auto& [id, tag] : board.tags) {
      PrintedTag printed{{}, {}, draw_code(board, id)};  // the square is the middle of the code
      const Eigen::Matrix4d tag_from_board = tag.board_from_tag.inverse().matrix();
      const double modules_per_m = modules / tag.size_m;
      for (int k = 0; k < 4; ++k) {
        printed.column[k] = modules_per_m * tag_from_board(0, k);
        printed.row[k] = -modules_per_m * tag_from_board(1, k);
      }
      printed.column[3] += printed.code.cols / 2.0;
      printed.row[3] += printed.code.rows / 2.0;
      tags_.push_back(std::move(printed));
    }
  }

  [[nodiscard]] bool is_black(const Eigen::Vector3d& board) const {
    for (const PrintedTag& tag : tags_) {
      const double column = affine(tag.column, board);
      const double row = affine(tag.row, board);
      if (column < 0 || row < 0 || column >= tag.code.cols || row >= tag.code.rows) continue;
      return tag.code.at<unsigned char>(static_cast<int>(row), static_cast<int>(column)) == 0;
    }
    return false;
  }

 private:
  std::vector<PrintedTag> tags_;
};

cv::Matx33d camera_matrix(const core::CameraModel& camera) {
  const auto& i = camera.intrinsics();
  return {i.focal_px.x(), 0, i.principal_px.x(), 0, i.focal_px.y(), i.principal_px.y(), 0, 0, 1};
}

std::vector<double> distortion(const core::CameraModel& camera) {
  return {camera.intrinsics().distortion.begin(), camera.intrinsics().distortion.end()};
}

/// Undistorted positions in the plane z = 1 of the upper left corners of all pixels, one row and
/// column more than the image has.
std::vector<cv::Point2d> undistort_lattice(const core::CameraModel& camera) {
  std::vector<cv::Point2d> pixels;
  for (int y = 0; y <= camera.height_px(); ++y) {
    for (int x = 0; x <= camera.width_px(); ++x) pixels.emplace_back(x - 0.5, y - 0.5);
  }
  std::vector<cv::Point2d> ideal;
  if (camera.intrinsics().lens == core::LensKind::fisheye) {
    std::vector<double> k = distortion(camera);
    k.resize(4);
    cv::fisheye::undistortPoints(pixels, ideal, camera_matrix(camera), k);
    return ideal;
  }
  cv::undistortPoints(
      pixels, ideal, camera_matrix(camera), distortion(camera), cv::noArray(), cv::noArray(),
      cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-10));
  return ideal;
}

void finish(cv::Mat& image, const Photograph& photograph) {
  if (photograph.blur_sigma_px > 0) {
    cv::GaussianBlur(image, image, {}, photograph.blur_sigma_px);
  }
  if (photograph.motion_px > 0) cv::blur(image, image, {photograph.motion_px, 1});
  if (photograph.noise > 0) {
    cv::RNG random(photograph.seed);
    cv::Mat noise(image.size(), CV_32F);
    random.fill(noise, cv::RNG::NORMAL, 0, photograph.noise);
    image += noise;
  }
}

}  // namespace

cv::Mat render_board(const Board& board, const core::CameraModel& camera,
                     const Eigen::Isometry3d& camera_from_board, const Photograph& photograph) {
  const Print print(board);
  const Eigen::Isometry3d board_from_camera = camera_from_board.inverse();
  const std::vector<cv::Point2d> lattice = undistort_lattice(camera);
  const auto stride = static_cast<std::size_t>(camera.width_px()) + 1;
  const int n = photograph.supersampling;
  cv::Mat image(camera.height_px(), camera.width_px(), CV_32F);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      // Distortion bends far less than a pixel within a pixel: interpolate between its corners.
      const cv::Point2d* upper =
          &lattice[static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x)];
      const cv::Point2d* lower = upper + stride;
      int black = 0;
      for (int s = 0; s < n * n; ++s) {
        const double u = (s % n + 0.5) / n;
        const double v = (s / n + 0.5) / n;
        const cv::Point2d ideal =
            (1 - v) * ((1 - u) * upper[0] + u * upper[1]) + v * ((1 - u) * lower[0] + u * lower[1]);
        const Eigen::Vector3d ray =
            board_from_camera.linear() * Eigen::Vector3d(ideal.x, ideal.y, 1);
        const double depth = -board_from_camera.translation().z() / ray.z();
        if (depth > 0) black += print.is_black(board_from_camera.translation() + depth * ray);
      }
      const double share = static_cast<double>(black) / (n * n);
      image.at<float>(y, x) =
          static_cast<float>(photograph.light + share * (photograph.dark - photograph.light));
    }
  }
  finish(image, photograph);
  cv::Mat grey;
  image.convertTo(grey, CV_8U);
  cv::Mat colour;
  cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
  return colour;
}

std::map<int, std::array<Eigen::Vector2d, 4>> true_corners(
    const Board& board, const core::CameraModel& camera,
    const Eigen::Isometry3d& camera_from_board) {
  std::map<int, std::array<Eigen::Vector2d, 4>> corners;
  for (const auto& [id, tag] : board.tags) {
    std::vector<cv::Point3d> points;
    for (const Eigen::Vector3d& corner : tag.corners_in_board()) {
      const Eigen::Vector3d p = camera_from_board * corner;
      points.emplace_back(p.x(), p.y(), p.z());
    }
    std::vector<cv::Point2d> projected;
    cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), camera_matrix(camera), distortion(camera),
                      projected);
    for (std::size_t c = 0; c < 4; ++c) corners[id][c] = {projected[c].x, projected[c].y};
  }
  return corners;
}

Board make_grid_board(const std::string& family, int columns, int rows, double size_m,
                      double pitch_m) {
  Board board;
  board.family = family;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      Board::Tag tag;
      tag.size_m = size_m;
      tag.board_from_tag.translation() = Eigen::Vector3d((column - (columns - 1) / 2.0) * pitch_m,
                                                         ((rows - 1) / 2.0 - row) * pitch_m, 0);
      board.tags[row * columns + column] = tag;
    }
  }
  return board;
}

core::CameraModel make_camera(int width_px, int height_px, bool distorted) {
  core::CameraModel::Intrinsics intrinsics;
  intrinsics.width_px = width_px;
  intrinsics.height_px = height_px;
  intrinsics.focal_px = {0.79 * width_px, 0.785 * width_px};
  intrinsics.principal_px = {0.506 * width_px, 0.489 * height_px};
  if (distorted) intrinsics.distortion = {-0.12, 0.05, 0.0008, -0.0006, -0.01, 0, 0, 0};
  return core::CameraModel(intrinsics);
}

Eigen::Isometry3d look_at_board(double distance_m, double elevation, double azimuth) {
  const Eigen::Vector3d eye =
      distance_m * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                   std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  Eigen::Isometry3d board_from_camera = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d forward = -eye.normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  board_from_camera.linear() << right, forward.cross(right), forward;
  board_from_camera.translation() = eye;
  return board_from_camera.inverse();
}

}  // namespace sheen::capture::test
