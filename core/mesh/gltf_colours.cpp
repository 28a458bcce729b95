// SPDX-License-Identifier: MIT
#include "core/mesh/gltf_colours.h"

#include "core/image/jpeg.h"
#include "core/image/png.h"
#include "core/image/srgb_curve.h"
#include "core/mesh/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sheen::core {
namespace {

using nlohmann::json;

constexpr int kMostPictureSide = 16384;
constexpr double kMostPicturePixels = 1 << 26;

/// Nothing where it is no JPEG or PNG that is read here.
cv::Mat decoded_picture(std::span<const std::byte> bytes, double most_pixels) {
  const auto is_small = [most_pixels](const cv::Size& size) {
    return std::max(size.width, size.height) <= kMostPictureSide &&
           static_cast<double>(size.width) * size.height <= most_pixels;
  };
  if (const auto size = jpeg_size(bytes); size && is_small(*size)) {
    return decode_jpeg(bytes, *size).value_or(cv::Mat());
  }
  if (const auto size = png_size(bytes); size && is_small(*size)) {
    return decode_png(bytes, *size).value_or(cv::Mat());
  }
  return {};
}

Eigen::Vector3d light_of(const cv::Vec3b& bgr) {
  Eigen::Vector3d light;
  for (int c = 0; c < 3; ++c) {
    light[c] = static_cast<double>(linear_from_srgb(static_cast<float>(bgr[2 - c]) / 255.0f));
  }
  return light;
}

/// Between four pixels of a picture that repeats; (0, 0) is its upper left corner, (1, 1) its lower
/// right one. Black for what is no place.
Eigen::Vector3d light_at(const cv::Mat& picture, double u, double v) {
  const auto place = [](double share, int side) {
    const double from_middle = (share - std::floor(share)) * side - 0.5;
    return std::isfinite(from_middle) ? from_middle : 0.0;
  };
  const double x = place(u, picture.cols);
  const double y = place(v, picture.rows);
  const double right = x - std::floor(x);
  const double below = y - std::floor(y);
  const auto at = [&](int dx, int dy) {
    const auto index = [](double first, int more, int side) {
      return (static_cast<int>(std::floor(first)) + more + side) % side;
    };
    return light_of(picture.at<cv::Vec3b>(index(y, dy, picture.rows), index(x, dx, picture.cols)));
  };
  return (1 - below) * ((1 - right) * at(0, 0) + right * at(1, 0)) +
         below * ((1 - right) * at(0, 1) + right * at(1, 1));
}

}  // namespace

const cv::Mat& GltfColours::picture(std::size_t image_idx) {
  if (const auto known = pictures_.find(image_idx); known != pictures_.end()) return known->second;
  const json& image = gltf_entry(gltf_.document, "images", image_idx);
  cv::Mat pixels;
  if (image.contains("bufferView")) {
    pixels = decoded_picture(accessors_.view(gltf_size(image, "bufferView")).bytes,
                             kMostPicturePixels - picture_pixels_);
  }
  picture_pixels_ += static_cast<double>(pixels.total());
  has_unread_picture_ |= pixels.empty();
  return pictures_.emplace(image_idx, std::move(pixels)).first->second;
}

void GltfColours::multiply_picture(const json& texture, const json& attributes,
                                   std::vector<Eigen::Vector3d>& light) {
  const json& source = gltf_entry(gltf_.document, "textures", gltf_size(texture, "index"));
  if (!source.contains("source")) {
    has_unread_picture_ = true;
    return;
  }
  const cv::Mat& pixels = picture(gltf_size(source, "source"));
  const std::string places = "TEXCOORD_" + std::to_string(gltf_size(texture, "texCoord", 0));
  if (pixels.empty() || !attributes.contains(places)) return;
  has_moved_picture_ |= gltf_extension(texture, "KHR_texture_transform") != nullptr;
  const auto numbers = accessors_.numbers(gltf_size(attributes, places.c_str()), 2);
  if (numbers.size() != 2 * light.size()) {
    throw GltfFault("has not as many places in its picture as positions");
  }
  for (std::size_t i = 0; i < light.size(); ++i) {
    light[i] = light[i].cwiseProduct(light_at(pixels, numbers[2 * i], numbers[2 * i + 1]));
  }
}

std::vector<Eigen::Vector3f> GltfColours::of(const json& primitive, std::size_t vertices) {
  std::vector<Eigen::Vector3d> light(vertices, Eigen::Vector3d::Ones());
  bool is_coloured = false;
  const json& attributes = gltf_member(primitive, "attributes");
  const bool is_packed = gltf_extension(primitive, "KHR_draco_mesh_compression") != nullptr;

  if (attributes.contains("COLOR_0") && is_packed) has_packed_colours_ = true;
  if (attributes.contains("COLOR_0") && !is_packed) {
    const std::size_t accessor = gltf_size(attributes, "COLOR_0");
    const std::size_t channels = accessors_.has_type(accessor, 4) ? 4 : 3;
    const auto numbers = accessors_.numbers(accessor, channels);
    if (numbers.size() != channels * vertices) {
      throw GltfFault("has not as many colours as positions");
    }
    for (std::size_t i = 0; i < vertices; ++i) {
      const double* const first = numbers.data() + channels * i;
      light[i] = {first[0], first[1], first[2]};
    }
    is_coloured = true;
  }

  if (primitive.contains("material")) {
    const json& material =
        gltf_entry(gltf_.document, "materials", gltf_size(primitive, "material"));
    const json& surface = gltf_member(material, "pbrMetallicRoughness");
    if (const auto rgba = gltf_numbers(surface, "baseColorFactor", 4)) {
      const Eigen::Vector3d factor((*rgba)[0], (*rgba)[1], (*rgba)[2]);
      for (Eigen::Vector3d& one : light) one = one.cwiseProduct(factor);
      is_coloured = true;
    }
    if (const json& texture = gltf_member(surface, "baseColorTexture"); texture.is_object()) {
      has_packed_colours_ |= is_packed;
      if (!is_packed) multiply_picture(texture, attributes, light);
      is_coloured = true;
    }
  }

  std::vector<Eigen::Vector3f> colours;
  if (!is_coloured) return colours;
  for (const Eigen::Vector3d& one : light) {
    colours.push_back(
        displayed(one).unaryExpr([](float value) { return srgb_from_linear(value); }));
  }
  return colours;
}

std::vector<std::string> GltfColours::notes() const {
  std::vector<std::string> notes;
  if (has_unread_picture_) {
    notes.emplace_back(
        "has a picture that is no JPEG or PNG of three channels of 8 bits within the file, which "
        "is passed over");
  }
  if (has_moved_picture_) {
    notes.emplace_back("has a picture that KHR_texture_transform moves, which is passed over");
  }
  if (has_packed_colours_) {
    notes.emplace_back(
        "has colours compressed by KHR_draco_mesh_compression, which are passed over; export it "
        "without compression");
  }
  return notes;
}

}  // namespace sheen::core
