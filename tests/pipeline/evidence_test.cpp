// SPDX-License-Identifier: MIT
// Recordings with one fault of known size, and without.
#include "capture/pose/joint_pose.h"
#include "pipeline/evidence/capture_evidence.h"
#include "pipeline/evidence/corner_evidence.h"
#include "pipeline/evidence/light_evidence.h"
#include "pipeline/evidence/outline_evidence.h"
#include "pipeline/evidence/tag_evidence.h"
#include "pipeline/thinned.h"
#include "tests/capture/rendered_board.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

namespace sheen::pipeline {
namespace {

using capture::test::look_at_board;

std::vector<std::string> causes(const std::vector<Finding>& findings) {
  std::vector<std::string> names;
  for (const Finding& finding : findings) names.push_back(finding.cause);
  return names;
}
using Causes = std::vector<std::string>;

// Whatever the length, what is kept is evenly spaced from the first frame on, and half full at
// least; of 1000 frames with room for 8 the spacing is the power of two for which fewer than 8
// remain: 128 keeps 0, 128, ..., 896, which are 8, so 256 with 0, 256, 512, 768.
TEST(Thinned, KeepsEvenlySpacedFrames) {
  Thinned<int> kept(8);
  for (int frame = 0; frame < 1000; ++frame) {
    if (kept.is_due()) kept.add(frame);
    if (frame < 8) continue;
    const auto& items = kept.items();
    ASSERT_GE(items.size(), 4u) << frame;
    ASSERT_LT(items.size(), 8u) << frame;
    for (std::size_t i = 1; i < items.size(); ++i) {
      ASSERT_EQ(items[i] - items[i - 1], items[1] - items[0]) << frame;
    }
  }
  EXPECT_EQ(kept.items(), (std::vector<int>{0, 256, 512, 768}));
}

// --- Light: 400 patches on a disc of the image, seen from directions that turn with the frames.

constexpr int kFrames = 40;
constexpr std::uint32_t kPatches = 400;
using Light = std::function<Eigen::Vector3d(int frame, std::uint32_t patch, Eigen::Vector2d uv,
                                            Eigen::Vector2d px)>;

float srgb_of(double linear) {
  return static_cast<float>(linear <= 0.0031308 ? 12.92 * linear
                                                : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

LightEvidence evidence_of(const Light& light) {
  LightEvidence evidence(kPatches);
  for (int frame = 0; frame < kFrames; ++frame) {
    core::SampleBatch batch;
    core::VertexView view;
    for (std::uint32_t patch = 0; patch < kPatches; ++patch) {
      const Eigen::Vector2d px(10.0 * (patch % 20), 10.0 * (patch / 20));
      const double angle = 2 * std::numbers::pi * frame / kFrames;
      // Steeper to the right, so that patches differ in slope.
      const Eigen::Vector2d uv =
          (0.1 + 0.004 * px.x()) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      const Eigen::Vector3d rgb = light(frame, patch, uv, px);
      view.x_px.push_back(static_cast<float>(px.x()));
      view.y_px.push_back(static_cast<float>(px.y()));
      batch.patch.push_back(patch);
      batch.u.push_back(static_cast<float>(uv.x()));
      batch.v.push_back(static_cast<float>(uv.y()));
      batch.r.push_back(srgb_of(rgb[0]));
      batch.g.push_back(srgb_of(rgb[1]));
      batch.b.push_back(srgb_of(rgb[2]));
    }
    evidence.look_at(frame, batch, view);
  }
  return evidence;
}

/// Grey to blue prints that look alike from everywhere.
Eigen::Vector3d print_colour(std::uint32_t patch) {
  const double shade = 0.2 + 0.02 * (patch % 7);
  return {shade, shade, shade * (1 + 0.1 * (patch % 5))};
}

double wave(int frame) {
  return std::sin(2 * std::numbers::pi * frame / kFrames);
}

TEST(LightEvidence, SurfacesThatChangeLinearlyWithDirectionAreFine) {
  const auto verdict =
      evidence_of([](int, std::uint32_t patch, const Eigen::Vector2d& uv, const Eigen::Vector2d&) {
        return Eigen::Vector3d(print_colour(patch) *
                               std::exp2((patch % 2 == 0 ? 0.5 : -0.5) * uv.x()));
      }).verdict();
  EXPECT_LT(verdict.exposure_stops, 0.1);
  EXPECT_LT(verdict.balance_stops, 1e-3);
  EXPECT_EQ(verdict.odd_share, 0);
  EXPECT_TRUE(verdict.hidden_frames.empty());
  EXPECT_TRUE(LightEvidence::drifts(verdict).empty());
}

// A wave of one stop either way: without the extreme twentieths, frames 1 and 38 of 40 by size,
// its range is nearly two. Half a wave of each round could be the patches' own.
TEST(LightEvidence, ExposureThatDriftsIsSaid) {
  const auto verdict =
      evidence_of([](int frame, std::uint32_t patch, const Eigen::Vector2d&,
                     const Eigen::Vector2d&) {
        return Eigen::Vector3d(print_colour(patch) * std::exp2(std::abs(wave(frame)) * 2 - 1));
      }).verdict();
  EXPECT_NEAR(verdict.exposure_stops, 2, 0.2);
  EXPECT_LT(verdict.balance_stops, 1e-3);
  EXPECT_EQ(causes(LightEvidence::drifts(verdict)), Causes{"exposure-drift"});
}

// Red up and blue down by one stop either way: against each other by four.
TEST(LightEvidence, WhiteBalanceThatDriftsIsSaid) {
  const auto verdict = evidence_of([](int frame, std::uint32_t patch, const Eigen::Vector2d&,
                                      const Eigen::Vector2d&) -> Eigen::Vector3d {
                         const double stops = std::abs(wave(frame)) * 2 - 1;
                         return print_colour(patch).cwiseProduct(
                             Eigen::Vector3d(std::exp2(stops), 1, std::exp2(-stops)));
                       }).verdict();
  EXPECT_NEAR(verdict.balance_stops, 4, 0.4);
  EXPECT_LT(verdict.exposure_stops, 0.05);
  EXPECT_EQ(causes(LightEvidence::drifts(verdict)), Causes{"white-balance-drift"});
}

// Every fourth frame is redder by two stops, which is said; where a fifth of the patches shows
// another colour in these frames, too, their poses may be wrong: they tell nothing about light.
TEST(LightEvidence, FramesThatDoNotFitShowNoDrift) {
  const auto balance_with = [](double flash_stops) {
    return evidence_of([=](int frame, std::uint32_t patch, const Eigen::Vector2d&,
                           const Eigen::Vector2d&) -> Eigen::Vector3d {
             if (frame % 4 != 3) return print_colour(patch);
             const double flash = patch % 5 == 0 ? flash_stops : 0;
             return print_colour(patch).cwiseProduct(Eigen::Vector3d(4, std::exp2(flash), 1) / 4);
           })
        .verdict()
        .balance_stops;
  };
  EXPECT_NEAR(balance_with(0), 2, 0.2);
  EXPECT_LT(balance_with(1.5), 0.2);
}

// A third of the patches, those seen flattest, flash by two stops: no exposure does that.
TEST(LightEvidence, OneSideThatFlashesIsNoExposure) {
  const auto verdict = evidence_of([](int frame, std::uint32_t patch, const Eigen::Vector2d&,
                                      const Eigen::Vector2d& px) {
                         const bool flashes = px.x() < 60 && frame % 10 < 5;
                         return Eigen::Vector3d(print_colour(patch) * (flashes ? 2 : 1));
                       }).verdict();
  EXPECT_LT(verdict.exposure_stops, 0.1);
  EXPECT_TRUE(LightEvidence::drifts(verdict).empty());
}

// Skin over a tenth of the image in every eighth frame: just those are named. White light over the
// same place is gloss.
TEST(LightEvidence, WhatComesBeforeTheObjectIsSaidAndGlossIsNot) {
  const auto patched = [](const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& cover) {
    return evidence_of([&](int frame, std::uint32_t patch, const Eigen::Vector2d&,
                           const Eigen::Vector2d& px) -> Eigen::Vector3d {
             const Eigen::Vector3d print = print_colour(patch);
             const bool is_covered = frame % 8 == 3 && (px - Eigen::Vector2d(90, 90)).norm() < 40;
             return is_covered ? cover(print) : print;
           })
        .verdict();
  };
  const auto skin =
      patched([](const Eigen::Vector3d&) { return Eigen::Vector3d(0.5, 0.25, 0.12); });
  EXPECT_EQ(skin.hidden_frames, (std::vector<int>{3, 11, 19, 27, 35}));
  EXPECT_EQ(causes(LightEvidence::contradictions(skin)), Causes{"hidden-object"});
  const auto gloss = patched([](const Eigen::Vector3d& print) {
    return Eigen::Vector3d(print + Eigen::Vector3d::Constant(0.4));
  });
  EXPECT_TRUE(gloss.hidden_frames.empty());
}

// --- Outlines: a lying drop, red before grey, drawn by filling its triangles.

core::Mesh drop(double scale, const Eigen::Vector3d& shift) {
  constexpr int rings = 24, sectors = 32;
  core::Mesh mesh;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const double theta = std::numbers::pi * i / rings, phi = 2 * std::numbers::pi * j / sectors;
      const Eigen::Vector3d d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                              std::cos(theta));
      const double r = 0.05 + 0.015 * d.x() * d.x() * d.x() - 0.01 * d.y() * d.z();
      mesh.positions.push_back((scale * r * d + shift).cast<float>());
      mesh.normals.push_back(d.cast<float>());
    }
  }
  const auto at = [](int i, int j) {
    return static_cast<std::uint32_t>(i * sectors + j % sectors);
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      if (i > 0) mesh.triangles.emplace_back(at(i, j), at(i + 1, j), at(i, j + 1));
      if (i + 1 < rings) mesh.triangles.emplace_back(at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
    }
  }
  return mesh;
}

constexpr int kRound = 16;
constexpr int kLookedAt = 4;  // every fourth frame of a recording

/// Photographs of `seen(frame)`, all round, against the plain drop.
OutlineEvidence outlines_of(const core::Mesh& mesh,
                            const std::function<core::Mesh(int frame)>& seen,
                            const cv::Scalar& object = {40, 40, 180},
                            const cv::Scalar& ground = {160, 160, 160}) {
  const core::CameraModel camera = capture::test::make_camera(320, 240, false);
  OutlineEvidence evidence(mesh);
  for (int frame = 0; frame < kRound; ++frame) {
    const Eigen::Isometry3d camera_from_object =
        look_at_board(0.3, 0.5 + 0.3 * (frame % 3), 2 * std::numbers::pi * frame / kRound);
    cv::Mat image(240, 320, CV_8UC3, ground);
    const core::Mesh shown = seen(frame);
    constexpr int shift = 4;
    for (const auto& triangle : shown.triangles) {
      std::vector<cv::Point> corners;
      for (int c = 0; c < 3; ++c) {
        const auto px =
            camera.project(camera_from_object * shown.positions[triangle[c]].cast<double>());
        corners.emplace_back(cvRound(px->x() * (1 << shift)), cvRound(px->y() * (1 << shift)));
      }
      cv::fillConvexPoly(image, corners, object, cv::LINE_8, shift);
    }
    cv::GaussianBlur(image, image, {}, 0.7);
    for (int i = 0; i < kLookedAt; ++i) {
      evidence.look_at(frame, image, camera, camera_from_object);
    }
  }
  return evidence;
}

TEST(OutlineEvidence, AMeshThatFitsIsFine) {
  const core::Mesh mesh = drop(1, Eigen::Vector3d::Zero());
  const auto evidence = outlines_of(mesh, [&](int) { return mesh; });
  const auto found = evidence.misplacement();
  ASSERT_TRUE(found);
  EXPECT_LT(found->unknowns.head<3>().norm(), 0.004 * evidence.radius_m());
  EXPECT_TRUE(evidence.findings().empty());
}

// Everything 4 % larger about the origin, which is 1 mm beside the middle of the box. OpenCV fills
// every pixel that it touches, half a pixel too much: against what the plain drop is told.
TEST(OutlineEvidence, SizeIsMeasured) {
  const core::Mesh mesh = drop(1, Eigen::Vector3d::Zero());
  const auto evidence = outlines_of(mesh, [](int) { return drop(1.04, Eigen::Vector3d::Zero()); });
  const auto found = evidence.misplacement();
  const auto plain = outlines_of(mesh, [&](int) { return mesh; }).misplacement();
  ASSERT_TRUE(found && plain);
  const double growth_m = found->unknowns[6] - plain->unknowns[6];
  EXPECT_NEAR(growth_m / evidence.radius_m(), 0.04, 0.006);
  EXPECT_EQ(causes(evidence.findings()), Causes{"mesh-size"});
}

TEST(OutlineEvidence, PlaceIsMeasured) {
  const core::Mesh mesh = drop(1, Eigen::Vector3d::Zero());
  const Eigen::Vector3d shift(0.003, -0.002, 0.001);
  const auto evidence = outlines_of(mesh, [&](int) { return drop(1, shift); });
  const auto found = evidence.misplacement();
  ASSERT_TRUE(found);
  EXPECT_LT((found->unknowns.head<3>() - shift).norm(), 0.0006);
  EXPECT_EQ(causes(evidence.findings()), Causes{"mesh-place"});
}

// Four times as long as thick: upright in the images, lying in its file.
TEST(OutlineEvidence, AMeshThatIsTurnedIsSaid) {
  const auto stretched = [](int axis) {
    core::Mesh mesh = drop(0.5, Eigen::Vector3d::Zero());
    for (auto& position : mesh.positions) position[axis] *= 4;
    return mesh;
  };
  const core::Mesh lying = stretched(1);
  const auto turned = outlines_of(lying, [&](int) { return stretched(2); });
  const auto right = outlines_of(lying, [&](int) { return lying; });
  EXPECT_GT(right.agreement(right.misplacement().value()), 0.9);
  EXPECT_LT(turned.agreement(turned.misplacement().value()), 0.12);
  EXPECT_EQ(causes(turned.findings()), Causes{"mesh-mismatch"});
  EXPECT_TRUE(right.findings().empty());
}

// A camera without colour: eight levels tell the object from its ground.
TEST(OutlineEvidence, ShadesOfGreyAreToldApart) {
  const core::Mesh mesh = drop(1, Eigen::Vector3d::Zero());
  const auto evidence = outlines_of(
      mesh, [&](int) { return mesh; }, cv::Scalar::all(162), cv::Scalar::all(170));
  EXPECT_GT(evidence.agreement(evidence.misplacement().value()), 0.9);
  EXPECT_TRUE(evidence.findings().empty());
}

// 2 % larger, and half a pixel of 50 by OpenCV's filling: said of coloured images only. 5 %: of
// both.
TEST(OutlineEvidence, GreyImagesMustBeSurer) {
  const core::Mesh mesh = drop(1, Eigen::Vector3d::Zero());
  for (const double scale : {1.02, 1.05}) {
    const auto seen = [=](int) { return drop(scale, Eigen::Vector3d::Zero()); };
    const auto grey = outlines_of(mesh, seen, cv::Scalar::all(60), cv::Scalar::all(160));
    EXPECT_EQ(causes(outlines_of(mesh, seen).findings()), Causes{"mesh-size"}) << scale;
    EXPECT_EQ(causes(grey.findings()), scale > 1.04 ? Causes{"mesh-size"} : Causes{}) << scale;
  }
}

TEST(OutlineEvidence, TheFrameAtWhichTheObjectMovedIsFound) {
  const core::Mesh mesh = drop(1, Eigen::Vector3d::Zero());
  const Eigen::Vector3d shift(0.004, 0.003, 0);
  const auto evidence = outlines_of(mesh, [&](int frame) {
    return drop(1, frame < 9 ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : shift);
  });
  const auto jump = evidence.jump();
  ASSERT_TRUE(jump);
  EXPECT_EQ(jump->frame_index, 9);
  EXPECT_LT((jump->shift_m - shift).norm(), 0.001);
  EXPECT_EQ(causes(evidence.findings()), Causes{"object-moved"});
}

// --- Corners: a printed board, photographed truly; camera or board are told wrong.

/// Poses found with the told camera are off by `told_from_camera`.
CornerEvidence corners_of(
    const core::CameraModel& told_camera, const capture::Board& told_board,
    const Eigen::Isometry3d& told_from_camera = Eigen::Isometry3d::Identity()) {
  const capture::Board board = capture::test::make_grid_board("tag36h11", 5, 4, 0.03, 0.04);
  const core::CameraModel camera = capture::test::make_camera(480, 360, false);
  CornerEvidence evidence(told_board, told_camera, {Eigen::Vector3d(0, 0, 0.03)});
  for (int i = 0; i < 8; ++i) {
    const auto pose = look_at_board(0.24, 0.9 + 0.05 * (i % 3), 0.8 * i);
    capture::Frame frame;
    frame.image = capture::test::render_board(board, camera, pose, {.supersampling = 2});
    frame.index = i;
    for (int k = 0; k < kLookedAt; ++k)
      evidence.look_at(frame, told_from_camera * pose, std::nullopt);
  }
  return evidence;
}

TEST(CornerEvidence, ABoardAsToldIsFine) {
  const auto board = capture::test::make_grid_board("tag36h11", 5, 4, 0.03, 0.04);
  const auto evidence = corners_of(capture::test::make_camera(480, 360, false), board);
  EXPECT_LT(evidence.fit(CornerEvidence::kLens, 3).effect_px, 0.1);
  EXPECT_LT(evidence.fit(CornerEvidence::kPrincipal, 2).effect_px, 0.1);
  EXPECT_LT(evidence.fit(CornerEvidence::kBend, 3).effect_px, 0.1);
  EXPECT_TRUE(evidence.findings().empty());
}

// What explains the corners is the change that takes the lens back to the true one: none.
TEST(CornerEvidence, AnotherLensIsSaid) {
  const auto board = capture::test::make_grid_board("tag36h11", 5, 4, 0.03, 0.04);
  auto told = capture::test::make_camera(480, 360, false).intrinsics();
  told.distortion[0] = 0.15;
  const auto evidence = corners_of(core::CameraModel(told), board);
  const auto lens = evidence.fit(CornerEvidence::kLens, 3);
  EXPECT_NEAR(lens.solution[1], -0.15, 0.05);
  EXPECT_GT(lens.share, 0.8);
  EXPECT_EQ(causes(evidence.findings()), Causes{"lens"});
}

// As of images that were cropped after the calibration: 30 px on the left. Poses turn by what that
// is in angle.
TEST(CornerEvidence, APrincipalPointElsewhereIsSaid) {
  const auto board = capture::test::make_grid_board("tag36h11", 5, 4, 0.03, 0.04);
  auto told = capture::test::make_camera(480, 360, false).intrinsics();
  told.principal_px.x() += 30;
  const Eigen::Isometry3d turn(
      Eigen::AngleAxisd(-30 / told.focal_px.x(), Eigen::Vector3d::UnitY()));
  const auto evidence = corners_of(core::CameraModel(told), board, turn);
  const auto principal = evidence.fit(CornerEvidence::kPrincipal, 2);
  EXPECT_NEAR(principal.solution[CornerEvidence::kPrincipal], -30, 10);
  EXPECT_NEAR(principal.solution[CornerEvidence::kPrincipal + 1], 0, 5);
  EXPECT_GT(principal.share, 0.8);
  EXPECT_EQ(causes(evidence.findings()), Causes{"lens"});
}

// The file has the tags rise by 6 mm towards x = +-extent, the print is flat: a bend of -6 mm. The
// tracker passes over the tags that fit worst, so that no more than half of it is sure to be seen.
TEST(CornerEvidence, ABoardThatIsNotAsBentAsToldIsSaid) {
  auto board = capture::test::make_grid_board("tag36h11", 5, 4, 0.03, 0.04);
  const double extent_m = 2 * 0.04 + 0.03 / 2;
  for (auto& [id, tag] : board.tags) {
    const double x = tag.board_from_tag.translation().x() / extent_m;
    tag.board_from_tag.translation().z() += 0.006 * x * x;
  }
  const auto evidence = corners_of(capture::test::make_camera(480, 360, false), board);
  const auto bend = evidence.fit(CornerEvidence::kBend, 3);
  EXPECT_LT(bend.solution[CornerEvidence::kBend], -0.003);
  EXPECT_GT(bend.solution[CornerEvidence::kBend], -0.006);
  EXPECT_EQ(causes(evidence.findings()), Causes{"bent-board"});
}

/// Views of some of the tags of a board; the object is `object`.
CornerEvidence weaknesses_of(const std::vector<int>& tags,
                             const std::vector<Eigen::Vector3d>& object, double blur_sigma_px = 0.6,
                             double turn = 0.8) {
  const capture::Board print = capture::test::make_grid_board("tag36h11", 5, 4, 0.03, 0.04);
  const core::CameraModel camera = capture::test::make_camera(480, 360, false);
  capture::Board board = print;
  if (!tags.empty()) {
    std::erase_if(board.tags,
                  [&](const auto& tag) { return std::ranges::count(tags, tag.first) == 0; });
  }
  CornerEvidence evidence(board, camera, object);
  for (int i = 0; i < 3 * kLookedAt; ++i) {
    const auto pose = look_at_board(0.24, 1.0, turn * i);
    capture::Frame frame;
    frame.image = capture::test::render_board(print, camera, pose,
                                              {.blur_sigma_px = blur_sigma_px, .supersampling = 3});
    frame.index = i;
    evidence.look_at(frame, pose, std::nullopt);
  }
  return evidence;
}

// The leverage against what it stands for: noise on corners, the pose that fits them best, and how
// far that moves the object in the image. 400 draws of at least two numbers scatter by 1 / 28.
TEST(CornerEvidence, LeverageIsWhatNoiseOfCornersDoesToTheObject) {
  const std::vector<Eigen::Vector3d> object{{0, 0, 0}, {0.02, 0, 0.05}};
  const std::vector<int> aside{0, 1, 2, 3, 4};  // the row farthest from the origin
  const CornerEvidence evidence = weaknesses_of(aside, object, 0.6, 0);
  ASSERT_TRUE(evidence.leverage());

  capture::Board board = capture::test::make_grid_board("tag36h11", 5, 4, 0.03, 0.04);
  const core::CameraModel camera = capture::test::make_camera(480, 360, false);
  cv::theRNG().state = 7;
  constexpr double noise_px = 0.1;
  constexpr int draws = 400;
  const auto pose = look_at_board(0.24, 1.0, 0);
  double squares = 0;
  for (int draw = 0; draw < draws; ++draw) {
    std::vector<capture::TagDetection> tags;
    for (const auto& [id, corners] : capture::test::true_corners(board, camera, pose)) {
      if (std::ranges::count(aside, id) == 0) continue;
      tags.push_back({id, corners});
      for (Eigen::Vector2d& corner : tags.back().corners_px) {
        corner += Eigen::Vector2d(cv::theRNG().gaussian(noise_px), cv::theRNG().gaussian(noise_px));
      }
    }
    const auto found = capture::estimate_joint_pose(board, camera, tags);
    ASSERT_TRUE(found);
    for (const Eigen::Vector3d& point : object) {
      squares += (*camera.project(found->camera_from_board * point) - *camera.project(pose * point))
                     .squaredNorm();
    }
  }
  const double measured =
      std::sqrt(squares / (draws * static_cast<double>(object.size()))) / noise_px;
  EXPECT_NEAR(*evidence.leverage(), measured, 0.15 * measured);
}

TEST(CornerEvidence, TagsToOneSideAreSaid) {
  const std::vector<Eigen::Vector3d> object{{0, 0, 0}, {0, 0, 0.05}};
  EXPECT_EQ(causes(weaknesses_of({}, object).weaknesses()), Causes{});
  EXPECT_EQ(causes(weaknesses_of({0, 1, 2, 3, 4}, object).weaknesses()), Causes{"tags-aside"});
}

// An edge under a Gaussian of s px takes 2.56 s px from 10 to 90 %, a pixel's own width and the
// reading about 1 px, and the two add in squares: .6 px make 1.8, 1.2 px 3.2.
TEST(CornerEvidence, BlurIsSaid) {
  const std::vector<Eigen::Vector3d> object{{0, 0, 0}};
  const CornerEvidence sharp = weaknesses_of({}, object), blurred = weaknesses_of({}, object, 1.2);
  EXPECT_NEAR(*sharp.blur_px(), 1.8, 0.25);
  EXPECT_NEAR(*blurred.blur_px(), 3.2, 0.4);
  EXPECT_EQ(causes(sharp.weaknesses()), Causes{});
  EXPECT_EQ(causes(blurred.weaknesses()), Causes{"blur"});
}

// --- Everything: a drop that no image shows, so that only coverage and grain can be told.

Causes causes_of_walk(int frames, double degrees, double noise) {
  const core::Mesh mesh = drop(1, Eigen::Vector3d::Zero());
  capture::Session session;
  session.camera = capture::test::make_camera(160, 120, false);
  CaptureEvidence evidence(session, mesh, mesh, std::nullopt);
  cv::theRNG().state = 1;
  for (int i = 0; i < frames; ++i) {
    capture::Frame frame;
    frame.index = i;
    frame.image = cv::Mat(120, 160, CV_8UC3);
    cv::randn(frame.image, cv::Scalar::all(128), cv::Scalar::all(noise));
    const double azimuth = degrees / 180 * std::numbers::pi * i / frames;
    const Eigen::Isometry3d pose = look_at_board(0.3, 0.8, azimuth);
    const core::VertexView view;
    const core::SampleBatch samples;
    evidence.look_at(frame, pose, {i, frame.image, session.camera, pose, view, samples});
  }
  return causes(evidence.findings());
}

// 24 frames over 360 degrees leave gaps of 15; over 180 degrees the gap is the other half and 7.5.
// --- Tags: the ids of board.yaml against those of the print.

TagEvidence tags_of(const capture::Board& printed, const capture::Board& told) {
  const core::CameraModel camera = capture::test::make_camera(480, 360, false);
  TagEvidence evidence(told, camera);
  for (int i = 0; i < 3; ++i) {
    capture::Frame frame;
    frame.image = capture::test::render_board(printed, camera, look_at_board(0.3, 1, 0.8 * i),
                                              {.supersampling = 2});
    for (int k = 0; k < kLookedAt; ++k) evidence.look_at(frame);
  }
  return evidence;
}

capture::Board with_ids(const capture::Board& board, const std::function<int(int)>& id_of) {
  capture::Board other = board;
  other.tags.clear();
  for (const auto& [id, tag] : board.tags) other.tags[id_of(id)] = tag;
  return other;
}

TEST(TagEvidence, IdsThatAreShiftedAreAFault) {
  const auto board = capture::test::make_grid_board("tag36h11", 5, 4, 0.03, 0.04);
  EXPECT_FALSE(tags_of(board, board).fault());
  EXPECT_TRUE(tags_of(board, board).findings(true).empty());
  for (const int shift : {-1, 1, 7}) {
    const auto shifted = with_ids(board, [=](int id) { return id + 10 + shift; });
    const auto fault = tags_of(with_ids(board, [](int id) { return id + 10; }), shifted).fault();
    ASSERT_TRUE(fault) << shift;
    EXPECT_NE(
        fault->fault.find(std::to_string(std::abs(shift)) + (shift > 0 ? " too high" : " too low")),
        std::string::npos)
        << fault->fault;
  }
}

// Two tags exchanged: the others carry the pose.
TEST(TagEvidence, TagsThatLieElsewhereAreNamed) {
  const auto board = capture::test::make_grid_board("tag36h11", 5, 4, 0.03, 0.04);
  const auto exchanged = with_ids(board, [](int id) { return id == 3 ? 16 : id == 16 ? 3 : id; });
  const auto evidence = tags_of(board, exchanged);
  EXPECT_FALSE(evidence.fault());
  const auto findings = evidence.findings(true);
  ASSERT_EQ(causes(findings), Causes{"tag-places"});
  EXPECT_NE(findings[0].line.find("tags 3, 16 do not"), std::string::npos);
}

// Of twenty tags in view board.yaml holds a few: said where these are fewer, else where the object
// is not where it should be.
TEST(TagEvidence, TagsThatTheBoardDoesNotHoldAreSaid) {
  const auto print = capture::test::make_grid_board("tag36h11", 5, 4, 0.03, 0.04);
  for (const int held : {5, 15}) {
    auto board = print;
    std::erase_if(board.tags, [=](const auto& tag) { return tag.first >= held; });
    const auto evidence = tags_of(print, board);
    EXPECT_FALSE(evidence.fault());
    EXPECT_EQ(causes(evidence.findings(false)), held < 10 ? Causes{"unknown-tags"} : Causes{});
    EXPECT_EQ(causes(evidence.findings(true)), Causes{"unknown-tags"});
  }
}

TEST(CaptureEvidence, OneSideAndFewFramesAreSaid) {
  EXPECT_EQ(causes_of_walk(24, 360, 1), Causes{});
  EXPECT_EQ(causes_of_walk(24, 180, 1), Causes{"one-side"});
  EXPECT_EQ(causes_of_walk(11, 360, 1), Causes{"few-frames"});
}

// Noise of 15 levels is more than the 10 that are said, noise of 6 is less.
TEST(CaptureEvidence, GrainIsMeasured) {
  EXPECT_EQ(causes_of_walk(24, 360, 6), Causes{});
  EXPECT_EQ(causes_of_walk(24, 360, 15), Causes{"noise"});
}

}  // namespace
}  // namespace sheen::pipeline
