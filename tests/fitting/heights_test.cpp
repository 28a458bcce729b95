// SPDX-License-Identifier: MIT
// Heights of vertices from pictures of a print, on surfaces whose true shape is known.
#include "core/mesh/placed_ply.h"
#include "core/mesh/read_mesh.h"
#include "core/numerics/median.h"
#include "fitting/heights/height_field.h"
#include "fitting/heights/refine_heights.h"
#include "pipeline/mesh_heights.h"
#include "tests/fitting/photographs_for_tests.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace sheen::fitting::heights {
namespace {

using fitting::testing::Look;
using fitting::testing::Photographs;

constexpr float kHalf_m = 0.1f;
constexpr float kTexel_m = 1.8e-3f;  ///< 0.36 m away, 160 pixels wide, 43 degrees

/// A square in the plane x = 0, seen from positive x, of `side` x `side` cells.
core::Mesh square(int side) {
  core::Mesh mesh;
  for (int row = 0; row <= side; ++row) {
    for (int column = 0; column <= side; ++column) {
      const auto at = [&](int i) {
        return kHalf_m * (2.0f * static_cast<float>(i) / static_cast<float>(side) - 1.0f);
      };
      mesh.positions.emplace_back(0.0f, at(column), at(row));
      mesh.normals.emplace_back(1.0f, 0.0f, 0.0f);
    }
  }
  const auto row = static_cast<std::uint32_t>(side + 1);
  for (std::uint32_t i = 0; i + row < mesh.positions.size(); ++i) {
    if (i % row == row - 1) continue;
    mesh.triangles.emplace_back(i, i + 1, i + row + 1);
    mesh.triangles.emplace_back(i, i + row + 1, i + row);
  }
  return mesh;
}

/// A hill 2 mm high in the middle, flat at the border.
float hill_m(const Eigen::Vector3f& p) {
  const auto bump = [](float x) {
    const float c = std::cos(0.5f * std::numbers::pi_v<float> * x / kHalf_m);
    return c * c;
  };
  return 2e-3f * bump(p.y()) * bump(p.z());
}

core::Mesh with_hill(core::Mesh mesh) {
  for (Eigen::Vector3f& position : mesh.positions) position.x() += hill_m(position);
  return mesh;
}

/// Blobs 12 mm apart.
Eigen::Vector3f blobs(const Eigen::Vector3f& p, const Eigen::Vector3f& /*towards_viewer*/) {
  const float a = std::sin(500.0f * p.y() + 130.0f * p.z());
  const float b = std::sin(510.0f * p.z() - 110.0f * p.y());
  return {0.5f + 0.35f * a * b, 0.5f + 0.3f * b, 0.5f - 0.3f * a};
}

/// The views that stand in front of a square and see all of it.
std::vector<PosedImage> in_front(const Photographs& photographs) {
  std::vector<PosedImage> views;
  for (const auto& view : photographs.views()) {
    const Eigen::Vector3f eye = core::eye_in_object(view.camera_from_object);
    if (eye.x() < 0.6f * eye.norm()) continue;
    views.push_back({view.image, &photographs.camera(), view.camera_from_object});
  }
  return views;
}

struct Split {
  std::vector<PosedImage> views, check_views;
};

Split split(const std::vector<PosedImage>& all) {
  Split parts;
  for (std::size_t i = 0; i < all.size(); ++i) {
    (i % 4 == 2 ? parts.check_views : parts.views).push_back(all[i]);
  }
  return parts;
}

HeightRefinement refine(const core::Mesh& mesh, const Split& parts, int threads = 1,
                        Outlines outlines = Outlines::may_move) {
  return refine_heights(mesh, parts.views, parts.check_views, kTexel_m, outlines, threads);
}

const Photographs& printed_hill() {
  static const Photographs photographs(with_hill(square(32)), 48, blobs);
  return photographs;
}

bool same(const core::Mesh& a, const core::Mesh& b) {
  return a.positions == b.positions && a.normals == b.normals && a.triangles == b.triangles;
}

// The mesh is flat where the object has a hill of 2 mm, a little more than a pixel: the heights are
// the hill's, and the residual of other views falls to what is left of them.
TEST(Heights, AFlatMeshOfAHillGetsItsHeights) {
  const Split parts = split(in_front(printed_hill()));
  ASSERT_GE(parts.check_views.size(), 3u);
  const core::Mesh flat = square(32);
  const HeightRefinement found = refine(flat, parts);
  EXPECT_TRUE(found.is_accepted);
  double squared = 0, squared_before = 0;
  for (std::size_t i = 0; i < flat.positions.size(); ++i) {
    const auto truth = static_cast<double>(hill_m(flat.positions[i]));
    EXPECT_EQ(found.mesh.positions[i].tail<2>(), flat.positions[i].tail<2>());
    squared += std::pow(static_cast<double>(found.mesh.positions[i].x()) - truth, 2);
    squared_before += truth * truth;
  }
  EXPECT_LT(std::sqrt(squared / squared_before), 0.2);
  EXPECT_LT(found.change(), -0.5);
}

/// Median distance of the border's vertices from the plane x = 0.
float border_off_m(const core::Mesh& mesh) {
  std::vector<double> off;
  for (const Eigen::Vector3f& p : mesh.positions) {
    const bool is_border = p.tail<2>().cwiseAbs().maxCoeff() > 0.99f * kHalf_m;
    if (is_border) off.push_back(std::abs(static_cast<double>(p.x())));
  }
  return static_cast<float>(core::upper_median(off));
}

// The whole mesh lies 6 mm, three pixels, behind the printed square, outline and all. The border,
// on the outline of every view, comes to 0 where outlines may move (0.04 mm is left) and is held
// back where they stay (2.7 mm).
TEST(Heights, AMeshBesideItsPlaceIsMovedOutlineAndAll) {
  const Photographs photographs(square(32), 48, blobs);
  const Split parts = split(in_front(photographs));
  core::Mesh behind = square(32);
  for (Eigen::Vector3f& position : behind.positions) position.x() -= 6e-3f;
  const HeightRefinement moved = refine(behind, parts, 1, Outlines::may_move);
  EXPECT_TRUE(moved.is_accepted);
  EXPECT_LT(border_off_m(moved.mesh), 0.12e-3f);
  EXPECT_GT(border_off_m(refine(behind, parts, 1, Outlines::stay).mesh), 1.3e-3f);
}

// Normals turn with the surface: those of the hill are (1, -dh/dy, -dh/dz).
TEST(Heights, NormalsTurnWithTheSurface) {
  const core::Mesh flat = square(32);
  HeightField field(flat);
  ASSERT_EQ(field.size(), flat.positions.size());
  for (std::size_t i = 0; i < field.size(); ++i) {
    field.heights()[static_cast<Eigen::Index>(i)] = static_cast<double>(hill_m(flat.positions[i]));
  }
  const core::Mesh raised = field.raised();
  for (std::size_t i = 0; i < flat.positions.size(); ++i) {
    const Eigen::Vector3f p = flat.positions[i];
    if (p.tail<2>().cwiseAbs().maxCoeff() > 0.09f) continue;
    constexpr float step = 1e-3f;
    const Eigen::Vector3f dy(0, step, 0), dz(0, 0, step);
    const Eigen::Vector3f truth =
        Eigen::Vector3f(2 * step, hill_m(p - dy) - hill_m(p + dy), hill_m(p - dz) - hill_m(p + dz))
            .normalized();
    EXPECT_LT((raised.normals[i] - truth).norm(), 5e-3f) << i;
  }
}

TEST(Heights, TheRightMeshStays) {
  const core::Mesh hill = with_hill(square(32));
  const HeightRefinement found = refine(hill, split(in_front(printed_hill())));
  EXPECT_FALSE(found.is_accepted);
  EXPECT_TRUE(same(found.mesh, hill));
}

// Nothing is printed, so nothing says where the surface lies: not with one colour, nor with
// shading, which is the same from everywhere.
TEST(Heights, AnUntexturedObjectStays) {
  const Look grey = [](const auto&, const auto&) { return Eigen::Vector3f(0.4f, 0.5f, 0.6f); };
  const core::Mesh flat = square(16);
  const Photographs photographs(with_hill(square(16)), 40, grey);
  const HeightRefinement found = refine(flat, split(in_front(photographs)));
  EXPECT_FALSE(found.is_accepted);
  EXPECT_TRUE(same(found.mesh, flat));
}

TEST(Heights, ThreadsDoNotChangeABit) {
  const Split parts = split(in_front(printed_hill()));
  const HeightRefinement one = refine(square(32), parts, 1);
  for (const int threads : {2, 7}) {
    const HeightRefinement more = refine(square(32), parts, threads);
    EXPECT_TRUE(same(one.mesh, more.mesh)) << threads;
    EXPECT_EQ(one.residual_after, more.residual_after);
  }
}

// Check views decide and do nothing else: other pixels in them, other residuals, the same heights.
TEST(Heights, CheckViewsMoveNothing) {
  Split parts = split(in_front(printed_hill()));
  const HeightRefinement before = refine(square(32), parts);
  for (PosedImage& view : parts.check_views) view.image = view.image * 0.98;
  const HeightRefinement after = refine(square(32), parts);
  EXPECT_NE(before.residual_after, after.residual_after);
  ASSERT_TRUE(before.is_accepted && after.is_accepted);
  EXPECT_TRUE(same(before.mesh, after.mesh));
}

// Vertices at the same place, as at a crease, move together: no gap opens.
TEST(Heights, SplitVerticesMoveTogether) {
  core::Mesh flat = square(32);
  const auto count = static_cast<std::uint32_t>(flat.positions.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    flat.positions.push_back(flat.positions[i]);
    flat.normals.push_back(flat.normals[i]);
  }
  for (std::size_t t = 0; t < flat.triangles.size(); t += 2) flat.triangles[t].array() += count;
  const HeightRefinement found = refine(flat, split(in_front(printed_hill())));
  ASSERT_TRUE(found.is_accepted);
  for (std::uint32_t i = 0; i < count; ++i) {
    EXPECT_EQ(found.mesh.positions[i], found.mesh.positions[i + count]);
  }
}

// A second square behind the first one, never seen: it stays, and so does everything when there are
// too few views; a triangle alone and meshes without any neither move wildly nor fail.
TEST(Heights, WhatIsNotSeenStays) {
  core::Mesh both = square(32);
  const core::Mesh behind = square(32);
  const auto count = static_cast<std::uint32_t>(both.positions.size());
  for (std::size_t i = 0; i < behind.positions.size(); ++i) {
    both.positions.emplace_back(behind.positions[i] - Eigen::Vector3f(0.01f, 0, 0));
    both.normals.push_back(-behind.normals[i]);
  }
  for (const auto& triangle : behind.triangles) {
    both.triangles.emplace_back(triangle[0] + count, triangle[2] + count, triangle[1] + count);
  }
  const Split parts = split(in_front(printed_hill()));
  const HeightRefinement found = refine(both, parts);
  ASSERT_TRUE(found.is_accepted);
  for (std::size_t i = count; i < both.positions.size(); ++i) {
    EXPECT_EQ(found.mesh.positions[i], both.positions[i]);
  }
  const Split none{{}, parts.check_views};
  const Split one{{parts.views[0]}, parts.check_views};
  const Split unchecked{parts.views, {}};
  for (const Split* const few : {&none, &one, &unchecked}) {
    EXPECT_FALSE(refine(both, *few).is_accepted);
    EXPECT_TRUE(same(refine(both, *few).mesh, both));
  }
  core::Mesh triangle = square(1);
  triangle.triangles.resize(1);
  core::Mesh points = square(1);
  points.triangles.clear();
  core::Mesh line = square(1);
  line.positions[3] = 0.5f * (line.positions[0] + line.positions[1]);
  for (const core::Mesh& mesh : {triangle, points, line}) {
    const HeightRefinement small = refine(mesh, parts);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      EXPECT_LE((small.mesh.positions[i] - mesh.positions[i]).norm(), 5 * kTexel_m);
      EXPECT_TRUE(small.mesh.normals[i].allFinite());
    }
  }
}

// What is written lies where the mesh's file lay: reading it again gives the same mesh, here in
// coordinates of a survey, which single precision could not hold.
TEST(Heights, AMeshIsWrittenWhereItsFileLay) {
  const tests::TemporaryFolder folder;
  core::Mesh mesh = with_hill(square(4));
  mesh.offset = {5.4e6, -3.1e5, 250.0};
  core::write_placed_ply(folder / "a.ply", mesh);
  const core::Mesh read = core::read_mesh(folder / "a.ply");
  EXPECT_FALSE(read.offset.isZero());
  ASSERT_EQ(read.positions.size(), mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Eigen::Vector3d there = mesh.positions[i].cast<double>() + mesh.offset;
    EXPECT_LT((read.positions[i].cast<double>() + read.offset - there).norm(), 1e-7);
  }
}

/// Photographs as the frames of a recording; those held out are noise where asked for.
class Recording final : public capture::FrameSource {
 public:
  Recording(std::vector<PosedImage> views, int noisy_every)
      : views_(std::move(views)), noisy_every_(noisy_every) {}

  std::optional<capture::Frame> next() override {
    if (next_ == views_.size()) return std::nullopt;
    const auto index = static_cast<int>(next_++);
    cv::Mat image = views_[static_cast<std::size_t>(index)].image;
    if (noisy_every_ > 0 && index % noisy_every_ == noisy_every_ / 2) image = 255 - image;
    capture::Frame frame;
    frame.image = image;
    frame.index = index;
    return frame;
  }
  [[nodiscard]] std::optional<int> frame_count() const override {
    return static_cast<int>(views_.size());
  }

 private:
  std::vector<PosedImage> views_;
  int noisy_every_;
  std::size_t next_ = 0;
};

class KnownPoses final : public capture::PoseEstimator {
 public:
  explicit KnownPoses(std::vector<PosedImage> views) : views_(std::move(views)) {}
  capture::PoseResult estimate(const capture::Frame& frame) override {
    return capture::FramePose{.camera_from_board =
                                  views_[static_cast<std::size_t>(frame.index)].camera_from_object};
  }

 private:
  std::vector<PosedImage> views_;
};

pipeline::MeshRefinement refine_recording(const std::vector<PosedImage>& views, int hold_out,
                                          int noisy_every) {
  capture::Session session;
  session.camera = printed_hill().camera();
  pipeline::PoseStage poses(std::make_unique<Recording>(views, noisy_every),
                            std::make_unique<KnownPoses>(views));
  pipeline::FrameChoice choice;
  choice.hold_out = hold_out;
  pipeline::ProgressSink sink;
  return pipeline::refine_mesh_heights(
      square(32), pipeline::read_stills(session, choice, poses, sink), Outlines::may_move, 1, sink);
}

// Held-out frames have no part: with them turned into their negatives not a bit changes. That they
// would matter shows when they are not held out.
TEST(Heights, HeldOutFramesHaveNoPart) {
  const std::vector<PosedImage> views = in_front(printed_hill());
  const auto plain = refine_recording(views, 5, 0);
  const auto altered = refine_recording(views, 5, 5);
  ASSERT_TRUE(plain.is_accepted);
  EXPECT_TRUE(same(plain.mesh, altered.mesh));
  EXPECT_EQ(plain.residual_change, altered.residual_change);
  EXPECT_FALSE(same(plain.mesh, refine_recording(views, 0, 5).mesh));
  EXPECT_EQ(plain.views + plain.check_views, views.size() - (views.size() + 2) / 5);
}

}  // namespace
}  // namespace sheen::fitting::heights
