// SPDX-License-Identifier: MIT
#include "fitting/multi_eigenspace/model_codec.h"

#include "fitting/mean/model_codec.h"
#include "fitting/multi_eigenspace/multi_eigenspace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace sheen::fitting::multi_eigenspace {
namespace {

using Vector = std::array<double, 3>;
using Frame = std::array<double, 7>;
using Entry = std::array<std::uint32_t, 2>;

constexpr const char* kCrossFade = "cross-fade";
constexpr const char* kHard = "hard";
constexpr std::size_t kMostViews = std::size_t{1} << 16;
constexpr std::size_t kChannels = 4;

struct StoredArrays {
  Frame frame{};
  std::vector<Vector> directions;
  std::vector<std::uint32_t> dimensions;
  std::vector<std::byte> means, images;
  std::vector<float> steps;
  std::vector<Entry> entries;
  std::vector<std::int16_t> coefficients;
};

void append(const cv::Mat& picture, std::vector<std::byte>& bytes) {
  const auto* const begin = reinterpret_cast<const std::byte*>(picture.data);
  bytes.insert(bytes.end(), begin, begin + picture.total() * picture.elemSize());
}

StoredArrays arrays_of(const MultiEigenspace& model) {
  StoredArrays arrays;
  const auto& [centre, radius_m, up] = model.frame();
  arrays.frame = {centre.x(), centre.y(), centre.z(), radius_m, up.x(), up.y(), up.z()};
  for (const auto& one : model.directions()) {
    arrays.directions.push_back({one.x(), one.y(), one.z()});
  }
  for (const Eigenspace& space : model.spaces()) {
    arrays.dimensions.push_back(static_cast<std::uint32_t>(space.images.size()));
    append(space.mean, arrays.means);
    for (const cv::Mat& image : space.images) append(image, arrays.images);
    arrays.steps.insert(arrays.steps.end(), space.steps.begin(), space.steps.end());
  }
  for (const ViewInSpace& one : model.views()) {
    arrays.entries.push_back({one.view_idx, one.space_idx});
    arrays.coefficients.insert(arrays.coefficients.end(), one.coefficients.begin(),
                               one.coefficients.end());
  }
  return arrays;
}

// ---- reading ----

template <typename T>
std::vector<T> required_records(const ModelPart& part, const char* name, std::size_t count) {
  std::vector<T> records(count);
  if (count == 0) return records;
  const auto bytes = required_bytes(part, name, count * sizeof(T));
  std::memcpy(static_cast<void*>(records.data()), bytes.data(), bytes.size());
  return records;
}

Options options_from(const ModelPart& part) {
  const std::string switching = required_string(part.parameters, "switching");
  if (switching != kCrossFade && switching != kHard) throw ModelFault("its switching is unknown");
  constexpr std::size_t far_too_large = 10000;
  Options options;
  options.switching = switching == kHard ? Switching::hard : Switching::cross_fade;
  options.picture_px =
      static_cast<int>(std::min(required_size(part.parameters, "pictureSize"), far_too_large));
  try {
    options.check();
  } catch (const std::invalid_argument& fault) {
    throw ModelFault(std::string("its ") + fault.what());
  }
  return options;
}

bool is_unit(const Eigen::Vector3d& vector) {
  constexpr double rounding = 1e-6;
  return vector.allFinite() && std::abs(vector.norm() - 1) < rounding;
}

PictureFrame frame_from(const Frame& numbers) {
  const PictureFrame frame{
      {numbers[0], numbers[1], numbers[2]}, numbers[3], {numbers[4], numbers[5], numbers[6]}};
  const bool is_sphere = frame.centre.allFinite() && frame.radius_m > 0 &&
                         std::isfinite(frame.radius_m) && is_unit(frame.up);
  if (!is_sphere) throw ModelFault("its pictures have no place");
  return frame;
}

std::vector<Eigen::Vector3d> directions_from(const std::vector<Vector>& numbers) {
  std::vector<Eigen::Vector3d> directions;
  for (const Vector& one : numbers) {
    directions.emplace_back(one[0], one[1], one[2]);
    if (!is_unit(directions.back())) throw ModelFault("the direction of a view is none");
  }
  return directions;
}

/// Hands out pictures from an array.
class Pictures {
 public:
  Pictures(std::span<const std::byte> bytes, int side_px) : rest_(bytes), side_px_(side_px) {}

  cv::Mat next(int type) {
    cv::Mat picture(side_px_, side_px_, type);
    const std::size_t size = picture.total() * picture.elemSize();
    std::memcpy(picture.data, rest_.data(), size);
    rest_ = rest_.subspan(size);
    return picture;
  }

 private:
  std::span<const std::byte> rest_;
  int side_px_;
};

std::vector<Eigenspace> spaces_from(const ModelPart& part, std::size_t count, int side_px) {
  const auto dimensions = required_records<std::uint32_t>(part, "dimensions", count);
  const auto most = static_cast<std::uint32_t>(kMostEigenimages);
  if (std::ranges::any_of(dimensions, [&](std::uint32_t one) { return one > most; })) {
    throw ModelFault("an eigenspace has too many eigenimages");
  }
  const std::size_t total = std::accumulate(dimensions.begin(), dimensions.end(), std::size_t{0});
  const std::size_t size =
      kChannels * static_cast<std::size_t>(side_px) * static_cast<std::size_t>(side_px);
  Pictures means(required_bytes(part, "means", count * size), side_px);
  Pictures images(
      total > 0 ? required_bytes(part, "images", total * size) : std::span<const std::byte>(),
      side_px);
  const auto steps = required_records<float>(part, "steps", total);
  constexpr float largest_step = 1e4f;
  if (!std::ranges::all_of(steps, [](float one) { return one >= 0 && one < largest_step; })) {
    throw ModelFault("an eigenimage has no step");
  }
  std::vector<Eigenspace> spaces;
  auto step = steps.begin();
  for (const std::uint32_t own : dimensions) {
    Eigenspace& space = spaces.emplace_back();
    space.mean = means.next(CV_8UC4);
    for (std::uint32_t k = 0; k < own; ++k) {
      space.images.push_back(images.next(CV_8SC4));
      space.steps.push_back(*step++);
    }
  }
  return spaces;
}

std::vector<ViewInSpace> views_from(const ModelPart& part, const std::vector<Eigenspace>& spaces,
                                    const std::vector<std::uint32_t>& owners) {
  const std::size_t count = required_size(part.parameters, "entries");
  // In every space every view at most.
  if (count > owners.size() * spaces.size()) throw ModelFault("it has too many entries");
  const auto entries = required_records<Entry>(part, "entries", count);
  std::vector<std::uint8_t> owned(owners.size(), 0);
  std::size_t numbers = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [view, space] = entries[i];
    if (view >= owners.size() || space >= spaces.size() ||
        (i > 0 && entries[i] <= entries[i - 1])) {
      throw ModelFault("its entries are out of order");
    }
    if (owners[view] == space) owned[view] = 1;
    numbers += spaces[space].images.size();
  }
  if (std::ranges::count(owned, 0) > 0) throw ModelFault("a view is not in its own eigenspace");
  const auto coefficients = required_records<std::int16_t>(part, "viewCoefficients", numbers);
  std::vector<ViewInSpace> views;
  auto next = coefficients.begin();
  for (const auto& [view, space] : entries) {
    const auto end = next + static_cast<std::ptrdiff_t>(spaces[space].images.size());
    views.push_back({view, space, {next, end}});
    next = end;
  }
  return views;
}

}  // namespace

ModelPart encode_model(const LightField& light_field) {
  const auto& model = dynamic_cast<const MultiEigenspace&>(light_field);
  ModelPart part = mean::encode_model(model.means());
  part.parameters["pictureSize"] = static_cast<unsigned>(model.options().picture_px);
  part.parameters["switching"] = model.options().switching == Switching::hard ? kHard : kCrossFade;
  part.parameters["views"] = model.owners().size();
  part.parameters["spaces"] = model.spaces().size();
  part.parameters["entries"] = model.views().size();
  // glTF knows no empty bufferView.
  if (model.owners().empty()) return part;
  const auto arrays = std::make_shared<const StoredArrays>(arrays_of(model));
  part.arrays["frame"] = std::as_bytes(std::span(arrays->frame));
  part.arrays["directions"] = std::as_bytes(std::span(arrays->directions));
  part.arrays["owners"] = std::as_bytes(std::span(model.owners()));
  part.arrays["dimensions"] = std::as_bytes(std::span(arrays->dimensions));
  part.arrays["means"] = arrays->means;
  part.arrays["entries"] = std::as_bytes(std::span(arrays->entries));
  if (!arrays->steps.empty()) {
    part.arrays["images"] = arrays->images;
    part.arrays["steps"] = std::as_bytes(std::span(arrays->steps));
    part.arrays["viewCoefficients"] = std::as_bytes(std::span(arrays->coefficients));
  }
  part.owner = arrays;
  return part;
}

std::unique_ptr<const LightField> decode_model(const ModelPart& part, const core::Mesh& mesh) {
  const auto means = mean::decode_model(part, mesh);
  const Options options = options_from(part);
  const std::size_t views = required_size(part.parameters, "views");
  const std::size_t count = required_size(part.parameters, "spaces");
  // No space without a view.
  if (views > kMostViews || count > views || (views > 0 && count == 0)) {
    throw ModelFault("it has no eigenspaces for its views");
  }
  auto model = std::make_unique<MultiEigenspace>(options, mesh.positions.size());
  model->set_means(dynamic_cast<const mean::MeanLightField&>(*means));
  if (views == 0) return model;

  const PictureFrame frame = frame_from(required_records<Frame>(part, "frame", 1).front());
  auto directions = directions_from(required_records<Vector>(part, "directions", views));
  auto owners = required_records<std::uint32_t>(part, "owners", views);
  if (std::ranges::any_of(owners, [&](std::uint32_t owner) { return owner >= count; })) {
    throw ModelFault("a view is in an eigenspace that there is not");
  }
  auto spaces = spaces_from(part, count, options.picture_px);
  auto entries = views_from(part, spaces, owners);
  model->set_spaces(frame, std::move(directions), std::move(owners), std::move(spaces),
                    std::move(entries));
  return model;
}

}  // namespace sheen::fitting::multi_eigenspace
