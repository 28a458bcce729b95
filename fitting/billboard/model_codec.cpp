// SPDX-License-Identifier: MIT
#include "fitting/billboard/model_codec.h"

#include "core/image/jpeg.h"
#include "core/image/png.h"
#include "fitting/billboard/billboards.h"
#include "fitting/billboard/directions.h"
#include "fitting/mean/model_codec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

namespace sheen::fitting::billboard {
namespace {

constexpr const char* kBlended = "blended";
constexpr const char* kNearest = "nearest";

using CropRecord = std::array<std::uint32_t, 6>;

struct PackedFrames {
  std::vector<CropRecord> crops;
  std::vector<std::uint8_t> images;
};

int count_of(const ModelPart& part, const char* name) {
  constexpr std::size_t most = std::numeric_limits<int>::max();
  return static_cast<int>(std::min(required_size(part.parameters, name), most));
}

Options options_from(const ModelPart& part) {
  const std::string blending = required_string(part.parameters, "blending");
  if (blending != kBlended && blending != kNearest) throw ModelFault("its blending is unknown");
  Options options;
  options.directions = count_of(part, "directions");
  options.side_px = count_of(part, "size");
  options.field_of_view_deg = required_number(part.parameters, "fieldOfView");
  options.blending = blending == kNearest ? Blending::nearest : Blending::blended;
  options.views.cache_mb = count_of(part, "cacheMb");
  try {
    options.check();
  } catch (const std::invalid_argument& fault) {
    throw ModelFault(std::string("its ") + fault.what());
  }
  return options;
}

Sphere sphere_from(const ModelPart& part) {
  const auto& numbers = required(part.parameters, "centre");
  Sphere sphere{Eigen::Vector3f::Zero(),
                static_cast<float>(required_number(part.parameters, "radius"))};
  const bool three = numbers.is_array() && numbers.size() == 3;
  for (int i = 0; three && i < 3; ++i) {
    const auto& number = numbers[static_cast<std::size_t>(i)];
    sphere.centre[i] = number.is_number() ? number.get<float>() : std::nanf("");
  }
  if (!three || !sphere.centre.allFinite() || !std::isfinite(sphere.radius_m) ||
      !(sphere.radius_m > 0.0f)) {
    throw ModelFault("its sphere is none");
  }
  return sphere;
}

cv::Rect crop_from(const CropRecord& record, int side_px) {
  const auto side = static_cast<std::uint64_t>(side_px);
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    if (record[i + 2] == 0 || std::uint64_t{record[i]} + record[i + 2] > side) {
      throw ModelFault("a frame is larger than it can be");
    }
  }
  return {static_cast<int>(record[0]), static_cast<int>(record[1]), static_cast<int>(record[2]),
          static_cast<int>(record[3])};
}

/// The next bytes of `images`.
std::vector<std::uint8_t> take(std::size_t count, std::span<const std::byte>& images) {
  std::vector<std::uint8_t> bytes(count);
  if (count > 0) std::memcpy(bytes.data(), images.data(), count);
  images = images.subspan(count);
  return bytes;
}

Frame frame_from(const CropRecord& record, int side_px, std::span<const std::byte>& images) {
  Frame frame{crop_from(record, side_px), take(record[4], images), take(record[5], images)};
  if (core::jpeg_size(std::as_bytes(std::span(frame.colour))) != frame.crop.size() ||
      core::png_size(std::as_bytes(std::span(frame.shape))) != frame.crop.size()) {
    throw ModelFault("a frame is no image of its size");
  }
  return frame;
}

}  // namespace

ModelPart encode_model(const LightField& light_field) {
  const auto& model = dynamic_cast<const Billboards&>(light_field);
  const Options& options = model.options();
  ModelPart part = mean::encode_model(model.means());
  const auto packed = std::make_shared<PackedFrames>();
  for (std::size_t i = 0; i < model.element_count(); ++i) {
    const Frame& frame = model.frame(i);
    const auto number = [](auto value) { return static_cast<std::uint32_t>(value); };
    packed->crops.push_back({number(frame.crop.x), number(frame.crop.y), number(frame.crop.width),
                             number(frame.crop.height), number(frame.colour.size()),
                             number(frame.shape.size())});
    for (const auto* const image : {&frame.colour, &frame.shape}) {
      packed->images.insert(packed->images.end(), image->begin(), image->end());
    }
  }
  const Eigen::Vector3f& centre = model.sphere().centre;
  part.parameters["directions"] = static_cast<unsigned>(options.directions);
  part.parameters["size"] = static_cast<unsigned>(options.side_px);
  part.parameters["fieldOfView"] = options.field_of_view_deg;
  part.parameters["blending"] = options.blending == Blending::nearest ? kNearest : kBlended;
  part.parameters["centre"] = {centre.x(), centre.y(), centre.z()};
  part.parameters["radius"] = model.sphere().radius_m;
  part.parameters["cacheMb"] = static_cast<unsigned>(options.views.cache_mb);
  part.arrays["crops"] = std::as_bytes(std::span(packed->crops));
  // glTF knows no empty bufferView.
  if (!packed->images.empty()) part.arrays["images"] = std::as_bytes(std::span(packed->images));
  part.owner = packed;
  return part;
}

std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh) {
  const auto means = mean::decode_model(part, mesh);
  const Options options = options_from(part);
  auto model = std::make_unique<Billboards>(options, sphere_from(part), mesh.positions.size());
  model->set_means(dynamic_cast<const mean::MeanLightField&>(*means));
  std::vector<CropRecord> crops(model->element_count());
  const auto crop_bytes = required_bytes(part, "crops", crops.size() * sizeof(CropRecord));
  std::memcpy(crops.data(), crop_bytes.data(), crop_bytes.size());
  std::size_t total = 0;
  for (const CropRecord& record : crops) total += std::size_t{record[4]} + record[5];
  auto images = total > 0 ? required_bytes(part, "images", total) : std::span<const std::byte>{};
  for (std::size_t i = 0; i < crops.size(); ++i) {
    if (crops[i] == CropRecord{}) continue;
    model->set_frame(i, frame_from(crops[i], options.side_px, images));
  }
  return model;
}

}  // namespace sheen::fitting::billboard
