// SPDX-License-Identifier: MIT
// What every representation keeps to. The tests walk the registry, so that a new one is checked
// without being named here.
#include "core/diagnostics/error.h"
#include "fitting/descriptor.h"
#include "fitting/model_file/model_file.h"
#include "fitting/model_file/model_part.h"
#include "fitting/patch_light_field.h"
#include "fitting/undo/undoable_fitter.h"
#include "render/billboard/billboard_renderer.h"
#include "render/context/context.h"
#include "render/depth_quads/quad_renderer.h"
#include "render/renderer.h"
#include "render/surface/surface_renderer.h"
#include "tests/fitting/photographs_for_tests.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace sheen::fitting {
namespace {

using testing::Photographs;

const std::vector<int> kAllViews{0, 1, 2, 3, 4, 5, 6, 7};

/// A colour of place and direction, within what images hold.
Eigen::Vector3f glossy(const Eigen::Vector3f& point, const Eigen::Vector3f& towards_viewer) {
  return {0.5f + 4.0f * point.x(), 0.5f + 0.3f * towards_viewer.y(),
          0.5f + 2.0f * point.z() + 0.1f * towards_viewer.x()};
}

Photographs photographs_of(const testing::Look& look) {
  return {render::testing::sphere(0.1f, 8), static_cast<int>(kAllViews.size()), look};
}

std::string bytes_of(const core::Mesh& mesh, const LightField& light_field) {
  const tests::TemporaryFolder folder;
  write_model(folder / "model.glb", mesh, light_field);
  return tests::read_file(folder / "model.glb");
}

/// Makes a fit cheap where it could be large: what is checked does not depend on sizes.
OptionValues small_options(const Descriptor& one) {
  const OptionValues small{
      {"directions", "20"}, {"billboard-size", "64"}, {"texture-side", "128"}, {"texel-mm", "3"}};
  OptionValues values;
  for (const FitOption& option : one.default_options()->table()) {
    if (const auto found = small.find(option.name); found != small.end()) values.insert(*found);
  }
  return values;
}

std::unique_ptr<Fitter> fitted(const Descriptor& one, const Photographs& photographs,
                               const std::vector<int>& views, int threads = 1) {
  auto fitter = make_fitter(one.name, photographs.mesh(), small_options(one), threads);
  photographs.show(views, *fitter);
  fitter->finish();
  return fitter;
}

/// One test for each representation, named after it.
class Representation : public ::testing::TestWithParam<const Descriptor*> {};

// Images of one colour, background included. Models keep half floats (steps of 2^-11 below 1, an
// eighth of a grey level), so what is drawn is at most one level beside it.
TEST_P(Representation, ConstantColourStaysThatColour) {
  const auto photographs = photographs_of(glossy);
  const cv::Mat image(photographs.views()[0].image.size(), CV_8UC3, cv::Scalar(204, 102, 51));
  pipeline::ViewObserver observer(photographs.mesh(),
                                  core::make_raster_visibility(photographs.mesh(), 1), {}, 1);
  const auto fitter = make_fitter(GetParam()->name, photographs.mesh(), small_options(*GetParam()));
  for (const int i : kAllViews) {
    const auto& pose = photographs.views()[static_cast<std::size_t>(i)].camera_from_object;
    fitter->integrate(observer.observe(i, image, photographs.camera(), pose));
  }
  fitter->finish();
  const auto context = render::make_osmesa_context();
  const auto renderer = render::make_renderer(*context, photographs.mesh(), fitter->light_field());
  const auto from_elsewhere = render::testing::looking_at_origin({0.3, -0.8, 0.4}, 0.36);
  const auto view = renderer->render(photographs.camera(), from_elsewhere);
  const cv::Mat expected(view.image.size(), CV_8UC3, cv::Scalar(204, 102, 51));
  const auto difference = render::testing::difference(view.image, expected, view.mask);
  EXPECT_GT(difference.pixels, 500u);
  EXPECT_LE(difference.largest, 1);
}

TEST_P(Representation, FitsToTheSameBytesOnAnyNumberOfThreads) {
  const auto photographs = photographs_of(glossy);
  const auto bytes = [&](int threads) {
    return bytes_of(photographs.mesh(),
                    fitted(*GetParam(), photographs, kAllViews, threads)->light_field());
  };
  const std::string once = bytes(1);
  EXPECT_TRUE(bytes(1) == once);
  EXPECT_TRUE(bytes(3) == once);
}

TEST_P(Representation, IsReadBackAsItWasWritten) {
  const auto photographs = photographs_of(glossy);
  const auto fitter = fitted(*GetParam(), photographs, kAllViews);
  const tests::TemporaryFolder folder;
  write_model(folder / "a.glb", photographs.mesh(), fitter->light_field());
  const Model read = read_model(folder / "a.glb");
  EXPECT_EQ(read.light_field->representation(), GetParam()->name);
  EXPECT_EQ(byte_size(*read.light_field), byte_size(fitter->light_field()));
  EXPECT_TRUE(bytes_of(read.mesh, *read.light_field) == tests::read_file(folder / "a.glb"));
}

TEST_P(Representation, ShortenedFilesAreRefused) {
  const auto photographs = photographs_of(glossy);
  const std::string good =
      bytes_of(photographs.mesh(), fitted(*GetParam(), photographs, kAllViews)->light_field());
  const tests::TemporaryFolder folder;
  constexpr std::size_t lengths = 40;
  for (std::size_t i = 0; i < lengths; ++i) {
    tests::write_file(folder / "bad.glb", good.substr(0, i * good.size() / lengths));
    EXPECT_THROW(read_model(folder / "bad.glb"), core::Error) << i;
  }
}

// An array that is one byte shorter than what belongs to it.
TEST_P(Representation, PartsWithShortArraysAreRefused) {
  const auto photographs = photographs_of(glossy);
  const auto fitter = fitted(*GetParam(), photographs, kAllViews);
  const ModelPart good = GetParam()->encode(fitter->light_field());
  EXPECT_NO_THROW(GetParam()->decode(good, photographs.mesh()));
  for (const auto& [name, array] : good.arrays) {
    ModelPart part = good;
    part.arrays[name] = array.first(array.size() - 1);
    EXPECT_THROW(GetParam()->decode(part, photographs.mesh()), ModelFault) << name;
    part.arrays.erase(name);
    EXPECT_THROW(GetParam()->decode(part, photographs.mesh()), ModelFault) << name;
  }
}

TEST_P(Representation, FewViewsAndNoneGiveNumbers) {
  const auto photographs = photographs_of(glossy);
  for (const std::vector<int>& views : {std::vector<int>{}, std::vector<int>{0}}) {
    const auto fitter = fitted(*GetParam(), photographs, views);
    const auto colours = fitter->light_field().vertex_colours(photographs.mesh());
    EXPECT_EQ(colours.size(), photographs.mesh().positions.size());
    EXPECT_TRUE(std::ranges::all_of(colours, [](const auto& rgb) { return rgb.allFinite(); }));
  }
}

TEST_P(Representation, UndoEqualsAFitThatNeverSawTheViews) {
  const auto photographs = photographs_of(glossy);
  UndoableFitter undoable(
      [&] { return make_fitter(GetParam()->name, photographs.mesh(), small_options(*GetParam())); },
      [&](std::span<const int> frames, const auto& observe) {
        photographs.observe({frames.begin(), frames.end()}, observe);
      });
  photographs.show(kAllViews, undoable);
  undoable.undo(3, [](const core::SampleBatch&, const LightField&) {});
  undoable.finish();
  const auto never_saw = fitted(*GetParam(), photographs, {0, 1, 2, 3, 4});
  EXPECT_TRUE(bytes_of(photographs.mesh(), undoable.light_field()) ==
              bytes_of(photographs.mesh(), never_saw->light_field()));
}

// ---- what images have in common ----

/// Photographs as a fitter is shown them.
struct Walk {
  core::Mesh mesh;
  core::CameraModel camera;
  std::vector<testing::Photograph> views;
};

Walk walk_of(const Photographs& photographs) {
  return {photographs.mesh(), photographs.camera(), photographs.views()};
}

/// Fits a walk and draws a view, its support included.
render::RenderedView drawn(const Descriptor& one, const Walk& walk, const Eigen::Isometry3d& pose) {
  pipeline::ViewObserver observer(walk.mesh, core::make_raster_visibility(walk.mesh, 1), {}, 1);
  const auto fitter = make_fitter(one.name, walk.mesh, small_options(one));
  for (std::size_t i = 0; i < walk.views.size(); ++i) {
    const auto& [image, camera_from_object] = walk.views[i];
    fitter->integrate(
        observer.observe(static_cast<int>(i), image, walk.camera, camera_from_object));
  }
  fitter->finish();
  const auto context = render::make_osmesa_context();
  return render::make_renderer(*context, walk.mesh, fitter->light_field())
      ->render(walk.camera, pose);
}

/// Between two images of the same representation, well within both outlines.
render::testing::Difference between(const render::RenderedView& a, const render::RenderedView& b) {
  return render::testing::difference(a.image, b.image,
                                     render::testing::common_interior(a.support, b.support, 4));
}

const Eigen::Isometry3d kElsewhere = render::testing::looking_at_origin({0.3, -0.8, 0.4}, 0.36);

/// How far a picture of `kElsewhere` is from the truth: what representations promise beyond exact
/// numbers (those of the texture depend on its charts, some on tolerances) is kept to within it.
double error_of(const render::RenderedView& view) {
  const Photographs truth(render::testing::sphere(0.1f, 8), {kElsewhere}, glossy);
  const cv::Mat inside = render::testing::common_interior(view.support, view.mask, 4);
  return render::testing::difference(view.image, truth.views()[0].image, inside).mean;
}

// Colours a c + b in, a c + b out. What is linear in the colours differs by rounding: half a level
// of the photographs, half of either image, a quarter of a level in the mean.
TEST_P(Representation, GainAndOffsetPassThrough) {
  constexpr double gain = 0.75, offset = 30;
  Walk walk = walk_of(photographs_of(glossy));
  auto plain = drawn(*GetParam(), walk, kElsewhere);
  const double error = gain * error_of(plain);
  plain.image.convertTo(plain.image, -1, gain, offset);
  for (testing::Photograph& view : walk.views) view.image.convertTo(view.image, -1, gain, offset);
  const auto found = between(drawn(*GetParam(), walk, kElsewhere), plain);
  EXPECT_GT(found.pixels, 3000u);
  EXPECT_LE(found.mean, 0.3 + 0.5 * error);
}

/// Object and cameras, turned and shifted.
Walk moved(Walk walk, const Eigen::Isometry3d& moved_from_object) {
  for (auto& position : walk.mesh.positions) {
    position = (moved_from_object * position.cast<double>()).cast<float>();
  }
  for (auto& normal : walk.mesh.normals) {
    normal = (moved_from_object.linear() * normal.cast<double>()).cast<float>().normalized();
  }
  for (testing::Photograph& view : walk.views) {
    view.camera_from_object = view.camera_from_object * moved_from_object.inverse();
  }
  return walk;
}

// Positions are rounded to 2^-24 of a metre, a thousandth of a pixel here. The axes of discs,
// charts and lattices of directions turn with the world, not with the object: two pictures that are
// no further from each other than from the truth.
TEST_P(Representation, TheWorldMayBeMoved) {
  const Walk walk = walk_of(photographs_of(glossy));
  const auto before = drawn(*GetParam(), walk, kElsewhere);
  const double error = error_of(before);
  Eigen::Isometry3d moved_from_object = Eigen::Isometry3d::Identity();
  moved_from_object.translation() = Eigen::Vector3d(0.7, -0.4, 0.2);
  moved_from_object.linear() =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  const auto after =
      drawn(*GetParam(), moved(walk, moved_from_object), kElsewhere * moved_from_object.inverse());
  const auto found = between(after, before);
  EXPECT_GT(found.pixels, 3000u);
  EXPECT_LE(found.mean, 0.3 + error);
}

TEST_P(Representation, TheOrderOfViewsDoesNotShow) {
  Walk walk = walk_of(photographs_of(glossy));
  const auto forwards = drawn(*GetParam(), walk, kElsewhere);
  const double error = error_of(forwards);
  std::ranges::reverse(walk.views);
  const auto found = between(drawn(*GetParam(), walk, kElsewhere), forwards);
  EXPECT_GT(found.pixels, 3000u);
  EXPECT_LE(found.mean, 0.5 * error);
}

/// What draws the same by OpenGL and without; null where only one of them does.
struct BothRenderers {
  std::unique_ptr<render::Renderer> gl, cpu;
};

BothRenderers both(render::Context& context, const core::Mesh& mesh,
                   const LightField& light_field) {
  if (const auto* const patches = as_patches(light_field)) {
    return {render::make_renderer(context, mesh, *patches),
            render::make_reference_surface_renderer(mesh, *patches, 1)};
  }
  if (const auto* const quads = dynamic_cast<const depth_quads::DepthQuads*>(&light_field)) {
    return {render::make_gl_quad_renderer(context, *quads, 1),
            render::make_cpu_quad_renderer(*quads, 1)};
  }
  if (const auto* const billboards = dynamic_cast<const billboard::Billboards*>(&light_field)) {
    return {render::make_gl_billboard_renderer(context, *billboards,
                                               {Eigen::Isometry3d::Identity()}, 1),
            render::make_cpu_billboard_renderer(*billboards, 1)};
  }
  return {};
}

// Those whose images differ by more than rounding have tests of their own (eigen_texture_test,
// copies_gl_test).
TEST_P(Representation, OpenGlDrawsTheReference) {
  const auto photographs = photographs_of(glossy);
  const auto fitter = fitted(*GetParam(), photographs, kAllViews);
  const auto context = render::make_osmesa_context();
  const auto [gl, cpu] = both(*context, photographs.mesh(), fitter->light_field());
  if (!gl) return;
  const auto found = between(gl->render(photographs.camera(), kElsewhere),
                             cpu->render(photographs.camera(), kElsewhere));
  EXPECT_GT(found.pixels, 3000u);
  EXPECT_LE(found.largest, 1);
}

INSTANTIATE_TEST_SUITE_P(Registry, Representation, ::testing::ValuesIn(representations()),
                         [](const auto& parameter) {
                           std::string name(parameter.param->name);
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace sheen::fitting
