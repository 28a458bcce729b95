// SPDX-License-Identifier: MIT
#include "fitting/kept_views/view_codec.h"

#include "core/image/jpeg.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <numeric>
#include <string>

namespace sheen::fitting {
namespace {

using nlohmann::json;
using RowMajorPose = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
using Crop = std::array<std::uint32_t, 6>;

constexpr std::size_t kMostViews = std::size_t{1} << 20;
constexpr std::size_t kMostCache_mb = std::size_t{1} << 20;
constexpr std::size_t kMostSide_px = 65500;  // of a JPEG

struct PackedViews {
  std::vector<RowMajorPose> poses;
  std::vector<Crop> crops;
  std::vector<std::uint8_t> images;
};

// ---- cameras ----

json to_json(const core::CameraModel::Intrinsics& in) {
  return {{"size", {in.width_px, in.height_px}},
          {"focal", {in.focal_px.x(), in.focal_px.y()}},
          {"principal", {in.principal_px.x(), in.principal_px.y()}},
          {"distortion", in.distortion},
          {"lens", core::traits_of(in.lens).name}};
}

std::vector<double> required_numbers(const json& object, const char* name, std::size_t count) {
  const json& numbers = required(object, name);
  std::vector<double> values;
  if (numbers.is_array()) {
    for (const json& number : numbers) {
      values.push_back(number.is_number() ? number.get<double>() : std::nan(""));
    }
  }
  if (values.size() != count ||
      !std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) {
    throw ModelFault(std::string("the \"") + name + "\" of a camera is not what it should be");
  }
  return values;
}

core::CameraModel camera_from(const json& object) {
  const auto size = required_numbers(object, "size", 2);
  const auto focal = required_numbers(object, "focal", 2);
  const auto principal = required_numbers(object, "principal", 2);
  const auto distortion = required_numbers(object, "distortion", 8);
  const std::string lens = required_string(object, "lens");
  const auto kind = std::ranges::find(core::kLenses, lens, &core::LensTraits::name);
  const auto is_side = [](double value) {
    return value >= 1 && value <= 1e6 && value == std::floor(value);
  };
  if (!is_side(size[0]) || !is_side(size[1]) || !(std::min(focal[0], focal[1]) > 0) ||
      kind == core::kLenses.end()) {
    throw ModelFault("a camera is none");
  }
  core::CameraModel::Intrinsics in;
  in.width_px = static_cast<int>(size[0]);
  in.height_px = static_cast<int>(size[1]);
  in.focal_px = {focal[0], focal[1]};
  in.principal_px = {principal[0], principal[1]};
  std::ranges::copy(distortion, in.distortion.begin());
  in.lens = kind->kind;
  return core::CameraModel(in);
}

std::vector<core::CameraModel> cameras_of(const ModelPart& part) {
  const json& objects = required(part.parameters, "cameras");
  if (!objects.is_array() || objects.size() > kMostViews) throw ModelFault("it has no cameras");
  std::vector<core::CameraModel> cameras;
  for (const json& object : objects) cameras.push_back(camera_from(object));
  return cameras;
}

/// Index of the view's camera among those noted, which are few; notes it where it is new.
std::size_t camera_idx(const KeptView& view, std::vector<core::CameraModel::Intrinsics>& cameras) {
  const auto found = std::ranges::find(cameras, view.camera.intrinsics());
  const auto idx = static_cast<std::size_t>(found - cameras.begin());
  if (found == cameras.end()) cameras.push_back(view.camera.intrinsics());
  return idx;
}

// ---- views ----

template <typename T>
std::vector<T> required_records(const ModelPart& part, const char* name, std::size_t count) {
  std::vector<T> records(count);
  const auto bytes = required_bytes(part, name, count * sizeof(T));
  std::memcpy(static_cast<void*>(records.data()), bytes.data(), bytes.size());
  return records;
}

Eigen::Isometry3d pose_from(const RowMajorPose& numbers) {
  constexpr double rounding = 1e-6;
  const Eigen::Matrix3d rotation = numbers.leftCols<3>();
  const bool rotates = numbers.allFinite() &&
                       (rotation * rotation.transpose()).isIdentity(rounding) &&
                       rotation.determinant() > 0;
  if (!rotates) throw ModelFault("the pose of a view is none");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation;
  pose.translation() = numbers.col(3);
  return pose;
}

cv::Rect crop_from(const Crop& crop, const core::CameraModel& camera) {
  const auto fits = [](std::uint32_t begin, std::uint32_t size, int whole) {
    return size >= 1 && size <= kMostSide_px &&
           std::uint64_t{begin} + size <= static_cast<std::uint64_t>(whole);
  };
  if (!fits(crop[1], crop[3], camera.width_px()) || !fits(crop[2], crop[4], camera.height_px())) {
    throw ModelFault("a view is no part of its image");
  }
  return {static_cast<int>(crop[1]), static_cast<int>(crop[2]), static_cast<int>(crop[3]),
          static_cast<int>(crop[4])};
}

}  // namespace

void encode_views(std::span<const KeptView> views, int cache_mb, ModelPart& part) {
  const auto packed = std::make_shared<PackedViews>();
  std::vector<core::CameraModel::Intrinsics> cameras;
  for (const KeptView& view : views) {
    packed->poses.emplace_back(view.camera_from_object.matrix().topRows<3>());
    const auto number = [](auto value) { return static_cast<std::uint32_t>(value); };
    packed->crops.push_back({number(camera_idx(view, cameras)), number(view.crop.x),
                             number(view.crop.y), number(view.crop.width), number(view.crop.height),
                             number(view.jpeg.size())});
    packed->images.insert(packed->images.end(), view.jpeg.begin(), view.jpeg.end());
  }
  json& listed = part.parameters["cameras"] = json::array();
  for (const auto& intrinsics : cameras) listed.push_back(to_json(intrinsics));
  part.parameters["views"] = views.size();
  part.parameters["cacheMb"] = static_cast<std::size_t>(cache_mb);
  // glTF knows no empty bufferView.
  if (views.empty()) return;
  part.arrays["poses"] = std::as_bytes(std::span(packed->poses));
  part.arrays["crops"] = std::as_bytes(std::span(packed->crops));
  part.arrays["images"] = std::as_bytes(std::span(packed->images));
  part.owner = packed;
}

DecodedViews decode_views(const ModelPart& part) {
  const std::size_t count = required_size(part.parameters, "views");
  const std::size_t cache_mb = required_size(part.parameters, "cacheMb");
  if (count > kMostViews || cache_mb > kMostCache_mb) throw ModelFault("it has too many views");
  const std::vector<core::CameraModel> cameras = cameras_of(part);
  DecodedViews decoded{{}, static_cast<int>(cache_mb)};
  if (count == 0) return decoded;
  const auto poses = required_records<RowMajorPose>(part, "poses", count);
  const auto crops = required_records<Crop>(part, "crops", count);
  const std::size_t total =
      std::accumulate(crops.begin(), crops.end(), std::size_t{0},
                      [](std::size_t sum, const Crop& crop) { return sum + crop[5]; });
  auto images = required_bytes(part, "images", total);
  for (std::size_t i = 0; i < count; ++i) {
    if (crops[i][0] >= cameras.size()) throw ModelFault("a view names a camera that it lacks");
    const core::CameraModel& camera = cameras[crops[i][0]];
    KeptView view{camera, pose_from(poses[i]), crop_from(crops[i], camera), {}};
    const auto jpeg = images.first(crops[i][5]);
    if (core::jpeg_size(jpeg) != view.crop.size())
      throw ModelFault("a view is no JPEG of its size");
    view.jpeg.resize(jpeg.size());
    std::memcpy(view.jpeg.data(), jpeg.data(), jpeg.size());
    images = images.subspan(jpeg.size());
    decoded.views.push_back(std::move(view));
  }
  return decoded;
}

}  // namespace sheen::fitting
