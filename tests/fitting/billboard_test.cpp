// SPDX-License-Identifier: MIT
// The laws of billboards (docs/systems.md).
#include "core/samples/vertex_view.h"
#include "fitting/billboard/bake.h"
#include "fitting/billboard/billboards.h"
#include "fitting/billboard/directions.h"
#include "fitting/descriptor.h"
#include "fitting/model_file/model_part.h"
#include "render/billboard/bake_drawn.h"
#include "render/billboard/billboard_renderer.h"
#include "render/billboard/draw_frames.h"
#include "render/surface/surface_renderer.h"
#include "tests/fitting/photographs_for_tests.h"
#include "tests/render/drawing_time.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sheen::fitting::billboard {
namespace {

using render::testing::looking_at_origin;

constexpr int kSide_px = 128;

/// Grey that follows the surface.
mean::MeanLightField printed(const core::Mesh& mesh) {
  mean::MeanLightField light_field(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Eigen::Vector3f wave = (70.0f * mesh.positions[i]).array().sin();
    const float grey = 0.5f + 0.2f * wave.x() * wave.y() + 0.2f * mesh.normals[i].z();
    light_field.store(i, Eigen::Vector3f::Constant(grey), true);
  }
  return light_field;
}

/// A pinhole of this field of view whose object is at a distance from the sphere's centre.
core::CameraModel pinhole(double field_of_view_deg, int side_px) {
  core::CameraModel::Intrinsics in;
  in.width_px = in.height_px = side_px;
  const double half = side_px / 2.0;
  in.focal_px.setConstant(half / std::tan(field_of_view_deg / 2 * M_PI / 180));
  in.principal_px.setConstant(half - 0.5);
  return core::CameraModel(in);
}

/// Looks at the centre from `camera`'s direction, with its axes; x right, y down, z forward.
Eigen::Isometry3d pose_at(const FrameCamera& camera, double distance_m) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear().row(0) = camera.axes.row(0).cast<double>();
  pose.linear().row(1) = -camera.axes.row(1).cast<double>();
  pose.linear().row(2) = -camera.axes.row(2).cast<double>();
  pose.translation() = -(pose.linear() * camera.centre.cast<double>());
  pose.translation().z() += distance_m;
  return pose;
}

/// A knot, hard outlines, and frames of it.
class Knot {
 public:
  [[nodiscard]] const core::Mesh& mesh() const { return mesh_; }
  [[nodiscard]] const Sphere& sphere() const { return sphere_; }

  [[nodiscard]] render::PlacedFrame frame(const Eigen::Vector3f& direction, double field_deg,
                                          float share = 1.0f) const {
    const FrameCamera camera = frame_camera(sphere_, direction, field_deg, kSide_px);
    FrameBaker baker(mesh_, frames_, look_, 1);
    return {std::make_shared<render::FramePyramid>(baker.bake(camera), kSide_px), camera, share};
  }

  /// Mean absolute difference, over the box of what either shows, of a frame seen from its own
  /// direction at a distance, in radii, and the mesh.
  [[nodiscard]] double error(const render::PlacedFrame& frame, double distance_radii) const {
    const double half_angle_deg = std::asin(1 / distance_radii) * 180 / M_PI;
    return error(frame, distance_radii, pinhole(2 * half_angle_deg, kSide_px), Blending::nearest);
  }
  [[nodiscard]] double error(const render::PlacedFrame& frame, double distance_radii,
                             const core::CameraModel& viewer, Blending blending) const {
    const auto pose = pose_at(frame.camera, distance_radii * static_cast<double>(sphere_.radius_m));
    render::PixelRays rays(1);
    rays.set_camera(viewer);
    const cv::Mat drawn =
        render::draw_frames(std::span(&frame, 1), blending, viewer, pose, rays, 1).colour;
    const auto truth = reference_->render(viewer, pose);
    cv::Mat image;
    cv::mixChannels(std::vector<cv::Mat>{drawn},
                    std::vector<cv::Mat>{image = cv::Mat(drawn.size(), CV_32FC3)},
                    {0, 0, 1, 1, 2, 2});
    cv::Mat exact;
    truth.image.convertTo(exact, CV_32FC3);
    return cv::norm(image, exact, cv::NORM_L1) / (3.0 * cv::countNonZero(truth.mask));
  }

 private:
  core::Mesh mesh_ = render::testing::torus_knot(0.2f, 240, 24);
  std::vector<core::TangentFrame> frames_ = core::tangent_frames(mesh_);
  mean::MeanLightField look_ = printed(mesh_);
  Sphere sphere_ = bounding_sphere(mesh_);
  std::unique_ptr<render::Renderer> reference_ =
      render::make_reference_surface_renderer(mesh_, look_, 1);
};

// 5120 triangles of 4 pi / 5120 square radians are 2.7 degrees across, equal-sided: the farthest
// point of one from its centroid is side / sqrt(3), 2.5 degrees at the largest.
TEST(BillboardDirections, AreTheTrianglesOfAnIcosahedronCutIntoFour) {
  for (const int count : kDirectionCounts) {
    const auto all = directions(count);
    ASSERT_EQ(all.size(), static_cast<std::size_t>(count));
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const auto& direction : all) sum += direction;
    EXPECT_LT(sum.norm() / static_cast<float>(count), 1e-5f);
  }
  const auto all = directions(5120);
  double greatest_deg = 0;
  for (int i = 0; i < 500; ++i) {
    const double z = -1 + (2 * i + 1) / 500.0;
    const Eigen::Vector3d point(std::sqrt(1 - z * z) * std::cos(2.4 * i),
                                std::sqrt(1 - z * z) * std::sin(2.4 * i), z);
    const auto nearest = std::ranges::max_element(
        all, {}, [&](const auto& direction) { return direction.dot(point.cast<float>()); });
    greatest_deg =
        std::max(greatest_deg, std::acos(nearest->cast<double>().dot(point)) * 180 / M_PI);
  }
  EXPECT_LT(greatest_deg, 2.7);  // the paper: 5.5
}

// The sphere of a cube's corners is known; nothing lies outside of any.
TEST(BillboardSphere, HoldsTheMeshAndIsSmall) {
  core::Mesh cube;
  for (int i = 0; i < 8; ++i) {
    cube.positions.emplace_back(i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 4.0f : 2.0f);
  }
  cube.triangles = {{0, 1, 2}, {3, 4, 5}, {5, 6, 7}};
  const Sphere sphere = bounding_sphere(cube);
  EXPECT_LT(sphere.radius_m, 1.01f * std::sqrt(3.0f));
  for (const auto& corner : cube.positions) {
    EXPECT_LE((corner - sphere.centre).norm(), sphere.radius_m);
  }
}

// A sphere fits exactly: from b = r / sin(a) its outline is tangent to the image's sides.
TEST(FrameCamera, HoldsTheSphereExactly) {
  const Sphere sphere{{0.1f, -0.2f, 0.3f}, 0.5f};
  for (const double field_deg : {0.0, 40.0, 90.0}) {
    const auto camera =
        frame_camera(sphere, Eigen::Vector3f(1, 2, -2).normalized(), field_deg, 100);
    float rightmost = 0;
    for (int i = 0; i < 3600; ++i) {
      const float angle = static_cast<float>(i) * static_cast<float>(M_PI) / 3600;
      rightmost = std::max(
          rightmost, camera.pixel({0.5f * std::sin(angle), 0.0f, 0.5f * std::cos(angle)}).x());
    }
    EXPECT_NEAR(rightmost, 99.5f, 1e-2f) << field_deg;
  }
}

// A frame baked where the viewer stands is what he sees: his pixels are its pixels.
TEST(Billboard, PerspectiveIsExactWhereItWasBaked) {
  const Knot knot;
  for (const double field_deg : {40.0, 90.0}) {
    const auto frame = knot.frame(Eigen::Vector3f(0.6f, -0.5f, 0.62f).normalized(), field_deg);
    const double baked_at = 1 / std::sin(field_deg / 2 * M_PI / 180);
    EXPECT_LT(knot.error(frame, baked_at), 1.0) << field_deg;
    EXPECT_GT(knot.error(frame, 4 * baked_at), 5.0) << field_deg;
  }
}

// Parallax is proportional to |1 / D - 1 / b|, 1 / b = 0 for the orthographic frame: both are equal
// at D = 2 b, in first order. It is between 1.7 b and 2.3 b.
TEST(Billboard, OrthographicWinsBeyondTwiceTheDistanceOfThePerspectiveCamera) {
  const Knot knot;
  const Eigen::Vector3f direction = Eigen::Vector3f(0.6f, -0.5f, 0.62f).normalized();
  const double baked_at = 4;
  const auto orthographic = knot.frame(direction, 0);
  const auto perspective = knot.frame(direction, 2 * std::asin(1 / baked_at) * 180 / M_PI);
  const auto gain = [&](double distance) {
    return knot.error(perspective, distance) / knot.error(orthographic, distance);
  };
  EXPECT_LT(gain(1.7 * baked_at), 1.0);
  EXPECT_GT(gain(2.3 * baked_at), 1.0);
}

// Depth undoes the parallax of a frame seen from elsewhere.
TEST(Billboard, DepthMovesPixelsWhereTheyBelong) {
  const Knot knot;
  const auto frame = knot.frame(Eigen::Vector3f(0.6f, -0.5f, 0.62f).normalized(), 0);
  const auto viewer = pinhole(60, kSide_px);
  const double flat = knot.error(frame, 2, viewer, Blending::nearest);
  const double deep = knot.error(frame, 2, viewer, Blending::blended);
  EXPECT_LT(deep, 0.5 * flat);
}

// Shares add up to 1, give a direction itself everything, and change little for a small step.
TEST(Billboard, SharesOfFramesHaveNoJumps) {
  const auto all = directions(320);
  const std::vector<std::uint8_t> usable(all.size(), 1);
  const auto at = [&](const Eigen::Vector3f& towards) {
    std::vector<float> share(all.size(), 0.0f);
    for (const auto& one : render::frames_around(all, usable, towards)) {
      share[one.frame_idx] = one.share;
    }
    return share;
  };
  const auto itself = at(3.0f * all[17]);
  EXPECT_GT(itself[17], 0.98f);
  auto before = at({1, 0, 0.3f});
  float greatest = 0;
  constexpr int steps = 2000;
  for (int i = 1; i <= steps; ++i) {
    const float angle = 2 * static_cast<float>(M_PI) * static_cast<float>(i) / steps;
    const auto now = at({std::cos(angle), std::sin(angle), 0.3f});
    float sum = 0;
    for (std::size_t k = 0; k < now.size(); ++k) {
      sum += now[k];
      greatest = std::max(greatest, std::abs(now[k] - before[k]));
    }
    ASSERT_NEAR(sum, 1.0f, 1e-5f);
    before = now;
  }
  // A step is .18 degrees, neighbours are 10 apart: a share goes from 0 to 1 in some fifty steps.
  EXPECT_LT(greatest, 0.06f);
}

// Before the end there are frames where views were, and only there.
TEST(BillboardFitter, ShowsFramesAsViewsCome) {
  const testing::Photographs photographs(
      render::testing::sphere(0.1f, 8), 3,
      [](const auto&, const auto&) { return Eigen::Vector3f(0.8f, 0.4f, 0.2f); });
  const auto fitter = make_fitter("billboard", photographs.mesh(),
                                  {{"directions", "80"}, {"billboard-size", "32"}});
  photographs.show({0, 1, 2}, *fitter);
  const auto& model = dynamic_cast<const Billboards&>(fitter->light_field());
  const auto baked = [&] {
    std::size_t count = 0;
    for (std::size_t i = 0; i < model.element_count(); ++i) {
      count += model.frame(i).crop.empty() ? 0u : 1u;
    }
    return count;
  };
  EXPECT_EQ(baked(), 3u);
  fitter->finish();
  EXPECT_EQ(baked(), 80u);
}

// What is baked of finished patches is what the fitter of billboards bakes of the same ones.
TEST(BakedBillboards, AreThoseOfTheFitter) {
  const testing::Photographs photographs(
      render::testing::sphere(0.1f, 8), 4, [](const auto& point, const auto& towards_viewer) {
        return Eigen::Vector3f(0.5f + 3 * point.x(), 0.4f, 0.5f + 0.3f * towards_viewer.z());
      });
  const auto fitter = make_fitter("billboard", photographs.mesh(),
                                  {{"directions", "20"}, {"billboard-size", "32"}});
  const auto patches = make_fitter("sparse", photographs.mesh());
  for (Fitter* const one : {fitter.get(), patches.get()}) {
    photographs.show({0, 1, 2, 3}, *one);
    one->finish();
  }
  const auto& expected = dynamic_cast<const Billboards&>(fitter->light_field());
  Billboards baked(expected.options(), expected.sphere(), photographs.mesh().positions.size());
  bake_all(photographs.mesh(), core::tangent_frames(photographs.mesh()),
           require_patches(patches->light_field(), "this test"), 2, baked);
  for (std::size_t i = 0; i < baked.element_count(); ++i) {
    EXPECT_EQ(baked.frame(i).crop, expected.frame(i).crop);
    EXPECT_EQ(baked.frame(i).colour, expected.frame(i).colour);
    EXPECT_EQ(baked.frame(i).shape, expected.frame(i).shape);
  }
  EXPECT_TRUE(std::ranges::equal(baked.means().coefficients(), expected.means().coefficients()));
}

void split(const cv::Mat& shape, cv::Mat& coverage, cv::Mat& depth, cv::Mat& support) {
  cv::extractChannel(shape, coverage, 0);
  cv::extractChannel(shape, depth, 1);
  cv::extractChannel(shape, support, 2);
}

// The same patches, evaluated for every frame or drawn by a renderer that might draw anything: the
// same shapes, and colours that differ by what a thousandth of the radius, .03 pixels, moves; so at
// the outline the renderer may see nothing where the frame sees a corner. Frames with a field of
// view are drawn from where they are.
TEST(BakedBillboards, OfWhatIsDrawnAreThoseOfPatches) {
  const auto mesh = render::testing::torus_knot(0.2f, 240, 24);
  const auto look = printed(mesh);
  const auto renderer = render::make_reference_surface_renderer(mesh, look, 1);
  for (const double field_deg : {0.0, 40.0}) {
    Options options;
    options.directions = 20;
    options.side_px = kSide_px;
    options.field_of_view_deg = field_deg;
    Billboards patches(options, bounding_sphere(mesh), mesh.positions.size());
    Billboards drawn = patches;
    bake_all(mesh, core::tangent_frames(mesh), look, 1, patches);
    render::bake_drawn(mesh, look, *renderer, drawn);
    double sum = 0;
    for (std::size_t i = 0; i < patches.element_count(); ++i) {
      const FrameImage a = decode(patches.frame(i));
      const FrameImage b = decode(drawn.frame(i));
      ASSERT_EQ(a.crop, b.crop);
      cv::Mat coverage, depth, support, drawn_coverage, drawn_depth, drawn_support;
      split(a.shape, coverage, depth, support);
      split(b.shape, drawn_coverage, drawn_depth, drawn_support);
      ASSERT_EQ(cv::norm(coverage, drawn_coverage, cv::NORM_INF), 0);
      ASSERT_EQ(cv::norm(depth, drawn_depth, cv::NORM_INF), 0);
      ASSERT_EQ(cv::countNonZero((support != drawn_support) & (coverage == 255)), 0);
      sum +=
          cv::norm(a.colour, b.colour, cv::NORM_L1) / (3.0 * static_cast<double>(a.colour.total()));
    }
    const double mean = sum / static_cast<double>(patches.element_count());
    std::printf("%g degrees: mean difference %.3f grey levels\n", field_deg, mean);
    // Two JPEGs differ by .33, measured at 40 degrees; .03 pixels of this print come to .4 more.
    EXPECT_LT(mean, field_deg > 0 ? 0.7 : 1.4) << field_deg;
  }
}

/// Eighty frames of a coarser knot, and their options.
Billboards baked_knot(Blending blending, double field_deg) {
  const auto mesh = render::testing::torus_knot(0.2f, 160, 20);
  Options options;
  options.directions = 80;
  options.side_px = 96;
  options.field_of_view_deg = field_deg;
  options.blending = blending;
  Billboards billboards(options, bounding_sphere(mesh), mesh.positions.size());
  bake_all(mesh, core::tangent_frames(mesh), printed(mesh), 1, billboards);
  return billboards;
}

// Both do the same arithmetic in single precision: places in frames differ by some 1e-5 pixels.
// Colours then differ by rounding. A ray looks up to 16 depths of each of some five frames, at the
// nearest pixel: with 2e-5 for each it is another one for 2e-3 of the pixels, which shows where
// depths jump there, for about a twentieth: 1e-4. Measured: none.
TEST(Billboard, OpenGlDrawsTheCpusImage) {
  const auto context = render::make_osmesa_context();
  for (const Blending blending : {Blending::nearest, Blending::blended}) {
    const auto billboards = baked_knot(blending, blending == Blending::nearest ? 0 : 40);
    const auto cpu = render::make_cpu_billboard_renderer(billboards, 1);
    const auto gl = render::make_gl_billboard_renderer(*context, billboards,
                                                       {Eigen::Isometry3d::Identity()}, 1);
    const std::string name = blending == Blending::nearest ? "nearest" : "blended";
    // Larger than the frames, and as their second and third level have it.
    for (const double distance_m : {0.36, 3.0}) {
      const auto camera = render::testing::distorted_camera(320, 240);
      const auto pose = looking_at_origin({0.5, -0.6, 0.4}, distance_m);
      const auto expected = cpu->render(camera, pose);
      const auto drawn = gl->render(camera, pose);
      const int pixels = cv::countNonZero(expected.mask);
      cv::Mat beside;
      cv::absdiff(expected.image, drawn.image, beside);
      EXPECT_GT(pixels, distance_m < 1 ? 20000 : 250);
      EXPECT_LE(cv::countNonZero(expected.mask != drawn.mask), 3e-4 * pixels);
      EXPECT_LE(cv::countNonZero(expected.support != drawn.support), 3e-4 * pixels);
      EXPECT_LE(cv::countNonZero(beside.reshape(1) > 1), 3e-4 * pixels);
      if (distance_m > 1) continue;
      RecordProperty(name + "_cpu_ms", std::to_string(tests::drawing_cpu_ms(*cpu, camera, pose)));
      RecordProperty(name + "_osmesa_ms", std::to_string(tests::drawing_cpu_ms(*gl, camera, pose)));
    }
  }
}

// What stands in front hides what is behind, whichever is listed first, and what is behind the
// camera is not seen; what a rigid motion moves with the camera looks the same.
TEST(Billboard, NearerCopiesHideOthers) {
  const auto context = render::make_osmesa_context();
  const auto billboards = baked_knot(Blending::blended, 0);
  const auto camera = render::testing::plain_camera(320, 240);
  const auto draw = [&](const Eigen::Isometry3d& camera_from_scene,
                        const std::vector<Eigen::Isometry3d>& places) {
    return render::make_gl_billboard_renderer(*context, billboards, places, 1)
        ->render(camera, camera_from_scene);
  };
  const auto pose = looking_at_origin({1, 0, 0}, 0.5);
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();
  const Eigen::Isometry3d behind_it(Eigen::Translation3d(-0.4, 0, 0));
  const Eigen::Isometry3d behind_us(Eigen::Translation3d(1.2, 0, 0));
  const auto alone = draw(pose, {here});
  EXPECT_GT(cv::countNonZero(alone.mask), 5000);
  for (const auto& order :
       {std::vector{here, behind_it, behind_us}, {behind_it, behind_us, here}}) {
    const auto drawn = draw(pose, order);
    EXPECT_EQ(render::testing::difference(drawn.image, alone.image, alone.mask).largest, 0);
    EXPECT_GT(cv::countNonZero(drawn.mask), cv::countNonZero(alone.mask));  // through its holes
  }
  const Eigen::Isometry3d moved =
      Eigen::Translation3d(3, 1, -2) * Eigen::AngleAxisd(1, Eigen::Vector3d(0, 0.6, 0.8));
  const auto elsewhere = draw(pose * moved.inverse(), {moved});
  EXPECT_LT(render::testing::difference(elsewhere.image, alone.image, alone.mask).mean, 0.2);
  EXPECT_EQ(cv::countNonZero(draw(pose, {}).mask), 0);
}

// Records that no fit writes.
TEST(BillboardFile, AlteredPartsAreRefused) {
  const testing::Photographs photographs(
      render::testing::sphere(0.1f, 8), 2,
      [](const auto&, const auto&) { return Eigen::Vector3f(0.8f, 0.4f, 0.2f); });
  const auto fitter = make_fitter("billboard", photographs.mesh(),
                                  {{"directions", "20"}, {"billboard-size", "32"}});
  photographs.show({0, 1}, *fitter);
  fitter->finish();
  const auto& descriptor = representation_named("billboard");
  const ModelPart good = descriptor.encode(fitter->light_field());
  const auto refuses = [&](const char* name, const nlohmann::json& value) {
    ModelPart part = good;
    part.parameters[name] = value;
    EXPECT_THROW(descriptor.decode(part, photographs.mesh()), ModelFault) << name;
  };
  refuses("directions", 21);
  refuses("directions", std::uint64_t{1} << 50);
  refuses("size", 8);
  refuses("fieldOfView", 180.0);
  refuses("fieldOfView", "wide");
  refuses("blending", "none");
  refuses("centre", {0.0, 0.0});
  refuses("centre", {0.0, 0.0, "x"});
  refuses("radius", 0.0);
  refuses("radius", 1e300);
  for (std::size_t field = 0; field < 6; ++field) {
    std::vector<std::byte> crops(good.arrays.at("crops").begin(), good.arrays.at("crops").end());
    crops[4 * field + 2] = std::byte{1};
    ModelPart part = good;
    part.arrays["crops"] = crops;
    EXPECT_THROW(descriptor.decode(part, photographs.mesh()), ModelFault) << field;
  }
}

}  // namespace
}  // namespace sheen::fitting::billboard
