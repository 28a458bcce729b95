// SPDX-License-Identifier: MIT
#include "capture/calibration/camera_document.h"

#include "capture/calibration/colmap_lens.h"
#include "core/diagnostics/error.h"
#include "core/text/nesting.h"
#include "core/text/number.h"

#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <sstream>

namespace sheen::capture {
namespace {

constexpr std::size_t kMostWords = 64;  // of one key: a matrix of 3 x 4 and coefficients are fewer

[[noreturn]] void fail_unknown(const std::filesystem::path& path) {
  refuse_camera_file(
      path,
      "is neither in OpenCV's FileStorage form nor a camera file of ROS, Kalibr, Agisoft, COLMAP "
      "or "
      "nerfstudio");
}

void append_words(const std::string& text, std::vector<std::string>& words) {
  std::istringstream stream(text);
  for (std::string word; words.size() <= kMostWords && stream >> word;) words.push_back(word);
}

// YAML: keys with a scalar, a list, a list of lists, or a matrix with its numbers under "data".

void append_scalars(const YAML::Node& node, std::vector<std::string>& words, int depth = 0) {
  if (words.size() > kMostWords || depth > 4) return;
  if (node.IsScalar()) words.push_back(node.Scalar());
  if (!node.IsSequence()) return;
  for (const YAML::Node& entry : node) {
    if (words.size() > kMostWords) return;
    append_scalars(entry, words, depth + 1);
  }
}

CameraKeys yaml_keys(const YAML::Node& map) {
  CameraKeys keys;
  for (const auto& member : map) {
    if (!member.first.IsScalar()) continue;
    const YAML::Node& value = member.second;
    if (member.first.Scalar() == "roi" && value.IsMap()) {
      for (auto& [key, words] : yaml_keys(value)) keys["roi." + key] = std::move(words);
    }
    if (value.IsMap() && !value["data"]) continue;
    std::vector<std::string> words;
    append_scalars(value.IsMap() ? value["data"] : value, words);
    if (words.size() <= kMostWords) keys[member.first.Scalar()] = std::move(words);
  }
  return keys;
}

/// ORB-SLAM writes Camera.fx, its third version Camera1.fx beside Camera.width; what follows the
/// point is the key.
CameraKeys without_prefixes(CameraKeys keys, const std::filesystem::path& path) {
  if (!keys.contains("Camera.fx") && !keys.contains("Camera1.fx")) return keys;
  if (keys.contains("Camera2.fx")) {
    refuse_camera_file(path, "holds 2 cameras (Camera1, Camera2)",
                       "keep the one that took the images");
  }
  CameraKeys plain;
  for (auto& [key, words] : keys) {
    const std::size_t point = key.find('.');
    const std::string prefix = key.substr(0, point);
    if (point == std::string::npos || (prefix != "Camera" && prefix != "Camera1")) continue;
    const std::string name = key.substr(point + 1);
    plain[name == "type" ? "camera_type" : name] = std::move(words);
  }
  return plain;
}

bool is_kalibr_camera(const std::string& key) {
  return key.size() > 3 && key.starts_with("cam") &&
         std::all_of(key.begin() + 3, key.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// The text without OpenCV's first line, which is no YAML for anybody else.
std::string without_directive(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\n");
  if (begin == std::string::npos || text.compare(begin, 5, "%YAML") != 0) return text;
  return text.substr(std::min(text.find('\n', begin), text.size()));
}

CameraKeys read_yaml(const std::string& text, const std::filesystem::path& path) {
  YAML::Node root;
  try {
    root = YAML::Load(without_directive(text));
  } catch (const YAML::Exception&) {
    fail_unknown(path);
  }
  if (!root.IsMap()) fail_unknown(path);
  std::vector<std::string> cameras;
  for (const auto& member : root) {
    if (member.first.IsScalar() && is_kalibr_camera(member.first.Scalar()) &&
        member.second.IsMap()) {
      cameras.push_back(member.first.Scalar());
    }
  }
  if (cameras.size() > 1) {
    refuse_camera_file(path,
                       "holds " + std::to_string(cameras.size()) + " cameras (" + cameras[0] +
                           ", " + cameras[1] + (cameras.size() > 2 ? ", ..." : "") + ")",
                       "keep the one that took the images");
  }
  return without_prefixes(yaml_keys(cameras.empty() ? root : root[cameras[0]]), path);
}

void append_scalars(const nlohmann::json& node, std::vector<std::string>& words, int depth = 0) {
  if (words.size() > kMostWords || depth > 4) return;
  if (node.is_string()) words.push_back(node.get<std::string>());
  if (node.is_number() || node.is_boolean()) words.push_back(node.dump());
  if (!node.is_array()) return;
  for (const nlohmann::json& entry : node) {
    if (words.size() > kMostWords) return;
    append_scalars(entry, words, depth + 1);
  }
}

CameraKeys read_json(const std::string& text, const std::filesystem::path& path) {
  const auto root = nlohmann::json::parse(text, nullptr, false);
  if (!root.is_object()) fail_unknown(path);
  CameraKeys keys;
  for (const auto& [key, value] : root.items()) {
    std::vector<std::string> words;
    append_scalars(value.is_object() && value.contains("data") ? value["data"] : value, words);
    if (words.size() <= kMostWords) keys[key] = std::move(words);
  }
  return keys;
}

// XML.

CameraKeys xml_keys(const pugi::xml_node& parent) {
  CameraKeys keys;
  for (const pugi::xml_node& child : parent.children()) {
    std::vector<std::string> words;
    const pugi::xml_node data = child.child("data");
    append_words(data ? data.child_value() : child.child_value(), words);
    if (words.size() <= kMostWords) keys[child.name()] = std::move(words);
  }
  // Agisoft's projects write the size as attributes.
  if (const pugi::xml_node resolution = parent.child("resolution")) {
    keys["width"] = {resolution.attribute("width").value()};
    keys["height"] = {resolution.attribute("height").value()};
  }
  if (const pugi::xml_attribute type = parent.attribute("type"))
    keys["projection"] = {type.value()};
  return keys;
}

/// The calibration of the only sensor that a project has adjusted.
pugi::xml_node project_calibration(const pugi::xml_document& document,
                                   const std::filesystem::path& path) {
  std::vector<pugi::xml_node> found;
  for (const pugi::xpath_node& node :
       document.select_nodes("/document/chunk/sensors/sensor/calibration[@class='adjusted']")) {
    found.push_back(node.node());
  }
  if (found.empty())
    refuse_camera_file(path, "is an Agisoft project without an adjusted calibration",
                       "align the photos, or export the calibration of the camera");
  if (found.size() > 1) {
    refuse_camera_file(path,
                       "is an Agisoft project of " + std::to_string(found.size()) + " sensors",
                       "export the calibration of the camera that took the images");
  }
  return found.front();
}

CameraDocument read_xml(const std::string& text, const std::filesystem::path& path) {
  pugi::xml_document document;
  if (!document.load_buffer(text.data(), text.size())) fail_unknown(path);
  if (const pugi::xml_node storage = document.child("opencv_storage")) {
    return {xml_keys(storage), false, {}};
  }
  if (const pugi::xml_node calibration = document.child("calibration")) {
    return {xml_keys(calibration), true, {}};
  }
  if (document.child("document")) return {xml_keys(project_calibration(document, path)), true, {}};
  fail_unknown(path);
}

// COLMAP: CAMERA_ID MODEL WIDTH HEIGHT PARAMS...

/// Nothing for a line of another form.
std::optional<LensRecord> colmap_camera(const std::vector<std::string>& words,
                                        const std::filesystem::path& path) {
  if (words.size() < 4 || !core::parse_whole_number(words[0])) return std::nullopt;
  const auto width_px = core::parse_whole_number(words[2]);
  const auto height_px = core::parse_whole_number(words[3]);
  if (!width_px || !height_px) return std::nullopt;
  const std::string model = core::quotable(words[1]);
  const ColmapLens* lens = find_colmap_lens(words[1]);
  if (lens == nullptr) {
    refuse_camera_file(
        path, "is of the camera model " + model + ", which is not read",
        "use OPENCV or another of COLMAP's models with radial and tangential distortion");
  }
  std::vector<double> values;
  for (std::size_t i = 4; i < words.size(); ++i) {
    const auto number = core::parse_number(words[i]);
    if (!number) {
      refuse_camera_file(path,
                         "holds something not a number (" + core::why_no_number(words[i]) + ")");
    }
    values.push_back(*number);
  }
  if (values.size() != lens->parameter_count()) {
    refuse_camera_file(path, "holds " + std::to_string(values.size()) +
                                 " parameters of the model " + model + ", which has " +
                                 std::to_string(lens->parameter_count()));
  }
  constexpr long long most = 1LL << 20;
  return colmap_record(*lens, static_cast<int>(std::clamp(*width_px, 0LL, most)),
                       static_cast<int>(std::clamp(*height_px, 0LL, most)), values);
}

std::optional<LensRecord> read_colmap(const std::string& text, const std::filesystem::path& path) {
  std::istringstream lines(text);
  std::optional<LensRecord> found;
  int cameras = 0;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> words;
    append_words(line, words);
    if (words.empty() || words[0].starts_with('#')) continue;
    auto camera = colmap_camera(words, path);
    if (!camera) return std::nullopt;
    found = std::move(camera);
    ++cameras;
  }
  if (cameras > 1) {
    refuse_camera_file(path, "holds " + std::to_string(cameras) + " cameras",
                       "keep the one that took the images");
  }
  return found;
}

}  // namespace

CameraDocument parse_camera_document(const std::string& text, const std::filesystem::path& path) {
  const std::size_t begin = text.find_first_not_of(" \t\n");
  if (begin == std::string::npos) fail_unknown(path);
  if (text[begin] == '<') return read_xml(text, path);
  if (core::bracket_depth(text) > core::kMostNesting) {
    refuse_camera_file(path, "is nested too deeply for a camera file");
  }
  if (text[begin] == '{') return {read_json(text, path), false, {}};
  if (text[begin] != '%') {
    if (auto record = read_colmap(text, path)) return {{}, false, std::move(record)};
  }
  return {read_yaml(text, path), false, {}};
}

}  // namespace sheen::capture
