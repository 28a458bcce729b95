// SPDX-License-Identifier: MIT
#include "capture/dataset/dataset.h"

#include "core/diagnostics/error.h"
#include "core/text/number.h"

#include <Eigen/SVD>

#include <algorithm>

namespace sheen::capture {

std::optional<Eigen::Matrix3d> nearest_rotation(const Eigen::Matrix3d& written) {
  if (!written.allFinite() || written.cwiseAbs().maxCoeff() > 2) return std::nullopt;
  const Eigen::Matrix3d products = written.transpose() * written;
  if ((products - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > 1e-3) return std::nullopt;
  if (written.determinant() < 0) return std::nullopt;
  const Eigen::JacobiSVD<Eigen::Matrix3d> parts(written, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return parts.matrixU() * parts.matrixV().transpose();
}

constexpr std::size_t kMostNameBytes = 255;  // of a file or folder, in every file system here

std::string image_within(const std::filesystem::path& file, const std::string& written) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; };
  const std::filesystem::path name = std::filesystem::path(written).lexically_normal();
  const bool leaves = name.is_absolute() || name.empty() || name == "." || *name.begin() == "..";
  if (leaves || std::any_of(written.begin(), written.end(), is_control)) {
    throw core::bad_input(
        file, "names the image '" + core::quotable(written) + "', which is not inside its folder",
        "put the images into the data set's folder and name them relative to it");
  }
  const bool is_long = std::any_of(name.begin(), name.end(), [](const std::filesystem::path& part) {
    return part.native().size() > kMostNameBytes;
  });
  if (is_long) {
    throw core::bad_input(
        file, "names an image by more than " + std::to_string(kMostNameBytes) + " bytes",
        "write it again with the program that made it");
  }
  return name.generic_string();
}

}  // namespace sheen::capture
