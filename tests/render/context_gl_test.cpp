// SPDX-License-Identifier: MIT
// Context, function table, owners and programs.
#include "core/diagnostics/error.h"
#include "render/context/context.h"
#include "render/gl/functions.h"
#include "render/gl/offscreen_target.h"
#include "render/gl/owners.h"
#include "render/gl/program.h"
#include "render/surface/surface_renderer.h"
#include "tests/render/test_scenes.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace sheen::render {
namespace {

/// Offers all of another context but one function.
class LackingContext final : public Context {
 public:
  LackingContext(Context& complete, std::string_view lacking)
      : complete_(complete), lacking_(lacking) {}
  void make_current() override { complete_.make_current(); }
  [[nodiscard]] Function resolve(const char* name) const override {
    return name == lacking_ ? nullptr : complete_.resolve(name);
  }

 private:
  Context& complete_;
  std::string_view lacking_;
};

class GlTest : public ::testing::Test {
 protected:
  GlTest() : context_(make_osmesa_context()), gl_(gl::load_functions(*context_)) {}

  template <typename Pointer>
  Pointer function(const char* name) {
    return reinterpret_cast<Pointer>(context_->resolve(name));
  }
  bool is_buffer(GLuint name) { return function<PFNGLISBUFFERPROC>("glIsBuffer")(name) == GL_TRUE; }
  bool is_texture(GLuint name) {
    return function<PFNGLISTEXTUREPROC>("glIsTexture")(name) == GL_TRUE;
  }

  std::unique_ptr<Context> context_;
  gl::Functions gl_;
};

TEST_F(GlTest, OffersVersion45) {
  const int version =
      10 * gl::integer_limit(gl_, GL_MAJOR_VERSION) + gl::integer_limit(gl_, GL_MINOR_VERSION);
  EXPECT_GE(version, 45);
}

TEST_F(GlTest, MissingFunctionIsNamed) {
  LackingContext lacking(*context_, "glTextureBuffer");
  try {
    gl::load_functions(lacking);
    FAIL() << "the missing function was not noticed";
  } catch (const core::Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("glTextureBuffer"), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    EXPECT_EQ(error.kind(), core::Error::Kind::run_failed);
  }
}

TEST_F(GlTest, MovedFromOwnersReleaseNothing) {
  GLuint name = 0;
  {
    gl::Buffer last;
    {
      gl::Buffer first = gl::make_buffer(gl_, 16, nullptr);
      name = first.name();
      gl::Buffer second(std::move(first));
      last = std::move(second);
      EXPECT_EQ(last.name(), name);
    }
    // Both earlier owners are gone; the buffer is not.
    EXPECT_TRUE(is_buffer(name));
  }
  EXPECT_FALSE(is_buffer(name));
}

TEST_F(GlTest, AssignmentReleasesWhatWasOwned) {
  gl::Texture owner = gl::make_texture(gl_, GL_TEXTURE_2D);
  const GLuint old_name = owner.name();
  gl::Texture other = gl::make_texture(gl_, GL_TEXTURE_2D);
  const GLuint new_name = other.name();
  owner = std::move(other);
  EXPECT_FALSE(is_texture(old_name));
  EXPECT_TRUE(is_texture(new_name));
  gl::Texture& same = owner;
  owner = std::move(same);
  EXPECT_EQ(owner.name(), new_name);
  EXPECT_TRUE(is_texture(new_name));
}

TEST_F(GlTest, RendererLeavesNothingBehind) {
  // Names are given out ascending: those below 64 cover all that a renderer makes.
  const auto alive = [this] {
    int count = 0;
    for (GLuint name = 1; name < 64; ++name)
      count += (is_buffer(name) ? 1 : 0) + (is_texture(name) ? 1 : 0);
    return count;
  };
  const core::Mesh mesh = testing::tetrahedron(0.1f);
  const auto model = testing::random_mean(mesh.positions.size(), 0);
  ASSERT_EQ(alive(), 0);
  {
    const auto renderer = make_gl_surface_renderer(*context_, mesh, model);
    const auto pose = testing::looking_at_origin({1, 0, 0}, 0.5);
    renderer->render(testing::distorted_camera(64, 48), pose);
    renderer->render(testing::plain_camera(32, 24), pose);
    // Vertices, indices, view block, coefficients; their texture, colour and depth.
    EXPECT_EQ(alive(), 7);
  }
  EXPECT_EQ(alive(), 0);
  EXPECT_EQ(gl_.GetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST_F(GlTest, ShaderErrorsCarryTheFirstLineOfTheLog) {
  const std::vector<gl::ShaderStage> stages{
      {GL_VERTEX_SHADER, "broken.vert", {"void main() { no_such_function(); }\n"}}};
  try {
    gl::make_program(gl_, stages);
    FAIL() << "a broken shader was accepted";
  } catch (const core::Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("broken.vert"), std::string::npos) << text;
    EXPECT_NE(text.find("no_such_function"), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
}

TEST_F(GlTest, LinkErrorsNameTheStages) {
  const std::vector<gl::ShaderStage> stages{
      {GL_VERTEX_SHADER, "a.vert", {"void missing(); void main() { missing(); }\n"}},
      {GL_FRAGMENT_SHADER, "b.frag", {"void main() {}\n"}}};
  try {
    gl::make_program(gl_, stages);
    FAIL() << "a program with an undefined function was accepted";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("a.vert + b.frag"), std::string::npos) << error.what();
  }
}

TEST_F(GlTest, ImagesTooLargeForTheDriverAreRefused) {
  gl::OffscreenTarget target(gl_, gl::Colour::bytes);
  const GLuint usable = target.framebuffer(8, 8);
  EXPECT_THROW(target.framebuffer(1 << 20, 8), core::Error);
  EXPECT_THROW(target.framebuffer(0, 8), core::Error);
  EXPECT_EQ(target.framebuffer(8, 8), usable);
}

// A context made and used in another thread, and one that wanders between threads, draw the same
// image as one that stays at home.
TEST(Context, WorksInOtherThreads) {
  const core::Mesh mesh = testing::sphere(0.1f, 8);
  const auto model = testing::random_mean(mesh.positions.size(), 0);
  const auto camera = testing::distorted_camera(64, 48);
  const auto pose = testing::looking_at_origin({1, 0, 0}, 0.36);
  const auto context = make_osmesa_context();
  const auto renderer = make_gl_surface_renderer(*context, mesh, model);
  const cv::Mat home = renderer->render(camera, pose).image;
  cv::Mat elsewhere;
  cv::Mat wandering;
  std::thread([&] {
    const auto own = make_osmesa_context();
    elsewhere = make_gl_surface_renderer(*own, mesh, model)->render(camera, pose).image;
    wandering = renderer->render(camera, pose).image;
  }).join();
  const cv::Mat back = renderer->render(camera, pose).image;
  EXPECT_GT(cv::countNonZero(home.reshape(1)), 100);
  EXPECT_EQ(cv::norm(home, elsewhere, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(home, wandering, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(home, back, cv::NORM_INF), 0);
}

}  // namespace
}  // namespace sheen::render
