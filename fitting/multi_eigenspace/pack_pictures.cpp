// SPDX-License-Identifier: MIT
#include "fitting/multi_eigenspace/pack_pictures.h"

#include "fitting/multi_eigenspace/in_steps.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sheen::fitting::multi_eigenspace {
namespace {

constexpr int kValues = 4;
/// Pixels whose products are summed at once.
constexpr Eigen::Index kBlock = 1024;

std::uint8_t grey_level(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

/// An eigenimage times its largest coefficient, in steps of 8 bits.
void store_image(const Eigen::VectorXf& image, const cv::Size& size, Eigenspace& space) {
  constexpr float steps = std::numeric_limits<std::int8_t>::max();
  const float step =
      std::max(image.cwiseAbs().maxCoeff() / steps, std::numeric_limits<float>::min());
  cv::Mat stored(size, CV_8SC4);
  auto* const values = stored.ptr<std::int8_t>();
  for (Eigen::Index i = 0; i < image.size(); ++i) {
    values[i] = static_cast<std::int8_t>(std::lround(image[i] / step));
  }
  space.images.push_back(stored);
  space.steps.push_back(step);
}

}  // namespace

cv::Mat pixel_weights(std::span<const cv::Mat> pictures) {
  const auto count = static_cast<int>(pictures.size());
  cv::Mat sum(pictures.front().size(), CV_32SC1, cv::Scalar(0));
  for (const cv::Mat& picture : pictures) {
    cv::Mat coverage;
    cv::extractChannel(picture, coverage, 3);
    cv::add(sum, coverage, sum, cv::noArray(), CV_32S);
  }
  cv::Mat weights(sum.size(), CV_8UC1);
  std::transform(sum.begin<int>(), sum.end<int>(), weights.begin<std::uint8_t>(), [&](int covered) {
    return static_cast<std::uint8_t>((covered + count - 1) / count);
  });
  return weights;
}

Gram gram_of(std::span<const cv::Mat> pictures, const cv::Mat& weights) {
  const auto count = static_cast<Eigen::Index>(pictures.size());
  const auto pixels = static_cast<Eigen::Index>(weights.total());
  // Whole numbers below 2^53: 255^3 of them fit for each of half a billion values.
  Gram sums = Gram::Zero(count, count);
  for (Eigen::Index first = 0; first < pixels; first += kBlock) {
    const Eigen::Index block = std::min(kBlock, pixels - first);
    Eigen::MatrixXd values(kValues * block, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      values.col(i) =
          Eigen::Map<const Eigen::Matrix<std::uint8_t, Eigen::Dynamic, 1>>(
              pictures[static_cast<std::size_t>(i)].ptr<std::uint8_t>() + kValues * first,
              kValues * block)
              .cast<double>();
    }
    Eigen::MatrixXd weighted = values;
    for (Eigen::Index p = 0; p < block; ++p) {
      weighted.middleRows(kValues * p, kValues) *= weights.ptr<std::uint8_t>()[first + p];
    }
    sums.triangularView<Eigen::Lower>() += values.transpose() * weighted;
  }
  sums.triangularView<Eigen::StrictlyUpper>() = sums.transpose();

  const Eigen::VectorXd with_mean = sums.rowwise().sum() / static_cast<double>(count);
  const double mean_square = sums.sum() / static_cast<double>(count * count);
  const double all = kValues * std::max(cv::sum(weights)[0], 1.0);
  for (Eigen::Index j = 0; j < count; ++j) {
    for (Eigen::Index i = 0; i < count; ++i) {
      const double centred = (sums(i, j) - with_mean[i]) - (with_mean[j] - mean_square);
      sums(i, j) = in_steps(centred / all, kProductBits);
    }
  }
  return sums;
}

PackedSpace pack_pictures(std::span<const cv::Mat> pictures, const cv::Mat& weights,
                          const std::vector<std::uint32_t>& members,
                          const std::vector<std::uint32_t>& guards, std::uint32_t space_idx,
                          const PackRule& rule) {
  // Members first, then guards; inner products among all of them.
  std::vector<std::uint32_t> all = members;
  all.insert(all.end(), guards.begin(), guards.end());
  std::vector<cv::Mat> shown;
  shown.reserve(all.size());
  for (const std::uint32_t view : all) shown.push_back(pictures[view]);
  const Gram gram = gram_of(shown, weights);
  std::vector<std::uint32_t> own(members.size());
  std::iota(own.begin(), own.end(), 0U);
  const ViewGroup group = principal_axes(gram, own, rule.most_eigenimages, rule.allowed);

  Eigen::MatrixXd coefficients(group.dimensions(), static_cast<Eigen::Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) {
    coefficients.col(static_cast<Eigen::Index>(i)) =
        group.coefficients(gram, static_cast<std::uint32_t>(i));
  }

  // Mean and eigenimages of the members, without weights: the same combinations.
  PackedSpace packed;
  const cv::Size size = pictures.front().size();
  const auto values = static_cast<Eigen::Index>(size.area()) * kValues;
  Eigen::VectorXf mean = Eigen::VectorXf::Zero(values);
  Eigen::MatrixXf images = Eigen::MatrixXf::Zero(values, group.dimensions());
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Eigen::VectorXf picture =
        Eigen::Map<const Eigen::Matrix<std::uint8_t, Eigen::Dynamic, 1>>(
            shown[i].ptr<std::uint8_t>(), values)
            .cast<float>();
    mean += picture;
    images += picture * group.combinations.row(static_cast<Eigen::Index>(i)).cast<float>();
  }
  mean /= static_cast<float>(members.size());
  packed.space.mean.create(size, CV_8UC4);
  std::transform(mean.begin(), mean.end(), packed.space.mean.ptr<std::uint8_t>(),
                 [](float value) { return grey_level(static_cast<double>(value)); });
  Eigen::VectorXd largest = coefficients.cwiseAbs().rowwise().maxCoeff();
  for (Eigen::Index k = 0; k < largest.size(); ++k) {
    store_image(images.col(k) * static_cast<float>(largest[k]), size, packed.space);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    ViewInSpace view{all[i], space_idx, {}};
    for (Eigen::Index k = 0; k < largest.size(); ++k) {
      constexpr double whole = std::numeric_limits<std::int16_t>::max();
      const double part = coefficients(k, static_cast<Eigen::Index>(i)) / largest[k];
      view.coefficients.push_back(
          static_cast<std::int16_t>(std::lround(std::clamp(part, -1.0, 1.0) * whole)));
    }
    packed.views.push_back(std::move(view));
  }
  return packed;
}

}  // namespace sheen::fitting::multi_eigenspace
