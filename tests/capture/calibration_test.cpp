// SPDX-License-Identifier: MIT
// Calibration: known lenses found again, and views refused that cannot tell.
#include "capture/calibration/calibrate_camera.h"
#include "capture/calibration/calibration_images.h"
#include "capture/calibration/camera_images.h"
#include "capture/calibration/coverage_image.h"
#include "tests/capture/expect_bad_input.h"
#include "tests/capture/rendered_board.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <numbers>
#include <random>
#include <set>

namespace sheen::capture::test {
namespace {

using tests::TemporaryFolder;

constexpr double kDegree = std::numbers::pi / 180;
constexpr ImageSize kSize{1280, 720};

/// The corners of a grid of tags as a camera sees them, those outside the image left out.
TargetView view_of(const Board& board, const core::CameraModel& camera,
                   const Eigen::Isometry3d& camera_from_board, int index) {
  TargetView view;
  view.frame_index = index;
  for (const auto& [id, corners] : true_corners(board, camera, camera_from_board)) {
    const auto on_board = board.tags.at(id).corners_in_board();
    for (std::size_t c = 0; c < 4; ++c) {
      const Eigen::Vector2d& p = corners[c];
      if (p.x() < 0 || p.y() < 0 || p.x() > kSize.width_px - 1 || p.y() > kSize.height_px - 1) {
        continue;
      }
      view.on_target.push_back(on_board[c]);
      view.in_image.push_back(p);
    }
  }
  return view;
}

/// Views from all sides, near enough to fill the image.
std::vector<TargetView> good_views(const core::CameraModel& camera, int count, double noise_px,
                                   unsigned seed) {
  const Board board = make_grid_board("tag36h11", 8, 6, 0.03, 0.0375);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, noise_px);
  std::vector<TargetView> views;
  for (int i = 0; i < count; ++i) {
    const auto pose = look_at_board(0.22 + 0.04 * (i % 4), (50 + 13 * (i % 3)) * kDegree,
                                    2 * std::numbers::pi * i * 0.381966);
    views.push_back(view_of(board, camera, pose, i));
    for (Eigen::Vector2d& p : views.back().in_image) {
      p += Eigen::Vector2d(noise(random), noise(random));
    }
  }
  return views;
}

TEST(Calibration, FindsTheLensOfExactPoints) {
  // OpenCV takes points as floats: 720 px carry an error of 3e-5 px.
  const auto truth = make_camera(kSize.width_px, kSize.height_px, true);
  const auto found = calibrate_camera(good_views(truth, 14, 0, 1), kSize);
  ASSERT_TRUE(found);
  EXPECT_LT(found->rms_px, 1e-3);
  const auto& a = found->camera.intrinsics();
  const auto& b = truth.intrinsics();
  EXPECT_LT((a.focal_px - b.focal_px).norm(), 0.02);
  EXPECT_LT((a.principal_px - b.principal_px).norm(), 0.02);
  EXPECT_NEAR(a.distortion[0], b.distortion[0], 1e-4);
  EXPECT_TRUE(find_faults(*found, {}).empty());
}

/// Of views with Gaussian noise of 0.2 px: every parameter within four standard deviations of the
/// truth, and the residual that noise leaves: 0.2 px per coordinate, sqrt(2) times that per point.
void expect_within_its_errors(const Calibration& found, const core::CameraModel& truth) {
  EXPECT_NEAR(found.rms_px, 0.2 * std::numbers::sqrt2, 0.02);
  const auto& a = found.camera.intrinsics();
  const auto& b = truth.intrinsics();
  for (int i = 0; i < 2; ++i) {
    EXPECT_LT(std::abs(a.focal_px[i] - b.focal_px[i]), 4 * found.focal_sigma_px[i]);
    EXPECT_LT(std::abs(a.principal_px[i] - b.principal_px[i]), 4 * found.principal_sigma_px[i]);
  }
  EXPECT_LT(found.focal_sigma_px.maxCoeff(), 2);
}

TEST(Calibration, StaysWithinWhatItSaysOfItsErrors) {
  const auto truth = make_camera(kSize.width_px, kSize.height_px, true);
  for (const unsigned seed : {2U, 3U, 4U}) {
    SCOPED_TRACE(seed);
    const auto found = calibrate_camera(good_views(truth, 14, 0.2, seed), kSize);
    ASSERT_TRUE(found);
    expect_within_its_errors(*found, truth);
    EXPECT_TRUE(find_faults(*found, {}).empty());
  }
}

TEST(Calibration, LeavesOutTheThirdRadialTermWhereThereIsNone) {
  core::CameraModel::Intrinsics intrinsics = make_camera(1280, 720, false).intrinsics();
  intrinsics.distortion = {-0.1, 0.03, 0, 0, 0, 0, 0, 0};
  const auto found = calibrate_camera(good_views(core::CameraModel(intrinsics), 14, 0.2, 5), kSize);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->camera.intrinsics().distortion[4], 0);
}

TEST(Calibration, LeavesOutAViewThatIsFarWorse) {
  const auto truth = make_camera(kSize.width_px, kSize.height_px, true);
  auto views = good_views(truth, 14, 0.1, 6);
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 5);
  for (Eigen::Vector2d& p : views[4].in_image) p += Eigen::Vector2d(noise(random), noise(random));
  const auto found = calibrate_camera(views, kSize);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->dropped, std::vector<int>{4});
  EXPECT_LT((found->camera.intrinsics().focal_px - truth.intrinsics().focal_px).norm(), 2);
}

/// A fisheye of 160 degrees along the longer side.
core::CameraModel fisheye_camera() {
  core::CameraModel::Intrinsics intrinsics;
  intrinsics.width_px = kSize.width_px;
  intrinsics.height_px = kSize.height_px;
  intrinsics.focal_px = {455, 456};
  intrinsics.principal_px = {644, 355};
  intrinsics.distortion = {0.03, -0.012, 0.004, 0, 0, 0, 0, 0};
  intrinsics.lens = core::LensKind::fisheye;
  return core::CameraModel(intrinsics);
}

std::vector<TargetView> fisheye_views(const core::CameraModel& camera, double noise_px,
                                      unsigned seed) {
  const Board board = make_grid_board("tag36h11", 8, 6, 0.03, 0.0375);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, noise_px);
  std::vector<TargetView> views;
  for (int i = 0; i < 14; ++i) {
    const auto pose = look_at_board(0.09 + 0.02 * (i % 4), (50 + 13 * (i % 3)) * kDegree,
                                    2 * std::numbers::pi * i * 0.381966);
    TargetView& view = views.emplace_back();
    view.frame_index = i;
    for (const auto& [id, tag] : board.tags) {
      for (const Eigen::Vector3d& corner : tag.corners_in_board()) {
        const auto pixel = camera.project(pose * corner);
        if (!pixel || (pixel->array() < 0).any() || pixel->x() > kSize.width_px - 1 ||
            pixel->y() > kSize.height_px - 1) {
          continue;
        }
        view.on_target.push_back(corner);
        view.in_image.emplace_back(*pixel + Eigen::Vector2d(noise(random), noise(random)));
      }
    }
  }
  return views;
}

TEST(FisheyeCalibration, FindsTheLensOfExactPoints) {
  const auto truth = fisheye_camera();
  const auto found = calibrate_camera(fisheye_views(truth, 0, 1), kSize, core::LensKind::fisheye);
  ASSERT_TRUE(found);
  EXPECT_LT(found->rms_px, 1e-3);
  const auto& a = found->camera.intrinsics();
  const auto& b = truth.intrinsics();
  EXPECT_EQ(a.lens, core::LensKind::fisheye);
  EXPECT_LT((a.focal_px - b.focal_px).norm(), 0.01);
  EXPECT_LT((a.principal_px - b.principal_px).norm(), 0.01);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a.distortion[i], b.distortion[i], 1e-4);
  EXPECT_TRUE(find_faults(*found, {}).empty());
}

TEST(FisheyeCalibration, StaysWithinWhatItSaysOfItsErrors) {
  const auto truth = fisheye_camera();
  const auto found = calibrate_camera(fisheye_views(truth, 0.2, 2), kSize, core::LensKind::fisheye);
  ASSERT_TRUE(found);
  expect_within_its_errors(*found, truth);
}

TEST(FisheyeCalibration, NoOtherLensFits) {
  const auto found = calibrate_camera(fisheye_views(fisheye_camera(), 0.2, 2), kSize);
  EXPECT_TRUE(!found || found->rms_px > 2 * 0.2 * std::numbers::sqrt2);
}

/// The same lens in images of half the size, as photographs of a board of 48 tags show it.
class FisheyePictures : public testing::Test {
 protected:
  static constexpr ImageSize kPicture{640, 360};

  static core::CameraModel lens() {
    core::CameraModel::Intrinsics intrinsics = fisheye_camera().intrinsics();
    intrinsics.width_px = kPicture.width_px;
    intrinsics.height_px = kPicture.height_px;
    intrinsics.focal_px = {260, 260.5};  // 141 degrees along the longer side
    intrinsics.principal_px = {322, 177.5};
    return core::CameraModel(intrinsics);
  }

  static void SetUpTestSuite() {
    for (int i = 0; i < 12; ++i) {
      const auto pose = look_at_board(0.1 + 0.02 * (i % 4), (50 + 13 * (i % 3)) * kDegree,
                                      2 * std::numbers::pi * i * 0.381966);
      cv::Mat grey;
      cv::cvtColor(render_board(board_, lens(), pose, {.supersampling = 3}), grey,
                   cv::COLOR_BGR2GRAY);
      pictures_.push_back(grey);
    }
  }
  static void TearDownTestSuite() { pictures_.clear(); }

  /// As `sheen calibrate` does: corners by a plain camera, again through the lens that was found.
  static std::optional<Calibration> calibrate(core::LensKind kind) {
    const auto finder = make_target_finder(board_);
    std::vector<TargetView> views;
    for (const cv::Mat& picture : pictures_) {
      auto view = finder->find(picture);
      if (!view) continue;
      view->frame_index = static_cast<int>(views.size());
      views.push_back(std::move(*view));
    }
    EXPECT_EQ(views.size(), pictures_.size());
    const auto first = calibrate_camera(views, kPicture, kind);
    if (!first) return std::nullopt;
    for (std::size_t i = 0; i < views.size(); ++i) {
      finder->refine(pictures_[i], first->camera, views[i]);
    }
    return calibrate_camera(views, kPicture, kind);
  }

  inline static const Board board_ = make_grid_board("tag36h11", 8, 6, 0.03, 0.0375);
  inline static std::vector<cv::Mat> pictures_;
};

TEST_F(FisheyePictures, TellTheProjectionAllOverTheImage) {
  const auto found = calibrate(core::LensKind::fisheye);
  ASSERT_TRUE(found);
  EXPECT_TRUE(find_faults(*found, {}).empty());
  double squares = 0, worst = 0;
  int places = 0;
  for (int y = 0; y < kPicture.height_px; y += 15) {
    for (int x = 0; x < kPicture.width_px; x += 15) {
      const auto pixel = found->camera.project(*lens().unproject({x, y}));
      ASSERT_TRUE(pixel);
      const double error = (*pixel - Eigen::Vector2d(x, y)).norm();
      squares += error * error;
      worst = std::max(worst, error);
      ++places;
    }
  }
  std::printf("projection against the truth at %d places: %.3f px RMS, %.3f px at most\n", places,
              std::sqrt(squares / places), worst);
  EXPECT_LT(std::sqrt(squares / places), 0.16);
  EXPECT_LT(worst, 0.3);
}

TEST_F(FisheyePictures, AreNotThoseOfAPlainLensAndItIsSaid) {
  const auto fisheye = calibrate(core::LensKind::fisheye);
  const auto plain = calibrate(core::LensKind::rational);
  const auto doubt = doubt_lens(core::LensKind::rational, plain, fisheye, {});
  ASSERT_TRUE(doubt);
  EXPECT_TRUE(doubt->is_sure);
  EXPECT_EQ(doubt->remedy, "add --fisheye");
  EXPECT_FALSE(doubt_lens(core::LensKind::fisheye, fisheye, plain, {}));
}

TEST(Calibration, APlainLensNeedsNoFisheye) {
  const auto views = good_views(make_camera(kSize.width_px, kSize.height_px, true), 14, 0.2, 2);
  const auto plain = calibrate_camera(views, kSize);
  const auto fisheye = calibrate_camera(views, kSize, core::LensKind::fisheye);
  EXPECT_FALSE(doubt_lens(core::LensKind::rational, plain, fisheye, {}));
  const auto doubt = doubt_lens(core::LensKind::fisheye, fisheye, plain, {});
  ASSERT_TRUE(doubt);
  EXPECT_FALSE(doubt->is_sure);
  EXPECT_EQ(doubt->remedy, "leave --fisheye out");
}

/// Whether one of the faults contains a word.
bool has_fault(const std::vector<std::string>& faults, const std::string& word) {
  return std::any_of(faults.begin(), faults.end(), [&](const std::string& fault) {
    return fault.find(word) != std::string::npos;
  });
}

TEST(Calibration, RefusesTooFewViews) {
  const auto truth = make_camera(kSize.width_px, kSize.height_px, true);
  EXPECT_FALSE(calibrate_camera({}, kSize));
  EXPECT_FALSE(calibrate_camera(good_views(truth, 2, 0.1, 8), kSize));
  const auto found = calibrate_camera(good_views(truth, 5, 0.1, 8), kSize);
  ASSERT_TRUE(found);
  EXPECT_TRUE(has_fault(find_faults(*found, {}), "only 5 images"));
}

TEST(Calibration, RefusesViewsThatAreAllAlike) {
  // Straight from above at one height: focal length and distance cannot be told apart.
  const auto truth = make_camera(kSize.width_px, kSize.height_px, true);
  const Board board = make_grid_board("tag36h11", 8, 6, 0.03, 0.0375);
  std::mt19937 random(9);
  std::normal_distribution<double> noise(0, 0.2);
  std::vector<TargetView> views;
  for (int i = 0; i < 12; ++i) {
    views.push_back(view_of(board, truth, look_at_board(0.3, 88 * kDegree, 0.02 * i), i));
    for (Eigen::Vector2d& p : views.back().in_image) {
      p += Eigen::Vector2d(noise(random), noise(random));
    }
  }
  const auto found = calibrate_camera(views, kSize);
  EXPECT_TRUE(!found || has_fault(find_faults(*found, {}), "too alike"));
}

TEST(Calibration, RefusesViewsThatLeaveTheImageEmpty) {
  const auto truth = make_camera(kSize.width_px, kSize.height_px, true);
  const Board board = make_grid_board("tag36h11", 3, 3, 0.02, 0.025);
  std::vector<TargetView> views;
  for (int i = 0; i < 12; ++i) {
    views.push_back(
        view_of(board, truth, look_at_board(0.6, (45 + 10 * (i % 4)) * kDegree, 0.6 * i), i));
  }
  const auto found = calibrate_camera(views, kSize);
  ASSERT_TRUE(found);
  EXPECT_TRUE(has_fault(find_faults(*found, {}), "of the image"));
}

TEST(Calibration, RefusesAnotherTargetThanTheOneGiven) {
  // The rows of the print are shifted against each other by up to 4 mm.
  const auto truth = make_camera(kSize.width_px, kSize.height_px, true);
  auto views = good_views(truth, 14, 0.1, 10);
  for (TargetView& view : views) {
    for (Eigen::Vector3d& p : view.on_target) p.x() += 0.004 * std::sin(170 * p.y());
  }
  const auto found = calibrate_camera(views, kSize);
  ASSERT_TRUE(found);
  EXPECT_TRUE(has_fault(find_faults(*found, {}), "not flat or not the one"));
}

TEST(SpreadViews, KeepsTheFewThatDiffer) {
  // A camera that stood still for 60 frames and moved in 6: all 6 must be among 12.
  const auto camera = make_camera(kSize.width_px, kSize.height_px, true);
  const Board board = make_grid_board("tag36h11", 6, 5, 0.03, 0.0375);
  std::vector<TargetView> views;
  for (int i = 0; i < 60; ++i) {
    views.push_back(
        view_of(board, camera, look_at_board(0.4 + 1e-4 * i, 70 * kDegree, 1e-3 * i), i));
  }
  for (int i = 60; i < 66; ++i) {
    views.push_back(view_of(board, camera, look_at_board(0.4, 45 * kDegree, i), i));
  }
  std::set<int> chosen;
  for (const TargetView& view : choose_spread_views(views, kSize, 12)) {
    chosen.insert(view.frame_index);
  }
  EXPECT_EQ(chosen.size(), 12U);
  for (int i = 60; i < 66; ++i) EXPECT_TRUE(chosen.contains(i)) << i;
}

TEST(TargetFinder, MeasuresAChessboardAndABoardAlike) {
  // A chessboard drawn by warping a large one: its corners are known through the homography.
  constexpr int square_px = 60;
  cv::Mat print(7 * square_px + 120, 10 * square_px + 120, CV_8UC1, cv::Scalar(230));
  for (int row = 0; row < 7; ++row) {
    for (int column = 0; column < 10; ++column) {
      if ((row + column) % 2 == 0) continue;
      print(cv::Rect(60 + column * square_px, 60 + row * square_px, square_px, square_px)) = 30;
    }
  }
  const cv::Matx33d H(0.62, 0.11, 60, -0.08, 0.66, 90, 1e-4, 6e-5, 1);
  cv::Mat image;
  cv::GaussianBlur(print, print, {}, 1.2);  // no aliasing after the shrinking
  cv::warpPerspective(print, image, H, {640, 480}, cv::INTER_LINEAR, cv::BORDER_CONSTANT, 230);
  const auto finder = make_target_finder(Chessboard{9, 6, 0.025});
  const auto view = finder->find(image);
  ASSERT_TRUE(view);
  ASSERT_EQ(view->in_image.size(), 54U);
  // The order may begin at either end of the board; every corner is near its own place.
  for (const Eigen::Vector2d& seen : view->in_image) {
    double nearest = 1e9;
    for (int row = 1; row <= 6; ++row) {
      for (int column = 1; column <= 9; ++column) {
        // A corner lies between two pixels of the print.
        const cv::Vec3d p =
            H * cv::Vec3d(60 + column * square_px - 0.5, 60 + row * square_px - 0.5, 1);
        nearest = std::min(nearest, (seen - Eigen::Vector2d(p[0] / p[2], p[1] / p[2])).norm());
      }
    }
    EXPECT_LT(nearest, 0.15);
  }
  EXPECT_FALSE(make_target_finder(Chessboard{8, 5, 0.025})
                   ->find(cv::Mat(480, 640, CV_8UC1, cv::Scalar(128))));
  EXPECT_THROW(make_target_finder(Chessboard{2, 6, 0.025}), std::invalid_argument);
}

TEST(CalibrationImages, TakesAFolderByNameAndRefusesMixedSizes) {
  const TemporaryFolder folder;
  const auto write = [&](const char* name, int width) {
    cv::imwrite((folder.path() / name).string(), cv::Mat(120, width, CV_8UC3, cv::Scalar(9, 9, 9)));
  };
  expect_bad_input([&] { open_calibration_images(folder.path()); }, "holds no images");
  expect_bad_input([&] { open_calibration_images(folder.path() / "none"); }, "no such video");
  write("b.png", 160);
  write("a.JPG", 160);
  folder.write("notes.txt", "not an image");
  const auto two = open_calibration_images(folder.path());
  EXPECT_EQ(two->frame_count(), 2);
  EXPECT_EQ(two->next()->index, 0);
  EXPECT_EQ(two->next()->index, 1);
  EXPECT_FALSE(two->next());
  write("c.png", 170);
  const auto mixed = open_calibration_images(folder.path());
  mixed->next();
  mixed->next();
  expect_bad_input([&] { mixed->next(); }, "c.png", "is 170x120, the images before it are 160x120");
  const auto broken = folder.write("0.png", "no image at all");
  expect_bad_input([&] { open_calibration_images(folder.path())->next(); }, "0.png");
  const auto video = folder.write("walk.mp4", "no video");
  expect_bad_input([&] { open_calibration_images(video); }, "walk.mp4");
}

/// A camera that delivers one grey image 30 times a second, for ever or up to a number.
class SteadyCamera : public Camera {
 public:
  SteadyCamera(PixelFormat format, int images) : format_(format), left_(images) {
    const std::size_t size = format == PixelFormat::nv12 ? 64 * 48 * 3 / 2 : 64 * 48 * 2;
    bytes_.assign(size, 128);
  }

  std::optional<CameraBuffer> next(std::chrono::milliseconds) override {
    if (left_-- <= 0) return std::nullopt;
    CameraBuffer buffer;
    buffer.format = format_;
    buffer.bytes = bytes_;
    buffer.width_px = 64;
    buffer.height_px = 48;
    buffer.time_s = 100 + sequence_ / 30.0;
    buffer.sequence = sequence_++;
    return buffer;
  }
  [[nodiscard]] CameraDescription description() const override {
    return {"steady", "/dev/steady", format_, 64, 48, 30};
  }
  [[nodiscard]] CameraCounts counts() const override { return {}; }

 private:
  PixelFormat format_;
  int left_;
  std::uint32_t sequence_ = 0;
  std::vector<std::uint8_t> bytes_;
};

TEST(CameraImages, TakesThreeASecondUntilTheTimeIsOver) {
  for (const PixelFormat format : {PixelFormat::yuyv, PixelFormat::nv12}) {
    const auto images = open_camera_images(std::make_unique<SteadyCamera>(format, 1000), 4);
    int count = 0;
    while (const auto frame = images->next()) {
      EXPECT_EQ(frame->image.size(), cv::Size(64, 48));
      EXPECT_EQ(frame->index, count);
      EXPECT_NEAR(frame->time_s, count / 3.0, 0.02);
      ++count;
    }
    EXPECT_EQ(count, 13);  // 0, 1/3, ..., 4 s
  }
}

TEST(CameraImages, EndsClearlyWhenTheCameraFallsSilent) {
  const auto images = open_camera_images(std::make_unique<SteadyCamera>(PixelFormat::yuyv, 1), 4);
  EXPECT_TRUE(images->next());
  EXPECT_THROW(images->next(), core::Error);
  // Bytes that are no image are passed over, as a damaged one is.
  EXPECT_THROW(open_camera_images(std::make_unique<SteadyCamera>(PixelFormat::mjpeg, 5), 4)->next(),
               core::Error);
}

TEST(CoverageImage, ShadesOnlyCellsWithoutPoints) {
  const auto truth = make_camera(kSize.width_px, kSize.height_px, true);
  const auto found = calibrate_camera(good_views(truth, 14, 0.1, 12), kSize);
  ASSERT_TRUE(found);
  const cv::Mat image = draw_coverage(*found);
  cv::Mat shaded;
  cv::inRange(image, cv::Scalar(205, 222, 246), cv::Scalar(205, 222, 246), shaded);
  // The frame's area less the cells with points, thin lines and points aside.
  const double frame_area = 960.0 * 540;
  EXPECT_NEAR(cv::countNonZero(shaded) / frame_area, 1 - found->coverage, 0.03);
}

}  // namespace
}  // namespace sheen::capture::test
