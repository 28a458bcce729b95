// SPDX-License-Identifier: MIT
#include "capture/pose/tag_family.h"

#include "capture/pose/apriltag_family.h"

#include <opencv2/aruco.hpp>

#include <array>

namespace sheen::capture {
namespace {

struct Dictionary {
  const char* name;
  int id;
};

constexpr std::array<Dictionary, 21> kDictionaries{{
    {"DICT_4X4_50", cv::aruco::DICT_4X4_50},
    {"DICT_4X4_100", cv::aruco::DICT_4X4_100},
    {"DICT_4X4_250", cv::aruco::DICT_4X4_250},
    {"DICT_4X4_1000", cv::aruco::DICT_4X4_1000},
    {"DICT_5X5_50", cv::aruco::DICT_5X5_50},
    {"DICT_5X5_100", cv::aruco::DICT_5X5_100},
    {"DICT_5X5_250", cv::aruco::DICT_5X5_250},
    {"DICT_5X5_1000", cv::aruco::DICT_5X5_1000},
    {"DICT_6X6_50", cv::aruco::DICT_6X6_50},
    {"DICT_6X6_100", cv::aruco::DICT_6X6_100},
    {"DICT_6X6_250", cv::aruco::DICT_6X6_250},
    {"DICT_6X6_1000", cv::aruco::DICT_6X6_1000},
    {"DICT_7X7_50", cv::aruco::DICT_7X7_50},
    {"DICT_7X7_100", cv::aruco::DICT_7X7_100},
    {"DICT_7X7_250", cv::aruco::DICT_7X7_250},
    {"DICT_7X7_1000", cv::aruco::DICT_7X7_1000},
    {"DICT_ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL},
    {"DICT_APRILTAG_16h5", cv::aruco::DICT_APRILTAG_16h5},
    {"DICT_APRILTAG_25h9", cv::aruco::DICT_APRILTAG_25h9},
    {"DICT_APRILTAG_36h10", cv::aruco::DICT_APRILTAG_36h10},
    {"DICT_APRILTAG_36h11", cv::aruco::DICT_APRILTAG_36h11},
}};

std::optional<TagFamily> find_dictionary(const std::string& name, int border_bits) {
  for (const Dictionary& dictionary : kDictionaries) {
    if (name != dictionary.name) continue;
    const auto codes = cv::aruco::getPredefinedDictionary(dictionary.id);
    return TagFamily{TagFamily::Library::aruco, name, dictionary.id, false,
                     codes->markerSize + 2 * border_bits};
  }
  return std::nullopt;
}

}  // namespace

std::optional<TagFamily> find_tag_family(const std::string& name, int border_bits) {
  if (border_bits < 1 || border_bits > 4) return std::nullopt;
  if (name.starts_with("DICT_")) return find_dictionary(name, border_bits);
  const auto family = AprilTagFamily::find(name);
  if (!family) return std::nullopt;
  if (border_bits == 1) {
    return TagFamily{TagFamily::Library::apriltag, name, -1, false, family->get()->width_at_border};
  }
  if (!name.starts_with("tag")) return std::nullopt;
  auto dictionary = find_dictionary("DICT_APRILTAG_" + name.substr(3), border_bits);
  if (dictionary) dictionary->half_turn = true;
  return dictionary;
}

int code_count(const TagFamily& family) {
  if (family.library == TagFamily::Library::aruco) {
    return cv::aruco::getPredefinedDictionary(family.aruco_dictionary_id)->bytesList.rows;
  }
  return static_cast<int>(AprilTagFamily::find(family.name)->get()->ncodes);
}

}  // namespace sheen::capture
