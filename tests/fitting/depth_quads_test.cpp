// SPDX-License-Identifier: MIT
// The laws of quads from depth maps (docs/systems.md).
#include "fitting/depth_quads/depth_quads.h"

#include "core/visibility/ray_caster.h"
#include "fitting/descriptor.h"
#include "render/depth_quads/camera_choice.h"
#include "render/depth_quads/quad_renderer.h"
#include "render/views/crop_reader.h"
#include "render/views/ray_grid.h"
#include "render/views/view_cache.h"
#include "tests/fitting/photographs_for_tests.h"
#include "tests/render/drawing_time.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <random>

namespace sheen::fitting::depth_quads {
namespace {

using render::testing::looking_at_origin;
using testing::Photographs;

/// A pattern of about eight pixels, the same from everywhere.
Eigen::Vector3f printed(const Eigen::Vector3f& point, const Eigen::Vector3f& /*towards_viewer*/) {
  const Eigen::Vector3f wave = (150.0f * point).array().sin();
  return Eigen::Vector3f(0.5f + 0.3f * wave.x() * wave.y(), 0.5f + 0.3f * wave.y(),
                         0.5f + 0.3f * wave.z() * wave.x());
}

/// From the side, so many degrees round.
Eigen::Isometry3d pose_at(double azimuth_deg) {
  const double angle = azimuth_deg * M_PI / 180;
  return looking_at_origin({std::cos(angle), std::sin(angle), 0.7}, 0.36);
}

std::vector<Eigen::Isometry3d> poses_at(const std::vector<double>& azimuths_deg) {
  std::vector<Eigen::Isometry3d> poses;
  for (const double azimuth : azimuths_deg) poses.push_back(pose_at(azimuth));
  return poses;
}

/// The same without colour, whose resolution a JPEG halves.
Eigen::Vector3f printed_grey(const Eigen::Vector3f& point, const Eigen::Vector3f& towards_viewer) {
  return Eigen::Vector3f::Constant(printed(point, towards_viewer).x());
}

/// A knot, which hides much of itself, from these sides; the first is for comparison.
Photographs knot_from(const std::vector<double>& azimuths_deg,
                      const testing::Look& look = printed) {
  return {render::testing::torus_knot(0.2f, 160, 20), poses_at(azimuths_deg), look};
}

/// Of all photographs but the first.
DepthQuads fitted(const Photographs& photographs, OptionValues values) {
  values["image-quality"] = "100";
  const auto fitter = make_fitter("depth-quads", photographs.mesh(), values);
  for (int i = 1; i < static_cast<int>(photographs.views().size()); ++i) {
    photographs.show({i}, *fitter);
  }
  fitter->finish();
  return dynamic_cast<const DepthQuads&>(fitter->light_field());
}

/// Depth of the mesh along the optical axis of a view, 0 where it is not seen.
cv::Mat depth_of(const Photographs& photographs, int view) {
  const auto& pose = photographs.views()[static_cast<std::size_t>(view)].camera_from_object;
  const core::RayCaster caster(photographs.mesh());
  cv::Mat depth(photographs.camera().height_px(), photographs.camera().width_px(), CV_32FC1,
                cv::Scalar(0));
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      const Eigen::Vector3d ray =
          pose.linear().transpose() * *photographs.camera().unproject({x, y});
      const auto hit = caster.first_hit(core::eye_in_object(pose), ray.cast<float>(), 0,
                                        std::numeric_limits<float>::infinity());
      if (hit) depth.at<float>(y, x) = hit->distance;
    }
  }
  return depth;
}

/// Where the object is seen, two pixels within its outline.
cv::Mat interior(const cv::Mat& depth) {
  cv::Mat inside;
  cv::erode(depth > 0.0f, inside, cv::getStructuringElement(cv::MORPH_RECT, {5, 5}));
  return inside;
}

/// Within three pixels of a jump of depth, but within the interior.
cv::Mat edge_band(const cv::Mat& depth) {
  const cv::Mat square = cv::getStructuringElement(cv::MORPH_RECT, {7, 7});
  cv::Mat nearest, farthest;
  cv::erode(depth, nearest, square);
  cv::dilate(depth, farthest, square);
  return (farthest - nearest > 0.02f) & interior(depth);
}

struct Drawn {
  double mad;    ///< mean absolute difference, grey levels; holes are black
  double holes;  ///< part of the interior
};

Drawn compare(const cv::Mat& image, const cv::Mat& covered, const cv::Mat& truth,
              const cv::Mat& mask) {
  const double pixels = cv::countNonZero(mask);
  return {render::testing::difference(image, truth, mask).mean,
          cv::countNonZero(mask & ~covered) / pixels};
}

/// Figures of docs/systems.md: `depth_quads_test --gtest_output=json:laws.json` writes them.
void note(const std::string& name, double value) {
  ::testing::Test::RecordProperty(name, std::to_string(value));
}

/// The first view, drawn from the others.
Drawn draw(const Photographs& photographs, const DepthQuads& quads, const cv::Mat& mask) {
  const auto renderer = render::make_cpu_quad_renderer(quads, 1);
  const auto& [truth, pose] = photographs.views().front();
  const auto view = renderer->render(photographs.camera(), pose);
  return compare(view.image, view.mask, truth, mask);
}

// The spacings and counts of the paper's 768 x 512 photographs, borders covered (docs/systems.md).
TEST(DepthQuads, LevelsHaveTheCountsOfTheirSpacings) {
  const auto levels = quad_levels({768, 512}, 3, 4);
  const int spacings[] = {3, 7, 15, 31};
  const std::size_t counts[] = {256 * 171, 110 * 74, 52 * 35, 25 * 17};
  ASSERT_EQ(levels.size(), 4u);
  for (std::size_t l = 0; l < 4; ++l) {
    EXPECT_EQ(levels[l].spacing_px, spacings[l]);
    EXPECT_EQ(levels[l].size(), counts[l]);
  }
}

// A plane with a pole of one pixel and one flier: the filter takes the flier and leaves the pole,
// since a quad stands where the middle of a cell has a depth.
TEST(DepthQuads, MedianRemovesFliersNotDepths) {
  cv::Mat depth(9, 9, CV_32FC1, cv::Scalar(2.0f));
  depth.at<float>(4, 4) = 1.0f;
  const auto levels = quad_levels(depth.size(), 1, 1);
  const auto at_middle = [&](const cv::Mat& image, int median) {
    const QuadDepths depths = quad_depths(image, levels, median);
    return depths.depth_m(depths.codes[4 * 9 + 4]);
  };
  EXPECT_EQ(at_middle(depth, 1), 1.0f);
  EXPECT_EQ(at_middle(depth, 3), 2.0f);
  cv::Mat pole(9, 9, CV_32FC1, cv::Scalar(0.0f));
  pole.col(4).setTo(1.5f);
  EXPECT_EQ(at_middle(pole, 3), 1.5f);
}

/// The quads of a knot from one side, fitted with this depth image.
QuadDepths quads_with(const Photographs& photographs, const cv::Mat& depth_m) {
  const auto fitter =
      make_fitter("depth-quads", photographs.mesh(), {{"spacing", "1"}, {"median", "3"}});
  photographs.observe({0}, [&](const core::Observation& observation) {
    core::Observation measured = observation;
    measured.depth_m = depth_m;
    fitter->integrate(measured);
  });
  return dynamic_cast<const DepthQuads&>(fitter->light_field()).quads(0).depths;
}

// Depths of the z-buffer, rounded to millimetres as a file has them, are within half of one; a
// median of rounded numbers is the rounded median; the nearest and farthest, from which codes are
// counted, are rounded, too. Each code is off by half a step at most.
TEST(DepthQuads, MeasuredDepthsAreTheMeshesWithinTheirSteps) {
  const auto photographs = knot_from({0});
  core::DepthImage buffer(photographs.mesh(), 1);
  cv::Mat depth_m(photographs.camera().height_px(), photographs.camera().width_px(), CV_32FC1,
                  cv::Scalar(0));
  photographs.observe({0}, [&](const core::Observation& observation) {
    buffer.draw(observation.view, depth_m.size(), observation.camera_from_object);
    buffer.depth_m().copyTo(depth_m(buffer.box()));
  });
  const QuadDepths exact = quads_with(photographs, {});
  cv::Mat rounded = depth_m.clone();
  constexpr float unit_m = 0.001f;
  for (float& depth : cv::Mat_<float>(rounded)) depth = unit_m * std::round(depth / unit_m);
  const QuadDepths measured = quads_with(photographs, rounded);
  ASSERT_EQ(exact.codes.size(), measured.codes.size());
  const float step_m =
      std::max(exact.farthest_m - exact.nearest_m, measured.farthest_m - measured.nearest_m) /
      65534;
  std::size_t quads = 0;
  for (std::size_t i = 0; i < exact.codes.size(); ++i) {
    ASSERT_EQ(exact.codes[i] == 0, measured.codes[i] == 0);
    if (exact.codes[i] == 0) continue;
    ++quads;
    ASSERT_NEAR(exact.depth_m(exact.codes[i]), measured.depth_m(measured.codes[i]),
                unit_m / 2 + step_m + 1e-6f);
  }
  EXPECT_GT(quads, 1000u);
}

// Where nothing was measured there is no quad; nor where something in front of the object was, or
// behind it; and none beside the object.
TEST(DepthQuads, MeasuredDepthsMayHaveHoles) {
  const auto photographs = knot_from({0});
  const QuadDepths all = quads_with(photographs, {});
  const auto count = [&](const cv::Mat& depth_m) {
    const QuadDepths depths = quads_with(photographs, depth_m);
    return std::ranges::count_if(depths.codes, [](auto code) { return code != 0; });
  };
  const cv::Size size(photographs.camera().width_px(), photographs.camera().height_px());
  const float middle_m = 0.5f * (all.nearest_m + all.farthest_m);
  cv::Mat flat(size, CV_32FC1, cv::Scalar(middle_m));
  const auto whole = std::ranges::count_if(all.codes, [](auto code) { return code != 0; });
  EXPECT_EQ(count(flat), whole);
  flat.colRange(0, size.width / 2).setTo(0);
  const auto half = count(flat);
  EXPECT_GT(half, whole / 4);
  EXPECT_LT(half, 3 * whole / 4);
  flat.colRange(0, size.width / 4).setTo(0.1f * middle_m);
  flat.colRange(size.width / 4, size.width / 2).setTo(10 * middle_m);
  EXPECT_EQ(count(flat), half);
}

// At spacing 1 every pixel is a quad at its own depth: back in its own camera it covers that pixel,
// and only rounding and the JPEG are left.
TEST(DepthQuads, PhotographsAreTheirOwnViews) {
  const auto photographs = knot_from({0, 0}, printed_grey);
  for (const char* const blending : {"hard", "weighted"}) {
    const auto quads =
        fitted(photographs,
               {{"spacing", "1"}, {"levels", "1"}, {"median", "1"}, {"quad-blending", blending}});
    const auto drawn = draw(photographs, quads, interior(depth_of(photographs, 0)));
    EXPECT_LT(drawn.mad, 1.0);
    EXPECT_EQ(drawn.holes, 0);
  }
}

TEST(DepthQuads, ErrorRisesWithTheSpacing) {
  const auto photographs = knot_from({0, -6, 6});
  const cv::Mat mask = interior(depth_of(photographs, 0));
  double previous = 0;
  for (const char* const spacing : {"1", "3", "7", "15"}) {
    const auto quads =
        fitted(photographs, {{"spacing", spacing}, {"levels", "1"}, {"quad-blending", "hard"}});
    const auto drawn = draw(photographs, quads, mask);
    note(std::string("mad_at_spacing_") + spacing, drawn.mad);
    EXPECT_GT(drawn.mad, previous);
    previous = drawn.mad;
  }
}

TEST(DepthQuads, TheSecondCameraClosesHoles) {
  const auto photographs = knot_from({0, -12, 12});
  const cv::Mat mask = interior(depth_of(photographs, 0));
  const auto one = draw(photographs, fitted(photographs, {{"cameras", "1"}}), mask);
  const auto two = draw(photographs, fitted(photographs, {{"cameras", "2"}}), mask);
  note("holes_of_one", one.holes);
  note("holes_of_two", two.holes);
  note("mad_of_one", one.mad);
  note("mad_of_two", two.mad);
  EXPECT_GT(one.holes, 0.01);
  EXPECT_LT(two.holes, 0.005);
  EXPECT_LT(two.mad, one.mad);
}

/// A mesh of which every triangle knows the photograph it comes from.
struct ConnectedMesh {
  core::Mesh mesh;
  std::vector<std::size_t> photograph_idx;
};

/// Adds the depths of a photograph as one connected surface with a vertex in the middle of every
/// cell, whatever jumps lie between them.
void add_surface(const DepthQuads& quads, std::size_t photograph_idx, ConnectedMesh& connected) {
  const KeptView& kept = quads.photographs()[photograph_idx];
  const QuadView& view = quads.quads(photograph_idx);
  const auto& level = view.levels.front();
  const auto columns = static_cast<std::size_t>(level.columns);
  const Eigen::Isometry3d object_from_camera = kept.camera_from_object.inverse();
  std::vector<int> vertex(level.size(), -1);
  for (std::size_t cell = 0; cell < vertex.size(); ++cell) {
    const std::uint16_t code = view.depths.codes[cell];
    if (code == 0) continue;
    const int s = level.spacing_px;
    const Eigen::Vector2d pixel(kept.crop.x + static_cast<int>(cell % columns) * s + s / 2,
                                kept.crop.y + static_cast<int>(cell / columns) * s + s / 2);
    const double depth = static_cast<double>(view.depths.depth_m(code));
    vertex[cell] = static_cast<int>(connected.mesh.positions.size());
    connected.mesh.positions.push_back(
        (object_from_camera * (depth * *kept.camera.unproject(pixel))).cast<float>());
  }
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    if (std::min({vertex[a], vertex[b], vertex[c]}) < 0) return;
    connected.mesh.triangles.push_back(
        Eigen::Vector3i(vertex[a], vertex[b], vertex[c]).cast<std::uint32_t>());
    connected.photograph_idx.push_back(photograph_idx);
  };
  for (std::size_t cell = 0; cell + columns + 1 < vertex.size(); ++cell) {
    if (cell % columns + 1 == columns) continue;
    add(cell, cell + columns, cell + 1);
    add(cell + 1, cell + columns, cell + columns + 1);
  }
}

/// The first view of such surfaces, each triangle coloured by its photograph.
cv::Mat draw_connected(const Photographs& photographs, const DepthQuads& quads) {
  ConnectedMesh connected;
  std::vector<cv::Mat> pixels;
  for (std::size_t i = 0; i < quads.element_count(); ++i) {
    add_surface(quads, i, connected);
    pixels.push_back(quads.photographs()[i].pixels());
  }
  const core::RayCaster caster(connected.mesh);
  const auto& [truth, pose] = photographs.views().front();
  const Eigen::Vector3f eye = core::eye_in_object(pose);
  cv::Mat image(truth.size(), CV_8UC3, cv::Scalar::all(0));
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const Eigen::Vector3f ray =
          (pose.linear().transpose() * *photographs.camera().unproject({x, y})).cast<float>();
      const auto hit = caster.first_hit(eye, ray, 0, std::numeric_limits<float>::infinity());
      if (!hit) continue;
      const std::size_t from = connected.photograph_idx[hit->triangle_idx];
      const KeptView& kept = quads.photographs()[from];
      const auto source =
          kept.camera.project(kept.camera_from_object * (eye + hit->distance * ray).cast<double>());
      const Eigen::Vector3f colour =
          render::read_between(pixels[from], static_cast<float>(source->x() - kept.crop.x),
                               static_cast<float>(source->y() - kept.crop.y));
      for (int c = 0; c < 3; ++c) {
        image.at<cv::Vec3b>(y, x)[c] = cv::saturate_cast<std::uint8_t>(colour[c]);
      }
    }
  }
  return image;
}

// From two photographs: a triangle across a jump of depth smears what lies on either side of it and
// hides what the other photograph sees there; quads end at the jump. Measured 1.39 and 1.30 times.
TEST(DepthQuads, BeatAConnectedMeshBesideJumpsOfDepth) {
  const auto photographs = knot_from({0, -6, 6});
  const cv::Mat band = edge_band(depth_of(photographs, 0));
  const cv::Mat& truth = photographs.views().front().image;
  for (const char* const spacing : {"1", "3"}) {
    const auto quads =
        fitted(photographs, {{"quad-blending", "hard"}, {"spacing", spacing}, {"levels", "1"}});
    const double mesh = compare(draw_connected(photographs, quads), band, truth, band).mad;
    const double own = draw(photographs, quads, band).mad;
    note(std::string("mesh_at_spacing_") + spacing, mesh);
    note(std::string("quads_at_spacing_") + spacing, own);
    EXPECT_GT(mesh, 1.2 * own) << spacing;
  }
}

/// The same quads at depths with noise of 0.4 % and one flier in a hundred, of up to a tenth.
DepthQuads with_noise(const DepthQuads& quads, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0, 0.004f);
  std::uniform_real_distribution<float> uniform(0, 1);
  DepthQuads noisy(quads.options(), quads.means().patch_count());
  for (std::size_t i = 0; i < quads.element_count(); ++i) {
    const QuadView& view = quads.quads(i);
    const QuadLevel& level = view.levels.front();
    cv::Mat depth(level.rows, level.columns, CV_32FC1, cv::Scalar(0));
    for (std::size_t cell = 0; cell < level.size(); ++cell) {
      const std::uint16_t code = view.depths.codes[cell];
      if (code == 0) continue;
      const float part = uniform(random) < 0.01f ? 0.2f * uniform(random) - 0.1f : noise(random);
      depth.ptr<float>()[cell] = view.depths.depth_m(code) * (1 + part);
    }
    const auto cells = quad_levels(depth.size(), 1, 1);
    noisy.add(quads.photographs()[i], quad_depths(depth, cells, 1));
  }
  return noisy;
}

// Of many quads about as near as each other, noise decides which is the nearest: the more cameras,
// the more of what is drawn is wrong. A mean does not know that. All cameras are about as far from
// the view, so that their number alone differs.
TEST(DepthQuads, NoisyDepthsSpoilTheNearestQuadNotTheMean) {
  const auto photographs = knot_from({0, -4, 4, -4.5, 4.5, -5, 5});
  const cv::Mat mask = interior(depth_of(photographs, 0));
  const auto mad = [&](const char* blending, const char* cameras) {
    const auto quads =
        fitted(photographs, {{"levels", "1"}, {"cameras", cameras}, {"quad-blending", blending}});
    return draw(photographs, with_noise(quads, 5), mask).mad;
  };
  const double hard[] = {mad("hard", "2"), mad("hard", "4"), mad("hard", "6")};
  const double weighted[] = {mad("weighted", "2"), mad("weighted", "4"), mad("weighted", "6")};
  for (std::size_t i = 0; i < 3; ++i) {
    note("hard_" + std::to_string(2 * i + 2), hard[i]);
    note("weighted_" + std::to_string(2 * i + 2), weighted[i]);
  }
  EXPECT_GT(hard[1], hard[0]);
  EXPECT_GT(hard[2], hard[1]);
  // Measured 3.94, 4.22, 4.51 and 3.45, 3.46, 3.55.
  EXPECT_LE(weighted[1], 1.01 * weighted[0]);
  EXPECT_LT(weighted[2] - weighted[0], 0.25 * (hard[2] - hard[0]));
}

// Of three photographs at 10, 20 and 170 degrees a view at 0 takes the nearest by angle; the
// paper's rank knows only the distance from the axis, but refuses what looks the other way.
TEST(DepthQuads, CamerasAreRanked) {
  const auto photographs = knot_from({0, 20, 170, 10});
  for (const char* const blending : {"hard", "weighted"}) {
    const auto quads = fitted(photographs, {{"quad-blending", blending}, {"cameras", "2"}});
    const auto chosen = render::choose_cameras(quads, photographs.camera(),
                                               photographs.views().front().camera_from_object);
    ASSERT_EQ(chosen.size(), 2u);
    EXPECT_EQ(chosen[0].photograph_idx, 2u);
    EXPECT_EQ(chosen[1].photograph_idx, 0u);
    EXPECT_GE(chosen[0].share, chosen[1].share);
  }
}

/// The photographs' camera with more pixels and a lens that bends by a twentieth at the corners.
core::CameraModel bent(const core::CameraModel& camera, int times) {
  core::CameraModel::Intrinsics in = camera.intrinsics();
  in.width_px *= times;
  in.height_px *= times;
  in.focal_px *= times;
  in.principal_px = (in.principal_px.array() + 0.5) * times - 0.5;
  in.distortion = {-0.2, 0.03, 0.002, -0.001};
  return core::CameraModel(in);
}

// Both take every pixel's ray to the same quads, OpenGL with corners in single precision: where a
// quad begins is off by about 2^-22 focal lengths, 2e-4 pixels at 500. Colours of a slope of up to
// 60 levels a pixel move by .01 and differ by rounding alone. A pixel within 2e-4 of a border may
// lie on its other side; where that shows, beside a jump of depth or the outline (a tenth of the
// pixels, two borders each), it is .1 * 2 * 2 * 2e-4 = 8e-5 of all. Measured: none.
TEST(DepthQuads, OpenGlDrawsTheCpusImage) {
  const auto photographs = knot_from({0, -12, 12, 30});
  const auto context = render::make_osmesa_context();
  for (const std::string blending : {"hard", "weighted"}) {
    const auto quads = fitted(photographs, {{"quad-blending", blending}});
    const auto cpu = render::make_cpu_quad_renderer(quads, 1);
    const auto gl = render::make_gl_quad_renderer(*context, quads, 1);
    for (const int times : {1, 3}) {
      const auto camera = bent(photographs.camera(), times);
      const auto& pose = photographs.views().front().camera_from_object;
      const auto expected = cpu->render(camera, pose);
      const auto drawn = gl->render(camera, pose);
      const int pixels = cv::countNonZero(expected.mask);
      cv::Mat beside;
      cv::absdiff(expected.image, drawn.image, beside);
      EXPECT_GT(pixels, 6000);
      EXPECT_LE(cv::countNonZero(expected.mask != drawn.mask), 3e-4 * pixels);
      EXPECT_LE(cv::countNonZero(beside.reshape(1) > 1), 3e-4 * pixels);
      note(blending + "_" + std::to_string(times) + "_cpu_ms",
           tests::drawing_cpu_ms(*cpu, camera, pose));
      note(blending + "_" + std::to_string(times) + "_osmesa_ms",
           tests::drawing_cpu_ms(*gl, camera, pose));
    }
  }
}

// Bilinear over h = 4 / 576 of the focal length: h^2 / 8 times the lens' second derivatives, which
// for r (1 + k1 r^2), k1 = -.12, are at most 6 |k1| r = .45 at the corner, r = .62: .0015 pixels
// along each axis. Beyond the image's border it is the camera's own ray.
TEST(RayGrid, IsTheLensToThousandthsOfAPixel) {
  core::CameraModel::Intrinsics in;
  in.width_px = 640;
  in.height_px = 360;
  in.focal_px = {576, 577};
  in.principal_px = {323, 177};
  in.distortion = {-0.12, 0.05, 0.001, -0.0008};
  const core::CameraModel camera(in);
  const render::RayGrid grid(camera);
  double worst_px = 0;
  for (double y = -0.5; y < 359.5; y += 1.3) {
    for (double x = -0.5; x < 639.5; x += 1.3) {
      const Eigen::Vector2d ray = grid.at(x, y).cast<double>();
      worst_px = std::max(worst_px,
                          (*camera.project({ray.x(), ray.y(), 1}) - Eigen::Vector2d(x, y)).norm());
    }
  }
  note("grid_of_rays_px", worst_px);
  EXPECT_LT(worst_px, 0.009);
  const Eigen::Vector3f outside = camera.unproject({700.0, -20.0})->cast<float>();
  EXPECT_EQ(grid.at(700, -20), outside.head<2>());
}

struct Bytes {
  std::size_t count;
  [[nodiscard]] std::size_t byte_size() const { return count; }
};

// 100 bytes each in a budget of 250: two stay, the one asked for last among them; what is larger
// than the budget stays alone.
TEST(ViewCache, ForgetsWhatWasNotUsedForLongest) {
  render::ViewCache<Bytes> cache(250);
  int made = 0;
  const auto ask = [&](std::size_t view, std::size_t bytes = 100) {
    const int before = made;
    cache.get(view, [&] {
      ++made;
      return Bytes{bytes};
    });
    return made > before;
  };
  EXPECT_TRUE(ask(0));
  EXPECT_TRUE(ask(1));
  EXPECT_FALSE(ask(0));
  EXPECT_TRUE(ask(2));  // forgets 1
  EXPECT_FALSE(ask(0));
  EXPECT_TRUE(ask(1));  // forgets 2
  EXPECT_FALSE(ask(0));
  EXPECT_EQ(cache.byte_size(), 200u);
  EXPECT_TRUE(ask(3, 1000));
  EXPECT_EQ(cache.size(), 1u);
  EXPECT_TRUE(ask(1));
  EXPECT_EQ(cache.byte_size(), 100u);
}

}  // namespace
}  // namespace sheen::fitting::depth_quads
