// SPDX-License-Identifier: MIT
#include "capture/dataset/metashape_file.h"

#include "capture/calibration/camera_file.h"
#include "core/diagnostics/error.h"
#include "core/files/read_file.h"
#include "core/text/lower_case.h"
#include "core/text/number.h"

#include <pugixml.hpp>

#include <cmath>
#include <map>
#include <sstream>

namespace sheen::capture {
namespace {

namespace fs = std::filesystem;

constexpr double kFarthest_m = 1e5;  // from the origin; what is farther lies on the globe

[[noreturn]] void refuse_metashape(
    const fs::path& path, const std::string& fault,
    const std::string& remedy = "export the cameras again, as Agisoft XML") {
  throw core::bad_input(path, fault, remedy);
}

/// So many finite numbers of an element's text.
template <int kCount>
Eigen::Matrix<double, kCount, 1> numbers_of(const fs::path& path, const pugi::xml_node& node) {
  Eigen::Matrix<double, kCount, 1> numbers;
  std::istringstream words(node.child_value());
  std::string word;
  int count = 0;
  while (words >> word) {
    const auto number = core::parse_number(word);
    if (count == kCount || !number || !std::isfinite(*number)) break;
    numbers[count++] = *number;
    word.clear();
  }
  if (count != kCount || !word.empty()) {
    refuse_metashape(path, std::string("has a ") + node.name() + " that is not " +
                               std::to_string(kCount) + " numbers");
  }
  return numbers;
}

/// From the chunk's axes to the world's: rotation, translation, scale.
struct Similarity {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  double scale = 1;
};

Similarity world_from_chunk(const fs::path& path, const pugi::xml_node& chunk) {
  pugi::xml_node transform = chunk.child("transform");
  // Since version 1.5 a component has it.
  if (!transform) transform = chunk.child("components").child("component").child("transform");
  Similarity similarity;
  if (const pugi::xml_node rotation = transform.child("rotation")) {
    const auto rows = numbers_of<9>(path, rotation);
    const auto nearest = nearest_rotation(
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data()));
    if (!nearest) refuse_metashape(path, "has a rotation of the chunk that is none");
    similarity.rotation = *nearest;
  }
  if (const pugi::xml_node translation = transform.child("translation")) {
    similarity.translation = numbers_of<3>(path, translation);
  }
  if (const pugi::xml_node scale = transform.child("scale")) {
    similarity.scale = numbers_of<1>(path, scale)[0];
  }
  if (!(similarity.scale > 0)) refuse_metashape(path, "has a scale of the chunk that is none");
  if (similarity.translation.norm() > kFarthest_m) {
    refuse_metashape(path, "lies on the globe, farther from its origin than single meshes can",
                     "choose local coordinates for the chunk and export cameras and mesh again");
  }
  return similarity;
}

/// Names of the images by their stems, for labels that lack the ending.
std::map<std::string, std::string> names_by_stem(const fs::path& images) {
  std::map<std::string, std::string> names;
  std::error_code fault;
  for (fs::directory_iterator entry(images, fault), last; !fault && entry != last;
       entry.increment(fault)) {
    names.emplace(entry->path().stem().string(), entry->path().filename().string());
  }
  return names;
}

std::optional<fs::path> find_metashape(const fs::path& path) {
  const bool is_one = core::lower_case(path.extension().string()) == ".xml";
  return is_one ? std::optional(path) : std::nullopt;
}

}  // namespace

Dataset read_metashape(const fs::path& path, const fs::path& images) {
  const std::string text = core::read_file(path, kMostDatasetBytes);
  pugi::xml_document document;
  const bool is_xml = static_cast<bool>(document.load_buffer(text.data(), text.size()));
  const auto chunks = document.select_nodes("/document/chunk");
  if (!is_xml || chunks.size() != 1) refuse_metashape(path, "is no Agisoft XML of one chunk");
  const pugi::xml_node chunk = chunks.first().node();
  const Similarity place = world_from_chunk(path, chunk);
  const auto names = names_by_stem(images);

  Dataset dataset;
  dataset.cameras = {read_camera(path)};
  for (const pugi::xpath_node& found : chunk.select_nodes("cameras//camera[transform]")) {
    const pugi::xml_node camera = found.node();
    if (!camera.attribute("enabled").as_bool(true)) continue;
    std::string label = image_within(path, camera.attribute("label").value());
    std::error_code no_throw;
    if (!fs::exists(images / label, no_throw)) {
      if (const auto named = names.find(label); named != names.end()) label = named->second;
    }
    const auto rows = numbers_of<16>(path, camera.child("transform"));
    const Eigen::Matrix4d pose =
        Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(rows.data());
    const auto rotation = nearest_rotation(pose.topLeftCorner<3, 3>());
    if (!rotation) refuse_metashape(path, "has no rigid pose of " + core::quotable(label));
    DatasetFrame frame{.image = label};
    frame.world_from_camera.linear() = place.rotation * *rotation;
    frame.world_from_camera.translation() =
        place.scale * (place.rotation * pose.topRightCorner<3, 1>()) + place.translation;
    dataset.frames.push_back(std::move(frame));
  }
  if (dataset.frames.empty()) refuse_metashape(path, "has no aligned cameras");
  return dataset;
}

constinit const DatasetFormat kMetashapeFormat{.name = "metashape",
                                               .sentence = "cameras of Agisoft Metashape (.xml)",
                                               .find = find_metashape,
                                               .read = read_metashape,
                                               .write = nullptr};

}  // namespace sheen::capture
