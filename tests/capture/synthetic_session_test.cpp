// SPDX-License-Identifier: MIT
#include "capture/synthetic/synthetic_session.h"

#include "capture/pose/board.h"
#include "capture/pose/trajectory.h"
#include "capture/session/depth_images.h"
#include "capture/session/frame_stamps.h"
#include "capture/session/session.h"
#include "capture/synthetic/motion_jpeg_file.h"
#include "capture/synthetic/torus_knot.h"
#include "core/diagnostics/error.h"
#include "core/mesh/read_mesh.h"
#include "core/visibility/ray_caster.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>

namespace sheen::capture::synthetic {
namespace {

namespace fs = std::filesystem;

/// A folder that lives as long as a test.
class SyntheticSession : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("sheen_synthetic_") + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static SyntheticOptions small() {
    SyntheticOptions options;
    options.vertices = 1000;
    options.width_px = 320;
    options.height_px = 180;
    options.frames = 3;
    options.held_out = 2;
    options.samples = 2;
    return options;
  }

  fs::path folder_;
};

std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream file(entry.path(), std::ios::binary);
    files[entry.path().lexically_relative(folder).string()] =
        std::string(std::istreambuf_iterator<char>(file), {});
  }
  return files;
}

TEST_F(SyntheticSession, OpensAsASession) {
  int calls = 0;
  write_synthetic_session(folder_ / "s", small(), [&](int done, int total) {
    EXPECT_EQ(done, ++calls);
    EXPECT_EQ(total, 5);
  });
  EXPECT_EQ(calls, 5);

  // The recording: a video without poses, so that the tags must be read.
  const Session session = open_session(folder_ / "s");
  EXPECT_TRUE(session.warnings.empty());
  EXPECT_TRUE(session.video);
  EXPECT_FALSE(session.poses);
  EXPECT_EQ(read_board(session.board.value()).tags.size(), 40U);
  EXPECT_EQ(read_trajectory(session.folder / "truth_poses.txt").entries().size(), 3U);
  auto frames = open_frames(session);
  for (int i = 0; i < 3; ++i) {
    const auto frame = frames->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->image.size(), cv::Size(320, 180));
  }
  EXPECT_FALSE(frames->next());

  // The views held out: stills with poses, the same object at the same place.
  const Session held_out = open_session(folder_ / "s" / "held_out");
  EXPECT_TRUE(held_out.image_pattern);
  EXPECT_TRUE(held_out.poses);
  EXPECT_TRUE(held_out.board_from_object.isApprox(session.board_from_object, 1e-12));
  EXPECT_EQ(core::read_mesh(held_out.mesh).positions, core::read_mesh(session.mesh).positions);
  EXPECT_TRUE(open_frames(held_out)->next());
}

TEST_F(SyntheticSession, BytesDependOnOptionsAloneAndNotOnThreads) {
  SyntheticOptions options = small();
  write_synthetic_session(folder_ / "one", options, {});
  options.threads = 2;
  write_synthetic_session(folder_ / "two", options, {});
  options.seed = 2;
  write_synthetic_session(folder_ / "other", options, {});
  EXPECT_EQ(contents(folder_ / "one"), contents(folder_ / "two"));
  EXPECT_NE(contents(folder_ / "one").at("frames.avi"),
            contents(folder_ / "other").at("frames.avi"));
}

// Depth images against rays through the exact lens, not the interpolated one of the camera that
// photographs: within half a step, but for pixels whose middle lies on an outline.
TEST_F(SyntheticSession, DepthImagesSayHowFarEverythingIs) {
  SyntheticOptions options = small();
  options.depth = true;
  write_synthetic_session(folder_ / "s", options, {});
  const Session session = open_session(folder_ / "s");
  const Trajectory truth = read_trajectory(folder_ / "s" / "truth_poses.txt");
  const DepthImages images(session);
  const double unit_m = session.depth.value().unit_m;
  const core::Mesh mesh = core::read_mesh(session.mesh);
  const core::RayCaster caster(mesh);
  int wrong = 0;
  for (int frame = 0; frame < options.frames; ++frame) {
    const cv::Mat depth_m = images.read(frame);
    const Eigen::Isometry3d& board_from_camera =
        truth.entries()[static_cast<std::size_t>(frame)].board_from_camera;
    const Eigen::Isometry3d object_from_camera =
        session.board_from_object.inverse() * board_from_camera;
    const Eigen::Vector3d eye = board_from_camera.translation();
    for (int y = 0; y < depth_m.rows; ++y) {
      for (int x = 0; x < depth_m.cols; ++x) {
        // Of z 1, so that lengths along it are depths.
        const Eigen::Vector3d ray = *session.camera.unproject({x, y});
        const auto hit =
            caster.first_hit(object_from_camera.translation().cast<float>(),
                             (object_from_camera.linear() * ray).cast<float>(), 0, 100.0f);
        const double board_m = -eye.z() / (board_from_camera.linear() * ray).z();
        const double expected = hit ? static_cast<double>(hit->distance) : board_m;
        if (std::abs(static_cast<double>(depth_m.at<float>(y, x)) - expected) > unit_m / 2 + 1e-5) {
          ++wrong;
        }
      }
    }
  }
  std::printf("%d pixels\n", wrong);
  EXPECT_LT(wrong, options.frames * options.width_px * options.height_px / 1000);
}

TEST_F(SyntheticSession, InterruptedWorkLeavesWhatWasThere) {
  fs::create_directories(folder_ / "s");
  std::ofstream(folder_ / "s" / "precious.txt") << "mine";
  const auto before = contents(folder_);
  const auto interrupt = [](int done, int) {
    if (done == 2) throw std::runtime_error("stop");
  };
  EXPECT_THROW(write_synthetic_session(folder_ / "s", small(), interrupt), std::runtime_error);
  EXPECT_EQ(contents(folder_), before);
}

TEST_F(SyntheticSession, PutsAMeshOfOnesOwnOnTheBoard) {
  // A knot turned into somebody's scan: off centre, below the ground.
  core::Mesh scan = torus_knot(1000);
  for (Eigen::Vector3f& p : scan.positions) p += Eigen::Vector3f(1, -2, -0.5f);
  core::write_ply(folder_ / "scan.ply", scan);
  SyntheticOptions options = small();
  options.mesh = folder_ / "scan.ply";
  const Scene scene = make_scene(options);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& p : scene.object().positions) box.extend(p.cast<double>());
  EXPECT_NEAR(box.center().x(), 1, 0.01);  // the file's coordinates are kept

  // The middle of its foot stands on the origin: p_board = R_z (p - foot) leaves z of the foot.
  const Eigen::Vector3d foot(box.center().x(), box.center().y(), box.min().z());
  EXPECT_LT((scene.board_from_object() * foot).norm(), 1e-6);
  EXPECT_TRUE((scene.board_from_object().linear() * Eigen::Vector3d::UnitZ())
                  .isApprox(Eigen::Vector3d::UnitZ()));

  // Millimetres taken for metres are refused.
  for (Eigen::Vector3f& p : scan.positions) p *= 1000;
  core::write_ply(folder_ / "scan.ply", scan);
  EXPECT_THROW(make_scene(options), core::Error);
}

TEST_F(SyntheticSession, SessionMeshMayBeCoarserThanWhatIsPhotographed) {
  SyntheticOptions options = small();
  options.vertices = 4000;
  write_synthetic_session(folder_ / "fine", options, {});
  options.mesh_vertices = 600;
  options.check();
  write_synthetic_session(folder_ / "coarse", options, {});
  auto fine = contents(folder_ / "fine");
  auto coarse = contents(folder_ / "coarse");
  for (const char* mesh : {"object.ply", "held_out/object.ply"}) {
    EXPECT_EQ(core::read_mesh(folder_ / "coarse" / mesh).positions.size(),
              torus_knot(600).positions.size());
    fine.erase(mesh);
    coarse.erase(mesh);
  }
  // Images, poses and the place on the board are those of the fine object.
  EXPECT_EQ(fine, coarse);
  options.mesh_vertices = 20;
  EXPECT_THROW(options.check(), std::invalid_argument);
}

TEST_F(SyntheticSession, OptionsOutOfRangeAreNamed) {
  SyntheticOptions options = small();
  EXPECT_NO_THROW(options.check());
  options.frames = 1;
  try {
    options.check();
    FAIL() << "accepted one frame";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("frames"), std::string::npos);
  }
}

TEST_F(SyntheticSession, MotionJpegComesBack) {
  // Three smooth grey images of different detail, so that the JPEGs have different, also odd,
  // lengths. At quality 95 the steps of the DCT are at most 12 grey levels, and the high ones are
  // empty: an error of 2 levels, 42 dB, would be much.
  const fs::path path = folder_ / "v.avi";
  const auto drawn = [](int i) {
    cv::Mat image(48, 64, CV_8UC3, cv::Scalar::all(90));
    cv::circle(image, {20 + 8 * i, 24}, 6 + 4 * i, cv::Scalar::all(200), cv::FILLED);
    cv::GaussianBlur(image, image, {}, 3);
    return image;
  };
  MotionJpegFile video(path, {64, 48}, 30, 95);
  for (int i = 0; i < 3; ++i) video.append(drawn(i));
  video.close();

  cv::VideoCapture reader(path.string());
  ASSERT_TRUE(reader.isOpened());
  EXPECT_EQ(reader.get(cv::CAP_PROP_FRAME_COUNT), 3);
  EXPECT_EQ(reader.get(cv::CAP_PROP_FPS), 30);
  cv::Mat image;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(reader.read(image));
    EXPECT_GT(cv::PSNR(image, drawn(i)), 42) << "image " << i;
  }
  EXPECT_FALSE(reader.read(image));
}

// Whatever is passed over, the next frame is the one that reading everything gives; at the end
// there is nothing to pass over. Of a video with stamps, without, and of pictures.
TEST_F(SyntheticSession, SkippedFramesAreThoseThatWouldBeRead) {
  SyntheticOptions options = small();
  options.frames = 6;
  options.held_out = 6;
  write_synthetic_session(folder_ / "s", options, {});
  Session stamped = open_session(folder_ / "s");
  std::ofstream stamps(folder_ / "stamps.csv");
  stamps << stamps_heading();
  for (int i = 0; i < options.frames; ++i) stamps << stamp_line(i, 40'000 * i, 0);
  stamps.close();
  stamped.stamps = folder_ / "stamps.csv";
  for (const Session& session :
       {open_session(folder_ / "s"), stamped, open_session(folder_ / "s" / "held_out")}) {
    for (int skipped = 0; skipped < options.frames; ++skipped) {
      const auto all = open_frames(session), some = open_frames(session);
      for (int i = 0; i < skipped; ++i) {
        ASSERT_TRUE(all->next());
        ASSERT_TRUE(some->skip());
      }
      const auto expected = all->next(), frame = some->next();
      ASSERT_TRUE(frame);
      EXPECT_EQ(frame->index, skipped);
      EXPECT_EQ(frame->time_s, expected->time_s);
      EXPECT_EQ(cv::norm(frame->image, expected->image, cv::NORM_INF), 0);
      for (int i = skipped + 1; i < options.frames; ++i) EXPECT_TRUE(some->skip());
      EXPECT_FALSE(some->skip());
      EXPECT_FALSE(some->next());
    }
  }
}

}  // namespace
}  // namespace sheen::capture::synthetic
