// SPDX-License-Identifier: MIT
// The laws of multiple eigenspaces (docs/systems.md).
#include "fitting/multi_eigenspace/multi_eigenspace.h"

#include "fitting/descriptor.h"
#include "fitting/model_file/model_part.h"
#include "fitting/multi_eigenspace/pack_pictures.h"
#include "fitting/multi_eigenspace/partition_views.h"
#include "fitting/multi_eigenspace/rectified_picture.h"
#include "fitting/multi_eigenspace/select_groups.h"
#include "fitting/multi_eigenspace/view_graph.h"
#include "render/multi_eigenspace/eigenspace_renderer.h"
#include "tests/fitting/eigenspace_groups.h"
#include "tests/fitting/photographs_for_tests.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

namespace sheen::fitting::multi_eigenspace {
namespace {

using render::testing::looking_at_origin;
using testing::Photographs;

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::uint32_t kViews = 72;
constexpr double kElevation = 20 * kDegree;

/// Figures of docs/systems.md: `multi_eigenspace_test --gtest_output=json:laws.json` writes them.
void note(const std::string& name, double value) {
  ::testing::Test::RecordProperty(name, std::to_string(value));
}

Eigen::Vector3d heading(double degrees) {
  return {std::cos(kElevation) * std::cos(degrees * kDegree),
          std::cos(kElevation) * std::sin(degrees * kDegree), std::sin(kElevation)};
}

/// Stripes of about eight pixels in three directions, the same from no two sides.
Eigen::Vector3f printed(const Eigen::Vector3f& point, const Eigen::Vector3f& /*towards_viewer*/) {
  const Eigen::Vector3f wave = (100.0f * point + Eigen::Vector3f(0.4f, 1.3f, 2.1f)).array().sin();
  return Eigen::Vector3f(0.5f + 0.25f * wave.x() * wave.y(), 0.5f + 0.25f * wave.y(),
                         0.5f + 0.25f * wave.z() * wave.x());
}

/// An egg that is no body of revolution, printed, on a turntable: 5 degrees a step.
const Photographs& turntable() {
  static const Photographs photographs = [] {
    core::Mesh mesh = render::testing::sphere(0.1f, 24);
    for (Eigen::Vector3f& position : mesh.positions) {
      position.x() *= 1.0f + 0.2f * std::sin(30.0f * position.z() + 1.0f);
      position.y() *= 0.7f + 2.0f * position.x();
    }
    render::testing::compute_normals(mesh);
    std::vector<Eigen::Isometry3d> poses;
    for (std::uint32_t i = 0; i < kViews; ++i) {
      poses.push_back(looking_at_origin(heading(360.0 * i / kViews), 0.36));
    }
    return Photographs(std::move(mesh), poses, printed);
  }();
  return photographs;
}

MultiEigenspace fitted(const Photographs& photographs, OptionValues values = {}) {
  values.try_emplace("picture-size", "64");
  const auto fitter = make_fitter("multi-eigenspace", photographs.mesh(), values);
  std::vector<int> all(photographs.views().size());
  std::iota(all.begin(), all.end(), 0);
  photographs.show(all, *fitter);
  fitter->finish();
  return dynamic_cast<const MultiEigenspace&>(fitter->light_field());
}

const MultiEigenspace& fitted_turntable() {
  static const MultiEigenspace model = fitted(turntable());
  return model;
}

std::size_t spaces_with(const char* option, const char* value) {
  return fitted(turntable(), {{option, value}}).spaces().size();
}

/// Pictures of random numbers.
std::vector<cv::Mat> random_pictures(int count, int side_px) {
  cv::RNG random(7);
  std::vector<cv::Mat> pictures;
  for (int i = 0; i < count; ++i) {
    random.fill(pictures.emplace_back(side_px, side_px, CV_8UC4), cv::RNG::UNIFORM, 0, 256);
  }
  return pictures;
}

cv::Mat everywhere(int side_px) {
  return {side_px, side_px, CV_8UC1, cv::Scalar(255)};
}

/// Mean squared over pixels and channels.
double squared_difference(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat left, right;
  a.convertTo(left, CV_64F);
  b.convertTo(right, CV_64F);
  return cv::norm(left, right, cv::NORM_L2SQR) /
         static_cast<double>(left.total() * static_cast<std::size_t>(left.channels()));
}

// ---- principal axes from inner products ----

// The residual that inner products give is that of the pictures drawn with the stored eigenimages
// but for their 8 bits: of the mean 1/12 grey levels^2, of each of three images up to as much times
// its step^2.
TEST(ViewGroup, ResidualsAreThoseOfThePictures) {
  const auto pictures = random_pictures(8, 12);
  const cv::Mat weights = everywhere(12);
  const Gram gram = gram_of(pictures, weights);
  const std::vector<std::uint32_t> members{0, 1, 2, 3, 4, 5};
  const ViewGroup group = principal_axes(gram, members, 3, 0);
  const auto packed = pack_pictures(pictures, weights, members, {6, 7}, 0, {3, 0});
  double stored = 1.0 / 12;
  for (const float step : packed.space.steps) stored += static_cast<double>(step * step) / 12;
  for (const ViewInSpace& view : packed.views) {
    cv::Mat drawn;
    packed.space.mean.convertTo(drawn, CV_32FC4);
    for (std::size_t k = 0; k < 3; ++k) {
      cv::Mat image;
      packed.space.images[k].convertTo(image, CV_32FC4);
      drawn += image * (packed.space.steps[k] * static_cast<float>(view.coefficients[k]) / 32767);
    }
    const double expected = group.residual(gram, view.view_idx);
    EXPECT_NEAR(squared_difference(drawn, pictures[view.view_idx]), expected,
                0.01 * expected + stored);
  }
}

TEST(ViewGroup, FullRankIsExactForItsMembers) {
  const auto pictures = random_pictures(6, 12);
  const Gram gram = gram_of(pictures, everywhere(12));
  const ViewGroup group = principal_axes(gram, {0, 1, 2, 3, 4, 5}, 16, 0);
  EXPECT_EQ(group.dimensions(), 5);
  EXPECT_LT(group.residuals.maxCoeff(), 1e-3);
}

TEST(ViewGroup, EqualPicturesHaveNoAxis) {
  const std::vector<cv::Mat> pictures(4, random_pictures(1, 12)[0]);
  const Gram gram = gram_of(pictures, everywhere(12));
  const ViewGroup group = principal_axes(gram, {0, 1, 2, 3}, 3, 0);
  EXPECT_EQ(group.dimensions(), 0);
  EXPECT_TRUE(group.residuals.isZero(1e-9));
}

// Against whole numbers of 64 bits: sums in doubles are exact, so nothing is left but the rounding
// to steps of 2^-26.
TEST(Gram, IsExact) {
  const auto pictures = random_pictures(5, 40);
  cv::Mat weights(40, 40, CV_8UC1);
  cv::RNG(3).fill(weights, cv::RNG::UNIFORM, 0, 256);
  const Gram gram = gram_of(pictures, weights);
  Eigen::Matrix<std::int64_t, 5, 5> sums = Eigen::Matrix<std::int64_t, 5, 5>::Zero();
  std::int64_t all = 0;
  for (int p = 0; p < 1600; ++p) {
    const std::int64_t weight = weights.ptr()[p];
    all += 4 * weight;
    for (int c = 0; c < 4; ++c) {
      for (std::size_t i = 0; i < 5; ++i) {
        for (std::size_t j = 0; j < 5; ++j) {
          sums(static_cast<int>(i), static_cast<int>(j)) +=
              weight * pictures[i].ptr()[4 * p + c] * pictures[j].ptr()[4 * p + c];
        }
      }
    }
  }
  // Of the centred pictures: 25 times it is a whole number.
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      const std::int64_t centred =
          25 * sums(i, j) - 5 * sums.row(i).sum() - 5 * sums.row(j).sum() + sums.sum();
      const double expected = static_cast<double>(centred) / 25 / static_cast<double>(all);
      EXPECT_NEAR(gram(i, j), expected, std::ldexp(1.0, -26));
    }
  }
}

// ---- selection ----

double value_of(const Eigen::MatrixXd& gains, unsigned set) {
  Eigen::VectorXd chosen(gains.rows());
  for (Eigen::Index i = 0; i < gains.rows(); ++i) chosen[i] = (set >> i) & 1U;
  return chosen.dot(gains * chosen);
}

// Against all 2^10 sets, with gains as groups have them: what one adds, less what two share.
TEST(SelectGroups, IsNearlyTheBestOfAllSets) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  double lost = 0;
  constexpr int problems = 50;
  for (int problem = 0; problem < problems; ++problem) {
    Eigen::MatrixXd gains(10, 10);
    for (int i = 0; i < 10; ++i) {
      gains(i, i) = 8 * uniform(random) - 1;
      for (int j = 0; j < i; ++j)
        gains(i, j) = gains(j, i) = -2 * uniform(random) * uniform(random);
    }
    double best = 0;
    for (unsigned set = 0; set < 1024; ++set) best = std::max(best, value_of(gains, set));
    unsigned found = 0;
    for (const std::size_t i : maximise_boolean(gains)) found |= 1U << i;
    lost += (best - value_of(gains, found)) / best;
  }
  EXPECT_LT(lost / problems, 0.01);
}

// ---- which views are neighbours ----

// Along a turntable the two next ones, whatever triangles lie over the ring.
TEST(ViewGraph, ATurntableIsARing) {
  for (const double elevation : {20.0, 50.0}) {
    std::vector<Eigen::Vector3d> directions;
    for (std::uint32_t i = 0; i < kViews; ++i) {
      directions.push_back(Eigen::AngleAxisd(elevation * kDegree - kElevation,
                                             Eigen::Vector3d(std::sin(5 * i * kDegree),
                                                             -std::cos(5 * i * kDegree), 0)) *
                           heading(5.0 * i));
    }
    const ViewGraph graph(directions);
    for (std::uint32_t i = 0; i < kViews; ++i) {
      auto next = graph.neighbours(i);
      std::ranges::sort(next);
      auto expected = std::vector{(i + 1) % kViews, (i + kViews - 1) % kViews};
      std::ranges::sort(expected);
      EXPECT_EQ(next, expected) << elevation << " " << i;
    }
  }
}

TEST(ViewGraph, FewAndEqualDirectionsAreJoined) {
  EXPECT_TRUE(ViewGraph(std::vector<Eigen::Vector3d>{{0, 0, 1}}).neighbours(0).empty());
  const std::vector<Eigen::Vector3d> equal(3, {0, 0, 1});
  const ViewGraph graph(equal);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_FALSE(graph.neighbours(i).empty());
}

// ---- pictures ----

// A camera that comes nearer or is rolled sees the same picture but for perspective: in the middle,
// where surfaces are as far as the billboard's plane by a tenth.
TEST(RectifiedPicture, ShowsNeitherDistanceNorRoll) {
  const Eigen::Isometry3d pose = looking_at_origin(heading(30), 0.36);
  const Eigen::Isometry3d rolled =
      Eigen::Isometry3d(Eigen::AngleAxisd(40 * kDegree, Eigen::Vector3d::UnitZ())) * pose;
  const Photographs photographs(turntable().mesh(),
                                {pose, rolled, looking_at_origin(heading(30), 0.42)}, printed);
  const auto picture = [&](int view) {
    // The upright direction is that of the mean of the photographs: given by the first.
    const auto fitter = make_fitter("multi-eigenspace", photographs.mesh(),
                                    {{"picture-size", "64"}, {"view-spacing", "0"}});
    photographs.show({view}, *fitter);
    fitter->finish();
    const auto& model = dynamic_cast<const MultiEigenspace&>(fitter->light_field());
    cv::Mat shown = model.picture(heading(30));
    cv::Mat turned;
    if (view != 1) return shown;
    // One rolled photograph is taken for upright; turn its picture back.
    cv::warpAffine(shown, turned, cv::getRotationMatrix2D({31.5f, 31.5f}, 40, 1), shown.size());
    return turned;
  };
  const cv::Rect middle(16, 16, 32, 32);
  const cv::Mat first = picture(0)(middle);
  EXPECT_LT(std::sqrt(squared_difference(first, picture(1)(middle))), 4.0);
  EXPECT_LT(std::sqrt(squared_difference(first, picture(2)(middle))), 6.0);
}

// ---- the paper's figures ----

// 72 views, 36 groups grown, 4 to 7 spaces of at most three eigenimages (the paper: 35, 5 of 3).
TEST(MultiEigenspace, AFewSpacesHoldATurntable) {
  const MultiEigenspace& model = fitted_turntable();
  note("spaces", static_cast<double>(model.spaces().size()));
  EXPECT_EQ(model.owners().size(), 72u);
  EXPECT_GE(model.spaces().size(), 4u);
  EXPECT_LE(model.spaces().size(), 7u);
  for (const Eigenspace& space : model.spaces()) EXPECT_LE(space.images.size(), 3u);
}

TEST(MultiEigenspace, FewerSpacesWithMoreToleranceAndMoreEigenimages) {
  const std::size_t strict = spaces_with("space-tolerance", "6");
  const std::size_t usual = fitted_turntable().spaces().size();
  const std::size_t lax = spaces_with("space-tolerance", "16");
  const std::size_t one_image = spaces_with("eigenimages", "1");
  const std::size_t seven_images = spaces_with("eigenimages", "7");
  note("spaces_at_tolerance_6", static_cast<double>(strict));
  note("spaces_at_tolerance_16", static_cast<double>(lax));
  note("spaces_of_1_eigenimage", static_cast<double>(one_image));
  note("spaces_of_7_eigenimages", static_cast<double>(seven_images));
  EXPECT_GT(strict, usual);
  EXPECT_LT(lax, usual);
  EXPECT_GT(one_image, usual);
  EXPECT_LT(seven_images, usual);
  EXPECT_EQ(spaces_with("space-tolerance", "255"), 1u);
}

// No space owns views from two sides: its views are neighbours along the ring, past 360 degrees
// too.
TEST(MultiEigenspace, SpacesAreArcs) {
  const auto& owners = fitted_turntable().owners();
  std::size_t borders = 0;
  for (std::size_t i = 0; i < owners.size(); ++i) {
    if (owners[i] != owners[(i + 1) % owners.size()]) ++borders;
  }
  EXPECT_EQ(borders, fitted_turntable().spaces().size());
}

/// Largest change over the median one between pictures a quarter of a degree apart.
double pop_ratio(const char* switching) {
  const auto model = fitted(turntable(), {{"switching", switching}});
  std::vector<double> changes;
  cv::Mat previous = model.picture(heading(0));
  constexpr int steps = 1440;
  for (int i = 1; i <= steps; ++i) {
    cv::Mat next = model.picture(heading(360.0 * i / steps));
    changes.push_back(std::sqrt(squared_difference(previous, next)));
    previous = next;
  }
  std::ranges::sort(changes);
  return changes.back() / changes[changes.size() / 2];
}

TEST(MultiEigenspace, CrossFadeTakesThePopsAway) {
  const double hard = pop_ratio("hard");
  const double faded = pop_ratio("cross-fade");
  note("pop_ratio_hard", hard);
  note("pop_ratio_cross_fade", faded);
  EXPECT_GT(hard, 10);
  EXPECT_LT(faded, 5);
}

/// The photographs as the fit rectifies them.
const std::vector<cv::Mat>& turntable_pictures() {
  static const std::vector<cv::Mat> pictures = [] {
    const Photographs& photographs = turntable();
    Rectifier rectifier(photographs.mesh(), 1);
    core::DepthImage depth(photographs.mesh(), 1);
    std::vector<int> all(photographs.views().size());
    std::iota(all.begin(), all.end(), 0);
    std::vector<cv::Mat> made;
    photographs.observe(all, [&](const core::Observation& observation) {
      depth.draw(observation.view, observation.image.size(), observation.camera_from_object);
      made.push_back(
          rectifier.picture(keep_view(observation, depth, 97, Surroundings::photographed),
                            fitted_turntable().frame(), 64));
    });
    return made;
  }();
  return pictures;
}

// Against the same spaces in floating point: one step of the mean and of every eigenimage, rounded,
// is less than a grey level RMS.
TEST(MultiEigenspace, EightBitsCostLessThanAGreyLevel) {
  const MultiEigenspace& model = fitted_turntable();
  const std::vector<cv::Mat>& pictures = turntable_pictures();
  const Gram gram = gram_of(pictures, pixel_weights(pictures));
  double largest = 0;
  for (std::uint32_t space = 0; space < model.spaces().size(); ++space) {
    std::vector<std::uint32_t> members;
    for (std::uint32_t view = 0; view < model.owners().size(); ++view) {
      if (model.owners()[view] == space) members.push_back(view);
    }
    const ViewGroup group = principal_axes(gram, members, 3, 100);
    for (const std::uint32_t view : members) {
      // mean + E E^T (x - mean), as one combination of the members' pictures.
      const auto count = static_cast<double>(members.size());
      const Eigen::VectorXd parts =
          (group.combinations * group.coefficients(gram, view)).array() + 1 / count;
      cv::Mat exact(64, 64, CV_64FC4, cv::Scalar::all(0));
      for (std::size_t i = 0; i < members.size(); ++i) {
        cv::Mat picture;
        pictures[members[i]].convertTo(picture, CV_64FC4);
        exact += picture * parts[static_cast<Eigen::Index>(i)];
      }
      const cv::Mat stored = model.picture(model.directions()[view]);
      largest = std::max(largest, std::sqrt(squared_difference(stored, exact)));
    }
  }
  note("rms_of_8_bits", largest);
  EXPECT_LT(largest, 1.0);
}

// At equal work for a pixel (a mean and three images) one eigenspace of all views is far behind; at
// equal storage it is not (docs/systems.md).
TEST(MultiEigenspace, BeatsOneEigenspaceAtEqualWork) {
  const std::vector<cv::Mat>& pictures = turntable_pictures();
  const Gram gram = gram_of(pictures, pixel_weights(pictures));
  std::vector<std::uint32_t> all(pictures.size());
  std::iota(all.begin(), all.end(), 0U);
  int images = 0;
  double squares = 0;
  for (std::uint32_t space = 0; space < fitted_turntable().spaces().size(); ++space) {
    std::vector<std::uint32_t> members;
    std::ranges::copy_if(all, std::back_inserter(members), [&](std::uint32_t view) {
      return fitted_turntable().owners()[view] == space;
    });
    const ViewGroup group = principal_axes(gram, members, 3, 100);
    squares += group.residuals.sum();
    images += 1 + group.dimensions();
  }
  const double several = std::sqrt(squares / static_cast<double>(pictures.size()));
  const double one = std::sqrt(principal_axes(gram, all, 3, 0).residuals.mean());
  const double as_large = std::sqrt(principal_axes(gram, all, images - 1, 0).residuals.mean());
  note("stored_images", images);
  note("rms_of_several", several);
  note("rms_of_one_at_equal_work", one);
  note("rms_of_one_at_equal_storage", as_large);
  EXPECT_LT(several, 0.6 * one);
}

// ---- last digits ----

// Other instructions, other last digits: the same groups to the last byte.
TEST(MultiEigenspace, GroupsDoNotHangOnTheProcessor) {
  const auto bytes = testing::packed_bytes();
  const auto otherwise = testing::packed_bytes_otherwise();
  EXPECT_GT(bytes.size(), 48u * 4 + 3 * 6400);  // several spaces
  EXPECT_EQ(bytes, otherwise);
}

// Inner products altered by a millionth of a millionth.
TEST(MultiEigenspace, GroupsDoNotHangOnLastDigits) {
  const std::vector<cv::Mat>& pictures = turntable_pictures();
  const Gram gram = gram_of(pictures, pixel_weights(pictures));
  const ViewGraph graph(fitted_turntable().directions());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1e-12, 1e-12);
  for (const double tolerance : {6.0, 10.0, 16.0}) {
    const Partition expected = partition_views(gram, graph, {3, tolerance}, 1);
    Gram altered = gram;
    for (Eigen::Index i = 0; i < gram.rows(); ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) {
        altered(i, j) = altered(j, i) = gram(i, j) * (1 + uniform(random));
      }
    }
    const Partition found = partition_views(altered, graph, {3, tolerance}, 1);
    EXPECT_EQ(found.owners, expected.owners) << tolerance;
    EXPECT_EQ(found.grown, expected.grown);
  }
}

// ---- input at the edges ----

// Enough eigenimages and no tolerance: every view is drawn as it was photographed, but for the
// resampling of pictures about as fine as the photographs.
TEST(MultiEigenspace, WithoutToleranceViewsAreTheirOwn) {
  const Photographs& photographs = turntable();
  const auto model = fitted(photographs, {{"space-tolerance", "0"}, {"picture-size", "256"}});
  const auto renderer = render::make_eigenspace_renderer(model, 1);
  const auto& [image, pose] = photographs.views()[9];
  const auto view = renderer->render(photographs.camera(), pose);
  cv::Mat inside;
  cv::erode(view.mask, inside, {}, {-1, -1}, 2);
  EXPECT_LT(render::testing::difference(view.image, image, inside).mean, 2.5);
}

// Arrays of nothing but ones: indices beyond everything and NaN are refused; in pictures and
// coefficients every byte is a number.
TEST(MultiEigenspace, AlteredArraysAreRefused) {
  const Photographs& photographs = turntable();
  const Descriptor& descriptor = representation_named("multi-eigenspace");
  const ModelPart good = descriptor.encode(fitted_turntable());
  const auto is_free = [](const std::string& name) {
    return name == "means" || name == "images" || name == "viewCoefficients";
  };
  for (const auto& [name, array] : good.arrays) {
    const std::vector<std::byte> ones(array.size(), std::byte{0xff});
    ModelPart part = good;
    part.arrays[name] = ones;
    if (!is_free(name)) {
      EXPECT_THROW(descriptor.decode(part, photographs.mesh()), ModelFault) << name;
      continue;
    }
    const auto model = descriptor.decode(part, photographs.mesh());
    const cv::Mat picture = dynamic_cast<const MultiEigenspace&>(*model).picture(heading(7));
    EXPECT_TRUE(cv::checkRange(picture)) << name;
  }
}

TEST(MultiEigenspace, EqualViewsAreOneSpace) {
  const Eigen::Isometry3d pose = looking_at_origin(heading(30), 0.36);
  const Photographs photographs(turntable().mesh(), std::vector<Eigen::Isometry3d>(7, pose),
                                printed);
  const auto model = fitted(photographs, {{"view-spacing", "0"}});
  EXPECT_EQ(model.owners().size(), 7u);
  ASSERT_EQ(model.spaces().size(), 1u);
  EXPECT_TRUE(model.spaces()[0].images.empty());
  EXPECT_EQ(fitted(photographs).owners().size(), 1u);
}

}  // namespace
}  // namespace sheen::fitting::multi_eigenspace
