// SPDX-License-Identifier: MIT
#include "capture/dataset/bundler_file.h"

#include "capture/calibration/lens_record.h"
#include "capture/dataset/camera_list.h"
#include "capture/source/image_facts.h"
#include "core/diagnostics/error.h"
#include "core/files/read_file.h"
#include "core/text/lower_case.h"
#include "core/text/number.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace sheen::capture {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBundleNumbers = 15;  // of a camera: f k1 k2, R, t

[[noreturn]] void refuse_bundle(const fs::path& path, const std::string& fault) {
  throw core::bad_input(path, fault, "write it again with the program that made it");
}

/// The numbers of a bundle file, one after the other.
class BundleNumbers {
 public:
  BundleNumbers(const fs::path& path, std::string_view text) : path_(path), text_(text) {
    if (!text.starts_with("# Bundle file")) refuse_bundle(path, "is no bundle file of Bundler");
    text_.remove_prefix(std::min(text.find('\n'), text.size()));
  }

  double next() {
    constexpr std::string_view space = " \t\r\n";
    const std::size_t begin = text_.find_first_not_of(space);
    if (begin == std::string_view::npos) refuse_bundle(path_, "is cut short");
    text_.remove_prefix(begin);
    const std::string_view word = text_.substr(0, text_.find_first_of(space));
    text_.remove_prefix(word.size());
    const auto number = core::parse_number(word);
    if (!number || !std::isfinite(*number)) refuse_bundle(path_, core::why_no_number(word));
    return *number;
  }

  /// A number of cameras that the rest can hold.
  std::size_t camera_count() {
    const double count = next();
    // A digit and a space for each of a camera's numbers.
    const auto most = static_cast<double>(text_.size() / (2 * kMostBundleNumbers) + 1);
    if (count < 1 || count > most || count != std::floor(count)) {
      refuse_bundle(path_, "says that it has " + fmt::format("{:.4g}", count) + " cameras");
    }
    return static_cast<std::size_t>(count);
  }

 private:
  const fs::path& path_;
  std::string_view text_;
};

/// The first word of every line: others may follow (a guess of the focal length).
std::vector<std::string> image_names(const fs::path& bundle) {
  const fs::path folder = bundle.parent_path();
  const std::string stem = bundle.stem().string();
  fs::path list = folder / "list.txt";
  std::error_code no_throw;
  // COLMAP writes NAME.bundle.out and NAME.list.txt.
  for (const std::string& name :
       {stem + ".list.txt", fs::path(stem).stem().string() + ".list.txt"}) {
    if (fs::exists(folder / name, no_throw)) list = folder / name;
  }
  const std::string text = core::read_file(list, kMostDatasetBytes);
  std::vector<std::string> names;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    const std::string_view word = line.substr(0, line.find_first_of(" \t\r"));
    if (!word.empty()) names.push_back(image_within(list, std::string(word)));
  }
  return names;
}

ImageSize size_of(const fs::path& image) {
  const std::string bytes = core::read_file(image);
  const auto facts =
      read_image_facts({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  if (facts.size) return *facts.size;
  throw core::bad_input(image,
                        "does not say its size as JPEG and PNG do, and a bundle file has none",
                        "convert the images to PNG or JPEG");
}

/// f, k1 and k2 for images of one size: Bundler's centre is that of the image.
core::CameraModel bundle_camera(const fs::path& path, const std::array<double, 3>& lens,
                                const ImageSize& size) {
  LensRecord record;
  record.width_px = size.width_px;
  record.height_px = size.height_px;
  record.focal_px = {lens[0], lens[0]};
  record.principal_px = {0.5 * (size.width_px - 1), 0.5 * (size.height_px - 1)};
  // r(p) = 1 + k1 |p|^2 + k2 |p|^4, as OpenCV's.
  record.distortion = {lens[1], lens[2], 0, 0};
  return camera_of(record, path);
}

std::optional<fs::path> find_bundle(const fs::path& path) {
  const bool is_one = core::lower_case(path.extension().string()) == ".out";
  return is_one ? std::optional(path) : std::nullopt;
}

}  // namespace

Dataset read_bundle(const fs::path& path, const fs::path& images) {
  const std::string text = core::read_file(path, kMostDatasetBytes);
  BundleNumbers numbers(path, text);
  const std::size_t count = numbers.camera_count();
  numbers.next();  // points
  const std::vector<std::string> names = image_names(path);
  if (names.size() != count) {
    refuse_bundle(path, fmt::format("has {} cameras, its list {} images", count, names.size()));
  }
  std::optional<ImageSize> size;
  Dataset dataset;
  CameraList cameras;
  for (const std::string& name : names) {
    std::array<double, kMostBundleNumbers> v{};
    for (double& value : v) value = numbers.next();
    if (v[0] == 0) continue;
    if (!size) size = size_of(images / name);
    const core::CameraModel camera = bundle_camera(path, {v[0], v[1], v[2]}, *size);
    const Eigen::Matrix3d turn = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&v[3]);
    const auto rotation = nearest_rotation(turn);
    if (!rotation) refuse_bundle(path, "has no rigid pose of the image " + core::quotable(name));
    // Bundler's camera looks along -z with y up, ours along z with y down.
    const Eigen::Vector3d flip(1, -1, -1);
    Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
    camera_from_world.linear() = flip.asDiagonal() * *rotation;
    camera_from_world.translation() = flip.cwiseProduct(Eigen::Vector3d(v[12], v[13], v[14]));
    dataset.frames.push_back({.image = name,
                              .camera = cameras.add(camera, dataset.cameras),
                              .world_from_camera = camera_from_world.inverse()});
  }
  if (dataset.frames.empty()) refuse_bundle(path, "has no posed images");
  return dataset;
}

constinit const DatasetFormat kBundlerFormat{
    .name = "bundler",
    .sentence = "Bundler's bundle file (.out) and list of images",
    .find = find_bundle,
    .read = read_bundle,
    .write = nullptr};

}  // namespace sheen::capture
