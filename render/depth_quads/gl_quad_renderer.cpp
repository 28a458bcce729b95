// SPDX-License-Identifier: MIT
#include "render/depth_quads/camera_choice.h"
#include "render/depth_quads/quad_renderer.h"
#include "render/depth_quads/screen_quads.h"
#include "render/depth_quads/sheet_upload.h"
#include "render/gl/offscreen_target.h"
#include "render/gl/program.h"
#include "render/shaders/shader_text.h"
#include "render/surface/view_block.h"
#include "render/views/ray_texture.h"
#include "render/views/read_view.h"
#include "render/views/view_cache.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace sheen::render {
namespace {

using fitting::KeptView;
using fitting::depth_quads::Blending;
using fitting::depth_quads::DepthQuads;

/// Uniform block `Sheet` of depth_quads/sheet.glsl, std140.
struct SheetBlock {
  std::array<float, 16> viewer_from_photograph;  ///< column-major
  std::array<float, 4> viewer_eye_share;
  float side_px, nearer, least_certainty, least_angle2;
  std::int32_t colours;
  std::array<std::int32_t, 3> padding;
};

/// What quads leave behind.
enum class Counted { depth, colour, weighted_colour };

/// Keeps a photograph while it is drawn, even when the cache has let it go.
struct CachedSheet {
  std::shared_ptr<const SheetUpload> upload;
  [[nodiscard]] std::size_t byte_size() const { return upload->byte_size(); }
};

/// A photograph as one view sees it.
struct SheetInView {
  std::shared_ptr<const SheetUpload> upload;
  std::size_t level;
  float tolerance;
  SheetBlock block;
};

gl::Program make_quad_program(const gl::Functions& gl) {
  const std::string lens = lens_glsl();
  const std::string_view sheet = shader_text("depth_quads/sheet.glsl");
  const std::array<gl::ShaderStage, 2> stages{
      gl::ShaderStage{
          GL_VERTEX_SHADER, "quads.vert", {lens, sheet, shader_text("depth_quads/quads.vert")}},
      gl::ShaderStage{
          GL_FRAGMENT_SHADER,
          "quads.frag",
          {sheet, shader_text("shaders/pixel_ray.glsl"), shader_text("depth_quads/quads.frag")}}};
  return gl::make_program(gl, stages);
}

gl::Program make_mean_program(const gl::Functions& gl) {
  const std::array<gl::ShaderStage, 2> stages{
      gl::ShaderStage{
          GL_VERTEX_SHADER, "everywhere.vert", {shader_text("shaders/everywhere.vert")}},
      gl::ShaderStage{
          GL_FRAGMENT_SHADER, "mean_colour.frag", {shader_text("depth_quads/mean_colour.frag")}}};
  return gl::make_program(gl, stages);
}

class GlQuadRenderer final : public Renderer {
 public:
  GlQuadRenderer(Context& context, const DepthQuads& quads, int threads)
      : context_(context),
        gl_(gl::load_functions(context)),
        quads_(quads),
        rays_(gl_, threads),
        cache_(static_cast<std::size_t>(quads.options().views.cache_mb) * kBytesPerMegabyte),
        quad_program_(make_quad_program(gl_)),
        mean_program_(make_mean_program(gl_)),
        view_block_(gl::make_buffer(gl_, sizeof(ViewBlock), nullptr)),
        sheet_block_(gl::make_buffer(gl_, sizeof(SheetBlock), nullptr)),
        no_attributes_(gl::make_vertex_array(gl_)),
        sums_(gl_, gl::Colour::floats),
        target_(gl_, gl::Colour::bytes) {
    describe_cells();
  }

  ~GlQuadRenderer() override { context_.make_current(); }
  GlQuadRenderer(const GlQuadRenderer&) = delete;
  GlQuadRenderer& operator=(const GlQuadRenderer&) = delete;
  GlQuadRenderer(GlQuadRenderer&&) = delete;
  GlQuadRenderer& operator=(GlQuadRenderer&&) = delete;

  /// Nothing to do: photographs are only added, and sent when they are drawn.
  std::size_t upload(std::span<const std::uint32_t> /*photographs*/) override { return 0; }

  RenderedView render(const core::CameraModel& camera,
                      const Eigen::Isometry3d& camera_from_object) override {
    context_.make_current();
    draw(target_, camera, camera_from_object);
    return read_view(gl_, {camera.width_px(), camera.height_px()});
  }

  void draw(gl::OffscreenTarget& target, const core::CameraModel& camera,
            const Eigen::Isometry3d& camera_from_object) override;

 private:
  static constexpr std::size_t kBytesPerMegabyte = 1000000;

  void describe_cells();
  const RayGrid& rays_of(const core::CameraModel& camera);
  [[nodiscard]] std::vector<SheetInView> sheets_for(const QuadCamera& viewer);
  void begin(const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_object);
  void draw_quads(SheetInView& sheet, Counted counted);
  void draw_means(GLuint framebuffer);

  Context& context_;
  gl::Functions gl_;
  const DepthQuads& quads_;
  RayTexture rays_;
  RayGrid photograph_rays_;  ///< of the camera that took the photograph sent last
  ViewCache<CachedSheet> cache_;
  gl::Program quad_program_, mean_program_;
  gl::Buffer view_block_, sheet_block_;
  gl::VertexArray cells_, no_attributes_;
  gl::OffscreenTarget sums_;  ///< of colours times weights, and 1 / depth of the nearest quad
  gl::OffscreenTarget target_;
};

/// One record of a buffer for each quad.
void GlQuadRenderer::describe_cells() {
  cells_ = gl::make_vertex_array(gl_);
  constexpr std::array<GLint, 3> numbers{4, 4, 2};
  GLuint offset = 0;
  for (GLuint attribute = 0; attribute < numbers.size(); ++attribute) {
    gl_.EnableVertexArrayAttrib(cells_.name(), attribute);
    gl_.VertexArrayAttribFormat(cells_.name(), attribute, numbers[attribute], GL_FLOAT, GL_FALSE,
                                offset);
    gl_.VertexArrayAttribBinding(cells_.name(), attribute, 0);
    offset += static_cast<GLuint>(numbers[attribute]) * GLuint{sizeof(float)};
  }
  gl_.VertexArrayBindingDivisor(cells_.name(), 0, 1);
}

/// Photographs of a recording share their camera.
const RayGrid& GlQuadRenderer::rays_of(const core::CameraModel& camera) {
  if (!(camera.intrinsics() == photograph_rays_.camera().intrinsics())) {
    photograph_rays_ = RayGrid(camera);
  }
  return photograph_rays_;
}

std::vector<SheetInView> GlQuadRenderer::sheets_for(const QuadCamera& viewer) {
  std::vector<SheetInView> sheets;
  const double enlargement_px = quads_.options().enlargement;
  for (const auto& [chosen_idx, share] :
       choose_cameras(quads_, viewer.camera, viewer.camera_from_object)) {
    const std::size_t i = chosen_idx;
    const KeptView& photograph = quads_.photographs()[i];
    const auto& cached = cache_.get(i, [&] {
      return CachedSheet{std::make_shared<SheetUpload>(gl_, photograph, quads_.quads(i),
                                                       enlargement_px, rays_of(photograph.camera))};
    });
    const std::size_t level_idx = choose_level(photograph, quads_.quads(i), viewer);
    const auto& level = quads_.quads(i).levels[level_idx];
    SheetInView sheet{cached.upload, level_idx, depth_tolerance(photograph, level), {}};
    const Eigen::Isometry3d viewer_from_photograph =
        viewer.camera_from_object * photograph.camera_from_object.inverse();
    const Eigen::Vector3f eye = viewer_from_photograph.inverse().translation().cast<float>();
    Eigen::Map<Eigen::Matrix4f>(sheet.block.viewer_from_photograph.data()) =
        viewer_from_photograph.matrix().cast<float>();
    sheet.block.viewer_eye_share = {eye.x(), eye.y(), eye.z(), share};
    sheet.block.side_px = static_cast<float>(level.spacing_px + 2 * enlargement_px);
    sheet.block.least_angle2 = static_cast<float>(kLeastAngle * kLeastAngle);
    sheets.push_back(std::move(sheet));
  }
  return sheets;
}

void GlQuadRenderer::begin(const core::CameraModel& camera,
                           const Eigen::Isometry3d& camera_from_object) {
  const ViewBlock view = make_view_block(camera, camera_from_object, 1, 1);
  gl_.NamedBufferSubData(view_block_.name(), 0, sizeof(view), &view);
  gl_.BindBufferBase(GL_UNIFORM_BUFFER, 0, view_block_.name());
  gl_.BindBufferBase(GL_UNIFORM_BUFFER, 1, sheet_block_.name());
  rays_.set_camera(camera);
  rays_.bind();

  const GLuint framebuffer = sums_.framebuffer(camera.width_px(), camera.height_px());
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl_.Viewport(0, 0, camera.width_px(), camera.height_px());
  // Lower left: the first row of the image is the first one of what is read back.
  gl_.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gl_.DepthMask(GL_TRUE);
  constexpr std::array<float, 4> nothing{0, 0, 0, 0};
  gl_.ClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, nothing.data());
  gl_.ClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, nothing.data());
  for (const GLenum off : {GL_CULL_FACE, GL_BLEND, GL_SCISSOR_TEST}) gl_.Disable(off);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_GREATER);
  gl_.UseProgram(quad_program_.name());
  gl_.BindVertexArray(cells_.name());
}

void GlQuadRenderer::draw_quads(SheetInView& sheet, Counted counted) {
  const SheetUpload::Level& level = sheet.upload->level(sheet.level);
  if (level.count == 0) return;
  // Fliers hide nothing. Weighted colours count up to so far behind the nearest.
  sheet.block.least_certainty = counted == Counted::depth ? kFlierCertainty : 0.0f;
  sheet.block.nearer = counted == Counted::weighted_colour ? 1.0f + sheet.tolerance : 1.0f;
  sheet.block.colours = static_cast<std::int32_t>(counted);
  gl_.NamedBufferSubData(sheet_block_.name(), 0, sizeof(sheet.block), &sheet.block);
  gl_.VertexArrayVertexBuffer(cells_.name(), 0, level.cells.name(), 0, SheetUpload::kBytesPerCell);
  gl_.BindTextureUnit(0, sheet.upload->photograph());
  constexpr GLsizei corners = 4;
  gl_.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, corners, level.count);
}

void GlQuadRenderer::draw_means(GLuint framebuffer) {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.UseProgram(mean_program_.name());
  gl_.BindVertexArray(no_attributes_.name());
  gl_.BindTextureUnit(0, sums_.colour_texture());
  gl_.DrawArraysInstanced(GL_TRIANGLES, 0, 3, 1);
  gl_.BindVertexArray(0);
}

void GlQuadRenderer::draw(gl::OffscreenTarget& target, const core::CameraModel& camera,
                          const Eigen::Isometry3d& camera_from_object) {
  std::vector<SheetInView> sheets = sheets_for({camera, camera_from_object});
  begin(camera, camera_from_object);
  if (quads_.options().blending == Blending::hard) {
    for (SheetInView& sheet : sheets) draw_quads(sheet, Counted::colour);
  } else {
    gl_.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    for (SheetInView& sheet : sheets) draw_quads(sheet, Counted::depth);
    gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl_.DepthMask(GL_FALSE);
    gl_.DepthFunc(GL_GEQUAL);
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_ONE, GL_ONE);
    for (SheetInView& sheet : sheets) draw_quads(sheet, Counted::weighted_colour);
    gl_.Disable(GL_BLEND);
    gl_.DepthMask(GL_TRUE);
  }
  draw_means(target.framebuffer(camera.width_px(), camera.height_px()));
  gl_.ClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
}

}  // namespace

std::unique_ptr<Renderer> make_gl_quad_renderer(Context& context, const DepthQuads& quads,
                                                int threads) {
  return std::make_unique<GlQuadRenderer>(context, quads, threads);
}

}  // namespace sheen::render
