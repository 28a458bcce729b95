// SPDX-License-Identifier: MIT
#include "evaluation/views/view_evaluation.h"

#include "evaluation/comparison/outline_error.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <cmath>

namespace sheen::evaluation {
namespace {

const cv::Size kSize(160, 120);
const cv::Rect kObject(40, 30, 80, 60);  // eroded by two: 76 x 56 pixels, 42 to 117 across

cv::Mat filled(const cv::Rect& part, int type, const cv::Scalar& value) {
  cv::Mat image(kSize, type, cv::Scalar::all(0));
  image(part).setTo(value);
  return image;
}

/// What a model draws that shows the truth in `part` and nothing elsewhere.
render::RenderedView true_in(const cv::Rect& part, const cv::Scalar& truth) {
  return {filled(part, CV_8UC3, truth), filled(part, CV_8UC1, 255), filled(part, CV_8UC1, 255)};
}

// Half of the object is drawn as it is, half is left out and black: with the truth 128 the mean
// squared error is (128 / 255)^2 / 2. Counted over what is drawn alone it would be 0.
TEST(CompareView, PixelsThatAModelLeavesUncoveredCountAsBlack) {
  const cv::Scalar truth = cv::Scalar::all(128);
  const cv::Mat photograph(kSize, CV_8UC3, truth);
  const cv::Mat mask = filled(kObject, CV_8UC1, 255);
  const cv::Rect left_half(0, 0, 80, 120);
  const auto error = compare_view(7, true_in(left_half & kObject, truth), photograph, mask);
  ASSERT_TRUE(error);
  const double squared = std::pow(128.0 / 255.0, 2) / 2;
  EXPECT_EQ(error->index, 7);
  EXPECT_EQ(error->error.pixels, 76u * 56u);
  EXPECT_EQ(error->covered_pixels, 38u * 56u);
  EXPECT_NEAR(error->error.psnr_db, -10 * std::log10(squared), 1e-9);
  EXPECT_NEAR(error->error.rmse, std::sqrt(squared), 1e-9);
}

// What is drawn beside the object neither helps nor harms.
TEST(CompareView, OnlyTheObjectCounts) {
  const cv::Scalar truth(10, 200, 90);
  const cv::Mat photograph(kSize, CV_8UC3, truth);
  const cv::Mat mask = filled(kObject, CV_8UC1, 255);
  const auto whole = compare_view(0, true_in({{0, 0}, kSize}, truth), photograph, mask);
  const auto object = compare_view(0, true_in(kObject, truth), photograph, mask);
  ASSERT_TRUE(whole && object);
  EXPECT_EQ(whole->error.psnr_db, 99);  // equal images
  EXPECT_EQ(object->error.psnr_db, 99);
  EXPECT_EQ(whole->covered_pixels, 76u * 56u);
  EXPECT_FALSE(compare_view(0, true_in(kObject, truth), photograph, mask & 0));
  // Of four pixels' width nothing is left after two are taken from either side.
  EXPECT_FALSE(
      compare_view(0, true_in(kObject, truth), photograph, filled({10, 10, 4, 4}, CV_8UC1, 255)));
}

// The left half of the object is drawn, the rest is a hole; the band is the object's left column.
TEST(OutlineError, CountsHolesEdgesAndWhatIsDrawnBesideTheObject) {
  const cv::Scalar truth = cv::Scalar::all(128);
  const cv::Mat photograph(kSize, CV_8UC3, truth);
  const cv::Mat mask = filled(kObject, CV_8UC1, 255);
  const cv::Mat band = filled({40, 30, 1, 60}, CV_8UC1, 255);
  const auto exact = outline_error(true_in(kObject, truth), photograph, mask, band);
  EXPECT_EQ(exact.box_psnr_db, 99);
  EXPECT_EQ(exact.edge_difference, 0);
  EXPECT_EQ(exact.hole_fraction, 0);
  const auto half = outline_error(true_in({40, 30, 40, 60}, truth), photograph, mask, band);
  EXPECT_DOUBLE_EQ(half.hole_fraction, 0.5);
  EXPECT_EQ(half.edge_difference, 0);
  // A column too many at the left, in a box of 86 x 66 pixels.
  const auto wide = outline_error(true_in({39, 30, 81, 60}, truth), photograph, mask, band);
  EXPECT_NEAR(wide.box_psnr_db, -10 * std::log10(std::pow(128 / 255.0, 2) * 60 / (86 * 66)), 1e-9);
  const auto none = outline_error(true_in({0, 0, 10, 10}, truth), photograph, mask, band);
  EXPECT_EQ(none.edge_difference, 128);
}

}  // namespace
}  // namespace sheen::evaluation
