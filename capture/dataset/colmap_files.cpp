// SPDX-License-Identifier: MIT
#include "capture/dataset/colmap_files.h"

#include "capture/calibration/colmap_lens.h"
#include "capture/dataset/colmap_bytes.h"
#include "core/diagnostics/error.h"
#include "core/files/read_file.h"
#include "core/files/write_file.h"
#include "core/text/number.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

namespace sheen::capture {
namespace {

using Path = std::filesystem::path;
using CameraIndices = std::map<long long, std::size_t>;  // COLMAP's number -> Dataset::cameras

// Places in the table of those that are written.
constexpr std::size_t kPinhole = 1, kOpenCv = 4, kOpenCvFisheye = 5, kFullOpenCv = 6;

[[noreturn]] void refuse_lens(const Path& path, const std::string& name) {
  throw core::bad_input(path, "has a camera of the model " + core::quotable(name),
                        "undistort the images with COLMAP's image_undistorter");
}

const ColmapLens& lens_named(const Path& path, std::string_view name) {
  const ColmapLens* lens = find_colmap_lens(name);
  if (lens == nullptr) refuse_lens(path, std::string(name));
  return *lens;
}

const ColmapLens& lens_numbered(const Path& path, int id) {
  for (const ColmapLens& lens : colmap_lenses()) {
    if (lens.id == id) return lens;
  }
  constexpr std::array others{"FOV", "", "", "THIN_PRISM_FISHEYE", "RAD_TAN_THIN_PRISM_FISHEYE"};
  const bool is_known = id == 7 || id == 10 || id == 11;
  refuse_lens(path, is_known ? others[static_cast<std::size_t>(id - 7)] : std::to_string(id));
}

core::CameraModel camera_from(const Path& path, const ColmapLens& lens, std::uint64_t width,
                              std::uint64_t height, const std::vector<double>& values) {
  if (width == 0 || height == 0 || width > 65535 || height > 65535) {
    refuse_colmap(path, "has a camera whose image size is none");
  }
  return camera_of(colmap_record(lens, static_cast<int>(width), static_cast<int>(height), values),
                   path);
}

void add_camera(const Path& path, Dataset& dataset, CameraIndices& indices, long long id,
                const core::CameraModel& camera) {
  if (!indices.emplace(id, dataset.cameras.size()).second) {
    refuse_colmap(path, fmt::format("has two cameras {}", id));
  }
  dataset.cameras.push_back(camera);
}

/// `values`: qw qx qy qz tx ty tz, from world to camera.
void add_frame(const Path& path, Dataset& dataset, const CameraIndices& indices, long long camera,
               const std::array<double, 7>& values, const std::string& name) {
  DatasetFrame frame;
  frame.image = image_within(path, name);
  const auto index = indices.find(camera);
  const std::string whose = core::quotable(frame.image);
  if (index == indices.end()) refuse_colmap(path, "knows no camera of the image " + whose);
  frame.camera = index->second;
  const Eigen::Quaterniond turn(values[0], values[1], values[2], values[3]);
  const Eigen::Vector3d shift(values[4], values[5], values[6]);
  if (!shift.allFinite() || !(std::abs(turn.norm() - 1) < 1e-3)) {
    refuse_colmap(path, "has no rigid pose of the image " + whose);
  }
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
  camera_from_world.linear() = turn.normalized().toRotationMatrix();
  camera_from_world.translation() = shift;
  frame.world_from_camera = camera_from_world.inverse();
  dataset.frames.push_back(std::move(frame));
}

std::string_view next_word(std::string_view& line) {
  constexpr std::string_view kSpace = " \t\r";
  const std::size_t begin = line.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return line = {};
  line.remove_prefix(begin);
  const std::string_view word = line.substr(0, line.find_first_of(kSpace));
  line.remove_prefix(word.size());
  return word;
}

std::string_view next_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

double next_number(const Path& path, std::string_view& line) {
  const std::string_view word = next_word(line);
  if (word.empty()) refuse_colmap(path, "has a line that ends early");
  const auto number = core::parse_number(word);
  if (!number || !std::isfinite(*number)) refuse_colmap(path, core::why_no_number(word));
  return *number;
}

long long next_whole(const Path& path, std::string_view& line) {
  const std::string_view word = next_word(line);
  const auto number = core::parse_whole_number(word);
  if (!number || *number < 0) {
    refuse_colmap(path, "has '" + core::quotable(word) + "' where a whole number belongs");
  }
  return *number;
}

bool is_comment(std::string_view line) {
  const std::string_view word = next_word(line);
  return word.empty() || word.front() == '#';
}

CameraIndices read_text_cameras(const Path& path, Dataset& dataset) {
  const std::string bytes = core::read_file(path, kMostDatasetBytes);
  CameraIndices indices;
  for (std::string_view text = bytes; !text.empty();) {
    std::string_view line = next_line(text);
    if (is_comment(line)) continue;
    const long long id = next_whole(path, line);
    const ColmapLens& lens = lens_named(path, next_word(line));
    const auto width = static_cast<std::uint64_t>(next_whole(path, line));
    const auto height = static_cast<std::uint64_t>(next_whole(path, line));
    std::vector<double> values(lens.parameter_count());
    for (double& value : values) value = next_number(path, line);
    add_camera(path, dataset, indices, id, camera_from(path, lens, width, height, values));
  }
  return indices;
}

void read_text_images(const Path& path, const CameraIndices& indices, Dataset& dataset) {
  const std::string bytes = core::read_file(path, kMostDatasetBytes);
  for (std::string_view text = bytes; !text.empty();) {
    std::string_view line = next_line(text);
    if (is_comment(line)) continue;
    next_whole(path, line);
    std::array<double, 7> values{};
    for (double& value : values) value = next_number(path, line);
    const long long camera = next_whole(path, line);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));  // names have spaces
    add_frame(path, dataset, indices, camera, values,
              std::string(line.substr(0, line.find_last_not_of(" \t\r") + 1)));
    next_line(text);  // its points, which may be none
  }
}

CameraIndices read_binary_cameras(const Path& path, Dataset& dataset) {
  const std::string bytes = core::read_file(path, kMostDatasetBytes);
  ColmapReader reader(path, bytes);
  CameraIndices indices;
  const auto count = reader.count(4 + 4 + 8 + 8 + 3 * 8);
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto id = reader.take<std::uint32_t>();
    const ColmapLens& lens = lens_numbered(path, reader.take<std::int32_t>());
    const auto width = reader.take<std::uint64_t>();
    const auto height = reader.take<std::uint64_t>();
    std::vector<double> values(lens.parameter_count());
    for (double& value : values) value = reader.take<double>();
    add_camera(path, dataset, indices, id, camera_from(path, lens, width, height, values));
  }
  return indices;
}

void read_binary_images(const Path& path, const CameraIndices& indices, Dataset& dataset) {
  const std::string bytes = core::read_file(path, kMostDatasetBytes);
  ColmapReader reader(path, bytes);
  const auto count = reader.count(4 + 7 * 8 + 4 + 1 + 8);
  for (std::uint64_t i = 0; i < count; ++i) {
    reader.take<std::uint32_t>();
    std::array<double, 7> values{};
    for (double& value : values) value = reader.take<double>();
    const auto camera = reader.take<std::uint32_t>();
    const std::string name = reader.name();
    constexpr std::size_t kPointBytes = 8 + 8 + 8;
    reader.skip(reader.count(kPointBytes) * kPointBytes);
    add_frame(path, dataset, indices, camera, values, name);
  }
}

const ColmapLens& lens_of(const core::CameraModel& camera) {
  if (camera.intrinsics().lens == core::LensKind::fisheye) return colmap_lenses()[kOpenCvFisheye];
  // Many programs know the smaller ones only.
  const auto& k = camera.intrinsics().distortion;
  const auto used = std::find_if(k.rbegin(), k.rend(), [](double value) { return value != 0; });
  const auto count = static_cast<std::size_t>(k.rend() - used);
  if (count == 0) return colmap_lenses()[kPinhole];
  return colmap_lenses()[count <= 4 ? kOpenCv : kFullOpenCv];
}

/// In the order of FULL_OPENCV or OPENCV_FISHEYE, which is that of the coefficients.
std::vector<double> parameters_of(const core::CameraModel& camera) {
  const auto& lens = camera.intrinsics();
  std::vector<double> values{lens.focal_px.x(), lens.focal_px.y(), lens.principal_px.x() + 0.5,
                             lens.principal_px.y() + 0.5};
  const auto used = static_cast<std::ptrdiff_t>(lens_of(camera).distortion);
  values.insert(values.end(), lens.distortion.begin(), lens.distortion.begin() + used);
  return values;
}

std::array<double, 7> pose_values(const DatasetFrame& frame) {
  const Eigen::Isometry3d pose = frame.world_from_camera.inverse();
  const Eigen::Quaterniond turn(pose.linear());
  const auto& shift = pose.translation();
  return {turn.w(), turn.x(), turn.y(), turn.z(), shift.x(), shift.y(), shift.z()};
}

void write_text(const Path& folder, const Dataset& dataset) {
  std::string cameras = "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]\n";
  for (std::size_t i = 0; i < dataset.cameras.size(); ++i) {
    const auto& camera = dataset.cameras[i];
    cameras += fmt::format("{} {} {} {}", i + 1, lens_of(camera).name, camera.width_px(),
                           camera.height_px());
    for (const double value : parameters_of(camera)) cameras += fmt::format(" {:.17g}", value);
    cameras += '\n';
  }
  std::string images = "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then a line of points\n";
  for (std::size_t i = 0; i < dataset.frames.size(); ++i) {
    const DatasetFrame& frame = dataset.frames[i];
    images += std::to_string(i + 1);
    for (const double value : pose_values(frame)) images += fmt::format(" {:.17g}", value);
    images += fmt::format(" {} {}\n\n", frame.camera + 1, frame.image);
  }
  std::string points = "# POINT3D_ID X Y Z R G B ERROR TRACK[]\n";
  for (std::size_t i = 0; i < dataset.points.size(); ++i) {
    const auto& [p, c] = dataset.points[i];
    points += fmt::format("{} {:.9g} {:.9g} {:.9g} {} {} {} 0\n", i + 1, p.x(), p.y(), p.z(), c.x(),
                          c.y(), c.z());
  }
  core::write_file(folder / "cameras.txt", cameras);
  core::write_file(folder / "images.txt", images);
  core::write_file(folder / "points3D.txt", points);
}

void write_binary(const Path& folder, const Dataset& dataset) {
  std::string cameras;
  put_bytes<std::uint64_t>(cameras, dataset.cameras.size());
  for (std::size_t i = 0; i < dataset.cameras.size(); ++i) {
    const auto& camera = dataset.cameras[i];
    put_bytes(cameras, static_cast<std::uint32_t>(i + 1));
    put_bytes(cameras, static_cast<std::int32_t>(lens_of(camera).id));
    put_bytes(cameras, static_cast<std::uint64_t>(camera.width_px()));
    put_bytes(cameras, static_cast<std::uint64_t>(camera.height_px()));
    for (const double value : parameters_of(camera)) put_bytes(cameras, value);
  }
  std::string images;
  put_bytes<std::uint64_t>(images, dataset.frames.size());
  for (std::size_t i = 0; i < dataset.frames.size(); ++i) {
    const DatasetFrame& frame = dataset.frames[i];
    put_bytes(images, static_cast<std::uint32_t>(i + 1));
    for (const double value : pose_values(frame)) put_bytes(images, value);
    put_bytes(images, static_cast<std::uint32_t>(frame.camera + 1));
    images += frame.image + '\0';
    put_bytes<std::uint64_t>(images, 0);  // points of the image
  }
  std::string points;
  put_bytes<std::uint64_t>(points, dataset.points.size());
  for (std::size_t i = 0; i < dataset.points.size(); ++i) {
    const DatasetPoint& point = dataset.points[i];
    put_bytes<std::uint64_t>(points, i + 1);
    for (const double value : point.position) put_bytes(points, value);
    for (const int value : point.colour) put_bytes(points, static_cast<std::uint8_t>(value));
    put_bytes(points, 0.0);               // its error
    put_bytes<std::uint64_t>(points, 0);  // its track
  }
  core::write_file(folder / "cameras.bin", cameras);
  core::write_file(folder / "images.bin", images);
  core::write_file(folder / "points3D.bin", points);
}

std::optional<Path> find_colmap_model(const Path& path) {
  std::error_code no_throw;
  for (const char* place : {"", "sparse/0", "sparse", "colmap/sparse/0"}) {
    for (const char* name : {"cameras.bin", "cameras.txt"}) {
      if (std::filesystem::exists(path / place / name, no_throw)) return path / place;
    }
  }
  return std::nullopt;
}

Dataset read_named_model(const Path& folder, const Path& /*images*/) {
  return read_colmap_model(folder);
}

template <ColmapForm form>
void write_into_project(const Path& folder, const Dataset& dataset) {
  const Path model = folder / "sparse" / "0";
  std::filesystem::create_directories(model);
  // Names of images are relative to the folder images/ there.
  Dataset named = dataset;
  for (DatasetFrame& frame : named.frames) {
    frame.image = Path(frame.image).lexically_relative("images").generic_string();
  }
  write_colmap_model(model, named, form);
}

}  // namespace

Dataset read_colmap_model(const Path& folder) {
  Dataset dataset;
  std::error_code no_throw;
  if (std::filesystem::exists(folder / "cameras.bin", no_throw)) {
    const auto indices = read_binary_cameras(folder / "cameras.bin", dataset);
    read_binary_images(folder / "images.bin", indices, dataset);
  } else {
    const auto indices = read_text_cameras(folder / "cameras.txt", dataset);
    read_text_images(folder / "images.txt", indices, dataset);
  }
  if (dataset.frames.empty()) refuse_colmap(folder, "has no images");
  return dataset;
}

void write_colmap_model(const Path& folder, const Dataset& dataset, ColmapForm form) {
  form == ColmapForm::text ? write_text(folder, dataset) : write_binary(folder, dataset);
}

constinit const DatasetFormat kColmapFormat{.name = "colmap",
                                            .sentence = "COLMAP, 3DGS: images and a binary model",
                                            .find = find_colmap_model,
                                            .read = read_named_model,
                                            .write = write_into_project<ColmapForm::binary>};
constinit const DatasetFormat kColmapTextFormat{.name = "colmap-text",
                                                .sentence = "the same with a model of text files",
                                                .find = find_colmap_model,
                                                .read = read_named_model,
                                                .write = write_into_project<ColmapForm::text>};

}  // namespace sheen::capture
