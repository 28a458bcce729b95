// SPDX-License-Identifier: MIT
#include "capture/calibration/camera_file.h"

#include "capture/files/text_file.h"
#include "core/diagnostics/error.h"
#include "core/files/staged_output.h"

#include <opencv2/core.hpp>
#include <opencv2/core/persistence.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

namespace sheen::capture {
namespace {

// OpenCV's parser recurses without a limit; a short text with few brackets cannot exhaust the
// stack.
constexpr std::size_t kMaxCameraBytes = 16 * 1024;
constexpr auto kMaxBrackets = 64;
constexpr int kMaxImageSidePx = 1 << 15;
constexpr const char* kRemedy = "see docs/session-format.md for camera.yaml";

class CameraReader {
 public:
  explicit CameraReader(const std::filesystem::path& path) : path_(path) {
    const std::string text = read_text_file(path, kMaxCameraBytes);
    const auto brackets =
        std::count_if(text.begin(), text.end(), [](char c) { return c == '[' || c == '{'; });
    if (brackets > kMaxBrackets) fail("is nested too deeply for a camera file");
    if (!storage_.open(text, cv::FileStorage::READ | cv::FileStorage::MEMORY)) {
      fail("is not in OpenCV's FileStorage form");
    }
  }

  [[noreturn]] void fail(const std::string& fault) const {
    throw core::bad_input(path_, fault, kRemedy);
  }

  [[nodiscard]] int side(const char* key) const {
    const cv::FileNode node = storage_[key];
    if (!node.isInt()) fail(std::string(key) + " is missing or no whole number");
    const int value = node;
    if (value < 1 || value > kMaxImageSidePx) fail(std::string(key) + " is out of range");
    return value;
  }

  /// Row-major entries of a matrix. Read number by number: OpenCV's own reader allocates what the
  /// header of the matrix claims before it looks at the data.
  [[nodiscard]] std::vector<double> matrix(const char* key, std::size_t max_entries) const {
    const cv::FileNode data = storage_[key]["data"];
    if (!data.isSeq() || data.size() > max_entries) {
      fail(std::string(key) + " is missing or no matrix of the expected size");
    }
    std::vector<double> entries;
    for (const cv::FileNode entry : data) {
      if (!entry.isInt() && !entry.isReal())
        fail(std::string(key) + " holds something not a number");
      entries.push_back(static_cast<double>(entry));
      if (!std::isfinite(entries.back())) fail(std::string(key) + " holds a number not finite");
    }
    return entries;
  }

 private:
  std::filesystem::path path_;
  cv::FileStorage storage_;
};

void read_camera_matrix(const CameraReader& reader, core::CameraModel::Intrinsics& intrinsics) {
  const std::vector<double> K = reader.matrix("camera_matrix", 9);
  if (K.size() != 9) reader.fail("camera_matrix is not 3 x 3");
  if (K[3] != 0 || K[6] != 0 || K[7] != 0 || K[8] != 1 || std::abs(K[1]) > 1e-9 * std::abs(K[0])) {
    reader.fail("camera_matrix is not of the form fx 0 cx, 0 fy cy, 0 0 1");
  }
  intrinsics.focal_px = {K[0], K[4]};
  intrinsics.principal_px = {K[2], K[5]};
  const double largest_focal = 1e3 * std::max(intrinsics.width_px, intrinsics.height_px);
  if (!(intrinsics.focal_px.minCoeff() > 0) || intrinsics.focal_px.maxCoeff() > largest_focal) {
    reader.fail("the focal lengths are not positive or not believable");
  }
  // Half an image outside still leaves room for crops.
  const Eigen::Vector2d size(intrinsics.width_px, intrinsics.height_px);
  const Eigen::Vector2d relative = intrinsics.principal_px.cwiseQuotient(size);
  if (!(relative.minCoeff() > -0.5) || !(relative.maxCoeff() < 1.5)) {
    reader.fail("the principal point lies far outside the image");
  }
}

void read_distortion(const CameraReader& reader, core::CameraModel::Intrinsics& intrinsics) {
  const std::vector<double> k = reader.matrix("distortion_coefficients", 14);
  if (k.size() != 4 && k.size() != 5 && k.size() != 8) {
    reader.fail("distortion_coefficients has " + std::to_string(k.size()) +
                " entries, only 4, 5 or 8 are understood");
  }
  std::copy(k.begin(), k.end(), intrinsics.distortion.begin());
}

}  // namespace

core::CameraModel read_camera(const std::filesystem::path& path) {
  try {
    const CameraReader reader(path);
    core::CameraModel::Intrinsics intrinsics;
    intrinsics.width_px = reader.side("image_width");
    intrinsics.height_px = reader.side("image_height");
    read_camera_matrix(reader, intrinsics);
    read_distortion(reader, intrinsics);
    core::CameraModel camera(intrinsics);
    if (!(camera.valid_radius() > 0.01)) reader.fail("the distortion folds the image over");
    return camera;
  } catch (const core::Error&) {
    throw;
  } catch (const std::exception&) {
    // OpenCV's parser answers garbage with its own exceptions and with std::length_error.
    throw core::bad_input(path, "is not in OpenCV's FileStorage form", kRemedy);
  }
}

void write_camera(const std::filesystem::path& path, const core::CameraModel& camera) {
  const core::CameraModel::Intrinsics& intrinsics = camera.intrinsics();
  cv::Mat K = cv::Mat::eye(3, 3, CV_64F);
  K.at<double>(0, 0) = intrinsics.focal_px.x();
  K.at<double>(1, 1) = intrinsics.focal_px.y();
  K.at<double>(0, 2) = intrinsics.principal_px.x();
  K.at<double>(1, 2) = intrinsics.principal_px.y();
  const auto& k = intrinsics.distortion;
  const bool is_rational = k[5] != 0 || k[6] != 0 || k[7] != 0;
  const std::vector<double> coefficients(k.begin(), k.begin() + (is_rational ? 8 : 5));

  core::StagedOutput output(path);
  try {
    cv::FileStorage storage(output.path().string(),
                            cv::FileStorage::WRITE | cv::FileStorage::FORMAT_YAML);
    if (!storage.isOpened()) {
      throw core::Error(core::Error::Kind::run_failed, path, "cannot be written", "check the disk");
    }
    storage << "image_width" << intrinsics.width_px << "image_height" << intrinsics.height_px
            << "camera_matrix" << K << "distortion_coefficients"
            << cv::Mat(coefficients, true).reshape(1, 1);
  } catch (const cv::Exception&) {
    throw core::Error(core::Error::Kind::run_failed, path, "cannot be written", "check the disk");
  }
  output.commit();
}

}  // namespace sheen::capture
