// SPDX-License-Identifier: MIT
#include "fitting/multi_eigenspace/multi_eigenspace.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace sheen::fitting::multi_eigenspace {
namespace {

/// Adds weight * image; `image` is CV_8UC4 or CV_8SC4.
template <typename Value>
void add_scaled(const cv::Mat& image, float weight, cv::Mat& sum) {
  const int values = sum.cols * sum.channels();
  for (int y = 0; y < sum.rows; ++y) {
    const auto* const from = image.ptr<Value>(y);
    auto* const to = sum.ptr<float>(y);
    for (int i = 0; i < values; ++i) to[i] += weight * static_cast<float>(from[i]);
  }
}

}  // namespace

MultiEigenspace::MultiEigenspace(const Options& options, std::size_t vertex_count)
    : options_(options), means_(vertex_count) {}

std::size_t MultiEigenspace::coefficient_count() const {
  std::size_t count = means_.coefficient_count();
  for (const Eigenspace& space : spaces_) {
    count += (1 + space.images.size()) * space.mean.total() * 4;
  }
  for (const ViewInSpace& view : views_) count += view.coefficients.size();
  return count;
}

void MultiEigenspace::set_spaces(const PictureFrame& frame, std::vector<Eigen::Vector3d> directions,
                                 std::vector<std::uint32_t> owners, std::vector<Eigenspace> spaces,
                                 std::vector<ViewInSpace> views) {
  frame_ = frame;
  sphere_ = core::ViewSphere(directions);
  directions_ = std::move(directions);
  owners_ = std::move(owners);
  spaces_ = std::move(spaces);
  views_ = std::move(views);
  std::ranges::sort(views_, {},
                    [](const ViewInSpace& one) { return std::pair(one.view_idx, one.space_idx); });
  first_of_view_.assign(owners_.size() + 1, 0);
  for (const ViewInSpace& one : views_) ++first_of_view_[one.view_idx + 1];
  for (std::size_t i = 1; i < first_of_view_.size(); ++i)
    first_of_view_[i] += first_of_view_[i - 1];
}

const ViewInSpace* MultiEigenspace::find(std::uint32_t view_idx, std::uint32_t space_idx) const {
  for (std::size_t i = first_of_view_[view_idx]; i < first_of_view_[view_idx + 1]; ++i) {
    if (views_[i].space_idx == space_idx) return &views_[i];
  }
  return nullptr;
}

std::vector<SpaceShare> MultiEigenspace::shares(const Eigen::Vector3d& direction) const {
  if (directions_.empty()) return {};
  const core::SphereBlend corners = sphere_.blend(direction);
  std::vector<SpaceShare> spaces;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::uint32_t view = corners.index[c];
    const float share = corners.weight[c];
    if (!(share > 0)) continue;
    const auto same = std::ranges::find(spaces, owners_[view], &SpaceShare::space_idx);
    if (same != spaces.end()) {
      same->share += share;
    } else {
      spaces.push_back({owners_[view], share, {}});
    }
  }
  if (options_.switching == Switching::hard && spaces.size() > 1) {
    const auto most = std::ranges::max_element(spaces, {}, &SpaceShare::share);
    spaces = {{most->space_idx, 1.0f, {}}};
  }
  // In every space all corners, those that are others' too.
  for (SpaceShare& space : spaces) {
    space.coefficients.assign(spaces_[space.space_idx].images.size(), 0.0f);
    float known = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const float share = corners.weight[c];
      const ViewInSpace* const own = share > 0 ? find(corners.index[c], space.space_idx) : nullptr;
      if (own == nullptr) continue;
      known += share;
      for (std::size_t k = 0; k < space.coefficients.size(); ++k) {
        space.coefficients[k] += share * static_cast<float>(own->coefficients[k]);
      }
    }
    constexpr float largest = std::numeric_limits<std::int16_t>::max();
    for (float& coefficient : space.coefficients) {
      coefficient = known > 0 ? coefficient / (known * largest) : 0.0f;
    }
  }
  return spaces;
}

cv::Mat MultiEigenspace::picture(const Eigen::Vector3d& direction) const {
  cv::Mat sum;
  for (const auto& [space_idx, share, coefficients] : shares(direction)) {
    const Eigenspace& space = spaces_[space_idx];
    if (sum.empty()) sum = cv::Mat(space.mean.size(), CV_32FC4, cv::Scalar::all(0));
    add_scaled<std::uint8_t>(space.mean, share, sum);
    for (std::size_t k = 0; k < space.images.size(); ++k) {
      add_scaled<std::int8_t>(space.images[k], share * coefficients[k] * space.steps[k], sum);
    }
  }
  return sum;
}

}  // namespace sheen::fitting::multi_eigenspace
