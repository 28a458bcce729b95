// SPDX-License-Identifier: MIT
#include "capture/dataset/transforms_file.h"

#include "capture/calibration/lens_record.h"
#include "capture/dataset/camera_list.h"
#include "core/diagnostics/error.h"
#include "core/files/read_file.h"
#include "core/files/write_file.h"
#include "core/text/nesting.h"
#include "core/text/number.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace sheen::capture {
namespace {

using nlohmann::ordered_json;
using Path = std::filesystem::path;

[[noreturn]] void refuse_transforms(const Path& path, const std::string& fault) {
  throw core::bad_input(path, fault, "write it again with the program that made it");
}

/// The values of one frame: its own keys win over the file's.
class FrameKeys {
 public:
  FrameKeys(const Path& path, const ordered_json& file, const ordered_json& frame)
      : path_(path), file_(file), frame_(frame) {}

  [[nodiscard]] const ordered_json* find(const char* key) const {
    if (const auto own = frame_.find(key); own != frame_.end()) return &*own;
    if (const auto common = file_.find(key); common != file_.end()) return &*common;
    return nullptr;
  }

  [[nodiscard]] std::optional<double> number(const char* key) const {
    const ordered_json* value = find(key);
    if (value == nullptr || value->is_null()) return std::nullopt;
    if (!value->is_number() || !std::isfinite(value->get<double>())) {
      refuse_transforms(path_, std::string(key) + " is not a finite number");
    }
    return value->get<double>();
  }

  [[nodiscard]] double needed(const char* key) const {
    const auto value = number(key);
    if (!value) refuse_transforms(path_, std::string("has no ") + key);
    return *value;
  }

  [[nodiscard]] int size(const char* key) const {
    const double value = needed(key);
    if (value < 1 || value > 65535 || value != std::floor(value)) {
      refuse_transforms(path_, std::string(key) + " is no image size");
    }
    return static_cast<int>(value);
  }

  [[nodiscard]] core::LensKind lens() const {
    if (const ordered_json* flag = find("is_fisheye"); flag != nullptr && *flag == true) {
      return core::LensKind::fisheye;
    }
    const ordered_json* model = find("camera_model");
    if (model == nullptr) return core::LensKind::rational;
    const std::string name = model->is_string() ? model->get<std::string>() : "no string";
    if (name == "OPENCV_FISHEYE") return core::LensKind::fisheye;
    if (name == "OPENCV" || name == "PINHOLE" || name == "SIMPLE_PINHOLE") {
      return core::LensKind::rational;
    }
    throw core::bad_input(path_, "has camera_model " + core::quotable(name),
                          "undistort the images; OPENCV and OPENCV_FISHEYE are read");
  }

 private:
  const Path& path_;
  const ordered_json& file_;
  const ordered_json& frame_;
};

/// k1 k2 k3 k4 p1 p2, from keys of these names or from the list nerfstudio has them in.
std::array<double, 6> distortion_of(const FrameKeys& keys, const Path& path) {
  std::array<double, 6> values{};
  const ordered_json* list = keys.find("distortion_params");
  if (list == nullptr) {
    constexpr std::array names{"k1", "k2", "k3", "k4", "p1", "p2"};
    for (std::size_t i = 0; i < names.size(); ++i) values[i] = keys.number(names[i]).value_or(0);
    return values;
  }
  if (!list->is_array() || list->size() > values.size()) {
    refuse_transforms(path, "distortion_params is no list of at most 6 numbers");
  }
  for (std::size_t i = 0; i < list->size(); ++i) {
    if (!(*list)[i].is_number()) refuse_transforms(path, "distortion_params holds no number");
    values[i] = (*list)[i].get<double>();
  }
  return values;
}

core::CameraModel camera_of_frame(const FrameKeys& keys, const Path& path) {
  LensRecord record;
  record.kind = keys.lens();
  record.width_px = keys.size("w");
  record.height_px = keys.size("h");
  const auto angle = keys.number("camera_angle_x");
  const auto focal = keys.number("fl_x");
  if (!focal && !angle) refuse_transforms(path, "has neither fl_x nor camera_angle_x");
  record.focal_px.x() = focal ? *focal : record.width_px / 2.0 / std::tan(*angle / 2);
  record.focal_px.y() = keys.number("fl_y").value_or(record.focal_px.x());
  // Counted from the corner of the first pixel (capture/dataset/dataset.h).
  record.principal_px = {keys.number("cx").value_or(record.width_px / 2.0) - 0.5,
                         keys.number("cy").value_or(record.height_px / 2.0) - 0.5};
  const auto [k1, k2, k3, k4, p1, p2] = distortion_of(keys, path);
  if (record.kind == core::LensKind::fisheye) {
    record.distortion = {k1, k2, k3, k4};
  } else if (k4 != 0) {
    // As a fourth power of r squared; k4 of OpenCV's lens is in the denominator.
    throw core::bad_input(path, "has a k4 that is not a fisheye's",
                          "undistort the images; k1 k2 k3 p1 p2 are read");
  } else {
    record.distortion = {k1, k2, p1, p2, k3};
  }
  return camera_of(record, path);
}

Eigen::Isometry3d pose_of_frame(const ordered_json& frame, const Path& path,
                                const std::string& image) {
  const std::string where = "transform_matrix of " + core::quotable(image) + " ";
  const auto rows = frame.find("transform_matrix");
  if (rows == frame.end() || !rows->is_array() || rows->size() < 3 || rows->size() > 4) {
    refuse_transforms(path, where + "has no 3 or 4 rows");
  }
  Eigen::Matrix<double, 3, 4> matrix;
  for (int row = 0; row < 3; ++row) {
    const ordered_json& numbers = (*rows)[static_cast<std::size_t>(row)];
    if (!numbers.is_array() || numbers.size() != 4)
      refuse_transforms(path, where + "is not 4 wide");
    for (int column = 0; column < 4; ++column) {
      const ordered_json& number = numbers[static_cast<std::size_t>(column)];
      if (!number.is_number()) refuse_transforms(path, where + "holds what is no number");
      matrix(row, column) = number.get<double>();
    }
  }
  const auto rotation = nearest_rotation(matrix.leftCols<3>());
  if (!rotation || !matrix.allFinite()) refuse_transforms(path, where + "is no rigid motion");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  // OpenGL's camera looks along -z with y up, ours along z with y down.
  pose.linear() = *rotation * Eigen::Vector3d(1, -1, -1).asDiagonal();
  pose.translation() = matrix.col(3);
  return pose;
}

ordered_json camera_keys(const core::CameraModel& camera, const Path& path) {
  const auto& lens = camera.intrinsics();
  const auto& k = lens.distortion;
  ordered_json keys{{"w", lens.width_px},
                    {"h", lens.height_px},
                    {"fl_x", lens.focal_px.x()},
                    {"fl_y", lens.focal_px.y()},
                    {"cx", lens.principal_px.x() + 0.5},
                    {"cy", lens.principal_px.y() + 0.5},
                    {"k1", k[0]},
                    {"k2", k[1]}};
  if (lens.lens == core::LensKind::fisheye) {
    keys["k3"] = k[2];
    keys["k4"] = k[3];
    return keys;
  }
  if (k[5] != 0 || k[6] != 0 || k[7] != 0) {
    throw core::bad_input(path, "cannot hold k4 to k6 of the camera's rational lens",
                          "undistort the images or write COLMAP's files");
  }
  keys["p1"] = k[2];
  keys["p2"] = k[3];
  keys["k3"] = k[4];
  return keys;
}

/// nerfstudio takes every tenth frame for comparisons unless it is told which.
void add_split(const Dataset& dataset, ordered_json& file) {
  ordered_json fitted = ordered_json::array();
  ordered_json held_out = ordered_json::array();
  for (const DatasetFrame& frame : dataset.frames) {
    (frame.is_held_out ? held_out : fitted).push_back(frame.image);
  }
  if (held_out.empty()) return;
  file["train_filenames"] = fitted;
  file["val_filenames"] = held_out;
  file["test_filenames"] = held_out;
}

std::optional<Path> find_transforms(const Path& path) {
  std::error_code no_throw;
  if (std::filesystem::is_directory(path, no_throw)) {
    const Path inside = path / "transforms.json";
    return std::filesystem::exists(inside, no_throw) ? std::optional(inside) : std::nullopt;
  }
  return path.extension() == ".json" ? std::optional(path) : std::nullopt;
}

Dataset read_transforms_alone(const Path& path, const Path& /*images*/) {
  return read_transforms(path);
}

void write_transforms_into(const Path& folder, const Dataset& dataset) {
  write_transforms(folder / "transforms.json", dataset);
}

}  // namespace

Dataset read_transforms(const Path& path) {
  const std::string text = core::read_file(path, kMostDatasetBytes);
  if (core::json_depth(text) > core::kMostNesting) refuse_transforms(path, "nests too deep");
  const ordered_json file = ordered_json::parse(text, nullptr, false);
  const bool is_list = file.is_object() && file.contains("frames") && file["frames"].is_array();
  if (!is_list) refuse_transforms(path, "is no JSON with a list of frames");
  Dataset dataset;
  CameraList cameras;
  for (const ordered_json& frame : file["frames"]) {
    const bool has_image =
        frame.is_object() && frame.contains("file_path") && frame["file_path"].is_string();
    if (!has_image) refuse_transforms(path, "has a frame without file_path");
    const FrameKeys keys(path, file, frame);
    DatasetFrame added;
    added.image = image_within(path, frame["file_path"].get<std::string>());
    added.world_from_camera = pose_of_frame(frame, path, added.image);
    added.sharpness = keys.number("sharpness");
    added.camera = cameras.add(camera_of_frame(keys, path), dataset.cameras);
    dataset.frames.push_back(std::move(added));
  }
  if (dataset.frames.empty()) refuse_transforms(path, "has no frames");
  return dataset;
}

void write_transforms(const Path& path, const Dataset& dataset) {
  const bool is_fisheye = !dataset.cameras.empty() &&
                          dataset.cameras.front().intrinsics().lens == core::LensKind::fisheye;
  for (const auto& camera : dataset.cameras) {
    if ((camera.intrinsics().lens == core::LensKind::fisheye) == is_fisheye) continue;
    throw core::bad_input(path, "holds one kind of lens and the capture has two",
                          "write COLMAP's files");
  }
  ordered_json file{{"camera_model", is_fisheye ? "OPENCV_FISHEYE" : "OPENCV"},
                    {"orientation_override", "none"}};
  if (is_fisheye) file["is_fisheye"] = true;
  const bool has_one = dataset.cameras.size() == 1;
  if (has_one) file.update(camera_keys(dataset.cameras.front(), path));
  if (!dataset.surface.empty()) file["ply_file_path"] = dataset.surface;
  const bool has_masks = std::all_of(dataset.frames.begin(), dataset.frames.end(),
                                     [](const auto& frame) { return !frame.mask.empty(); });
  add_split(dataset, file);
  file["frames"] = ordered_json::array();
  for (const DatasetFrame& frame : dataset.frames) {
    ordered_json entry{{"file_path", frame.image}};
    if (!has_one) entry.update(camera_keys(dataset.cameras.at(frame.camera), path));
    if (frame.sharpness) entry["sharpness"] = *frame.sharpness;
    if (has_masks) entry["mask_path"] = frame.mask;
    Eigen::Matrix4d pose = frame.world_from_camera.matrix();
    pose.middleCols<2>(1) *= -1;
    for (int row = 0; row < 4; ++row) {
      entry["transform_matrix"].push_back({pose(row, 0), pose(row, 1), pose(row, 2), pose(row, 3)});
    }
    file["frames"].push_back(std::move(entry));
  }
  core::write_file(path, file.dump(1) + "\n");
}

constinit const DatasetFormat kNerfstudioFormat{
    .name = "nerfstudio",
    .sentence = "nerfstudio, instant-ngp: images and transforms.json",
    .find = find_transforms,
    .read = read_transforms_alone,
    .write = write_transforms_into};

}  // namespace sheen::capture
