// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"
#include "render/context/context.h"
#include "render/gl/functions.h"
#include "render/surface/surface_renderer.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <string>
#include <thread>

namespace sheen::render {
namespace {

// Nothing where this machine has no such device.
std::unique_ptr<Context> context_on(EglDevice kind, std::string& why_not) {
  try {
    return make_egl_context(kind);
  } catch (const core::Error& error) {
    why_not = error.what();
    return nullptr;
  }
}

std::string renderer_name(Context& context) {
  context.make_current();
  const auto get_string = reinterpret_cast<PFNGLGETSTRINGPROC>(context.resolve("glGetString"));
  return reinterpret_cast<const char*>(get_string(GL_RENDERER));
}

class EglContextOn : public ::testing::TestWithParam<EglDevice> {};

// The same renderer on another way to OpenGL: the image of the reference, but for rounding and
// pixels at the silhouette.
TEST_P(EglContextOn, DrawsTheImageOfTheReference) {
  std::string why_not;
  const auto context = context_on(GetParam(), why_not);
  if (!context) GTEST_SKIP() << why_not;
  const core::Mesh mesh = testing::sphere(0.1f, 16);
  const auto model = testing::smooth_iwls(mesh, 16, 3);
  const auto camera = testing::plain_camera(160, 120);
  const auto pose = testing::looking_at_origin({1, 0.4, 0.5}, 0.36);
  const RenderedView drawn = make_gl_surface_renderer(*context, mesh, model)->render(camera, pose);
  const RenderedView expected =
      make_reference_surface_renderer(mesh, model, 1)->render(camera, pose);
  const auto difference =
      testing::difference(drawn.image, expected.image, drawn.mask & expected.mask);
  EXPECT_LT(difference.mean, 0.5);
  EXPECT_GT(cv::norm(drawn.mask, cv::NORM_L1) / 255, 1000);
}

// EGL does not take a context away from another thread: that ends in an error, not in a crash.
TEST_P(EglContextOn, RefusesASecondThread) {
  std::string why_not;
  const auto context = context_on(GetParam(), why_not);
  if (!context) GTEST_SKIP() << why_not;
  bool refused = false;
  std::jthread([&] {
    try {
      context->make_current();
    } catch (const core::Error&) {
      refused = true;
    }
  }).join();
  EXPECT_TRUE(refused);
  context->make_current();
}

INSTANTIATE_TEST_SUITE_P(Devices, EglContextOn,
                         ::testing::Values(EglDevice::gpu, EglDevice::software),
                         [](const auto& device) {
                           return device.param == EglDevice::gpu ? "gpu" : "software";
                         });

// Whatever this machine offers, there is a context, and it is no software EGL: OSMesa draws with
// the same rasteriser.
TEST(MakeContext, TakesTheGpuOrOsmesa) {
  std::string why_not;
  const bool has_gpu = context_on(EglDevice::gpu, why_not) != nullptr;
  const auto context = make_context();
  const std::string name = renderer_name(*context);
  EXPECT_EQ(
      name.find("llvmpipe") == std::string::npos && name.find("softpipe") == std::string::npos,
      has_gpu)
      << name;
}

}  // namespace
}  // namespace sheen::render
