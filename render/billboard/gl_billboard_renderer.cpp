// SPDX-License-Identifier: MIT
#include "core/samples/vertex_view.h"
#include "render/billboard/billboard_renderer.h"
#include "render/billboard/draw_frames.h"
#include "render/billboard/frame_layers.h"
#include "render/gl/instanced_strips.h"
#include "render/gl/offscreen_target.h"
#include "render/gl/program.h"
#include "render/shaders/shader_text.h"
#include "render/views/ray_texture.h"
#include "render/views/read_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

namespace sheen::render {
namespace {

using fitting::billboard::Billboards;
using fitting::billboard::Blending;
using fitting::billboard::FrameCamera;

using Four = std::array<float, 4>;

/// As the shaders have them.
struct BillboardRecord {
  Four box, centre_reach;
  std::array<std::uint32_t, 2> frames;
  float level, padding;
};
struct FrameRecord {
  Four right_eye, up_eye, towards_eye, crop;
  float px_per_m, inverse_distance, share;
  std::int32_t layer;
};
struct LooksRecord {
  float radius_m;
  std::int32_t is_nearest, layers, steps;
  float missed;
  std::array<float, 3> padding;
};

Four with(const Eigen::Vector3f& vector, float last) {
  return {vector.x(), vector.y(), vector.z(), last};
}

/// The pixels that may see a sphere: where planes through the camera touch it. All where a lens
/// curves these, or where it reaches behind the camera.
Four box_of(const core::CameraModel& camera, const Eigen::Vector3d& centre, double reach_m) {
  Eigen::Array2d low = Eigen::Array2d::Zero();
  Eigen::Array2d high(camera.width_px(), camera.height_px());
  const auto& in = camera.intrinsics();
  if (!camera.curves_lines() && centre.z() > reach_m) {
    const Eigen::Array2d size = high;
    for (const int axis : {0, 1}) {
      const double towards = std::atan2(centre[axis], centre.z());
      const double half = std::asin(reach_m / std::hypot(centre[axis], centre.z()));
      const auto pixel = [&](double angle) {
        return std::tan(angle) * in.focal_px[axis] + in.principal_px[axis];
      };
      low[axis] = std::clamp(std::floor(pixel(towards - half)), 0.0, size[axis]);
      high[axis] = std::clamp(std::ceil(pixel(towards + half)) + 1, 0.0, size[axis]);
    }
  }
  return {static_cast<float>(low.x()), static_cast<float>(low.y()), static_cast<float>(high.x()),
          static_cast<float>(high.y())};
}

gl::Program make_billboard_program(const gl::Functions& gl) {
  const std::string_view copies = shader_text("billboard/billboards.glsl");
  const std::array<gl::ShaderStage, 2> stages{
      gl::ShaderStage{
          GL_VERTEX_SHADER, "billboards.vert", {copies, shader_text("billboard/billboards.vert")}},
      gl::ShaderStage{GL_FRAGMENT_SHADER,
                      "billboards.frag",
                      {copies, shader_text("shaders/pixel_ray.glsl"),
                       shader_text("billboard/billboards.frag")}}};
  return gl::make_program(gl, stages);
}

class GlBillboardRenderer final : public Renderer {
 public:
  GlBillboardRenderer(Context& context, const Billboards& billboards,
                      std::vector<Eigen::Isometry3d> scene_from_objects, int threads)
      : context_(context),
        gl_(gl::load_functions(context)),
        billboards_(billboards),
        scene_from_objects_(std::move(scene_from_objects)),
        rays_(gl_, threads),
        layers_(gl_, billboards),
        program_(make_billboard_program(gl_)),
        no_attributes_(gl::make_vertex_array(gl_)),
        target_(gl_, gl::Colour::bytes) {}

  ~GlBillboardRenderer() override { context_.make_current(); }
  GlBillboardRenderer(const GlBillboardRenderer&) = delete;
  GlBillboardRenderer& operator=(const GlBillboardRenderer&) = delete;
  GlBillboardRenderer(GlBillboardRenderer&&) = delete;
  GlBillboardRenderer& operator=(GlBillboardRenderer&&) = delete;

  /// Frames that change are sent again.
  std::size_t upload(std::span<const std::uint32_t> frames) override {
    if (!frames.empty()) layers_.forget();
    return 0;
  }

  RenderedView render(const core::CameraModel& camera,
                      const Eigen::Isometry3d& camera_from_scene) override {
    context_.make_current();
    draw(target_, camera, camera_from_scene);
    return read_view(gl_, {camera.width_px(), camera.height_px()});
  }

  void draw(gl::OffscreenTarget& target, const core::CameraModel& camera,
            const Eigen::Isometry3d& camera_from_scene) override;

 private:
  void list_copies(const core::CameraModel& camera, const Eigen::Isometry3d& camera_from_scene);
  [[nodiscard]] FrameRecord record_of(const FrameShare& frame, const core::CameraModel& camera,
                                      const Eigen::Isometry3d& camera_from_object) const;
  template <typename Record>
  [[nodiscard]] gl::Buffer buffer_of(std::span<const Record> records) const;

  Context& context_;
  gl::Functions gl_;
  const Billboards& billboards_;
  std::vector<Eigen::Isometry3d> scene_from_objects_;
  RayTexture rays_;
  FrameLayers layers_;
  gl::Program program_;
  gl::VertexArray no_attributes_;
  gl::OffscreenTarget target_;
  std::vector<BillboardRecord> copies_;
  std::vector<FrameRecord> frames_;
};

FrameRecord GlBillboardRenderer::record_of(const FrameShare& frame, const core::CameraModel& camera,
                                           const Eigen::Isometry3d& camera_from_object) const {
  const FrameCamera baked = billboards_.camera(frame.frame_idx);
  const FrameInView view = frame_in_view(baked, camera, camera_from_object);
  const cv::Rect& crop = billboards_.frame(frame.frame_idx).crop;
  const auto axis = [&](int row) {
    return with(view.frame_from_viewer.row(row).transpose(), view.eye[row]);
  };
  return {
      axis(0),
      axis(1),
      axis(2),
      {static_cast<float>(crop.x), static_cast<float>(crop.y),
       static_cast<float>(crop.x + crop.width - 1), static_cast<float>(crop.y + crop.height - 1)},
      0.5f * static_cast<float>(baked.side_px) / baked.half_m,
      baked.inverse_distance,
      frame.share,
      layers_.layer_of(frame.frame_idx)};
}

void GlBillboardRenderer::list_copies(const core::CameraModel& camera,
                                      const Eigen::Isometry3d& camera_from_scene) {
  // Choose the frames of every copy, and see that they are there.
  std::vector<std::vector<FrameShare>> chosen;
  std::set<std::size_t> needed;
  for (const Eigen::Isometry3d& scene_from_object : scene_from_objects_) {
    const Eigen::Isometry3d camera_from_object = camera_from_scene * scene_from_object;
    chosen.push_back(frames_towards(billboards_, core::eye_in_object(camera_from_object)));
    for (const FrameShare& frame : chosen.back()) needed.insert(frame.frame_idx);
  }
  layers_.hold(std::vector<std::size_t>(needed.begin(), needed.end()));

  // List them.
  copies_.clear();
  frames_.clear();
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i].empty()) continue;
    const Eigen::Isometry3d camera_from_object = camera_from_scene * scene_from_objects_[i];
    // All frames are as large, and the eye is as far from all.
    const FrameCamera first = billboards_.camera(chosen[i].front().frame_idx);
    const float half_m = first.half_m;
    const Eigen::Vector3d centre = camera_from_object * billboards_.sphere().centre.cast<double>();
    copies_.push_back(
        {box_of(camera, centre, static_cast<double>(half_m)),
         with(centre.cast<float>(), half_m * half_m),
         {static_cast<std::uint32_t>(frames_.size()), static_cast<std::uint32_t>(chosen[i].size())},
         frame_in_view(first, camera, camera_from_object).level,
         0});
    for (const FrameShare& frame : chosen[i]) {
      frames_.push_back(record_of(frame, camera, camera_from_object));
    }
  }
}

template <typename Record>
gl::Buffer GlBillboardRenderer::buffer_of(std::span<const Record> records) const {
  return gl::make_buffer(gl_, static_cast<GLsizeiptr>(records.size_bytes()), records.data());
}

void GlBillboardRenderer::draw(gl::OffscreenTarget& target, const core::CameraModel& camera,
                               const Eigen::Isometry3d& camera_from_scene) {
  list_copies(camera, camera_from_scene);
  rays_.set_camera(camera);
  const GLuint framebuffer = target.framebuffer(camera.width_px(), camera.height_px());
  gl_.DepthMask(GL_TRUE);
  constexpr Four nothing{0, 0, 0, 0};
  gl_.ClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, nothing.data());
  gl_.ClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, nothing.data());
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  if (copies_.empty()) return;

  // Tell the shaders.
  const Four size{static_cast<float>(camera.width_px()), static_cast<float>(camera.height_px()), 0,
                  0};
  const LooksRecord looks{billboards_.sphere().radius_m,
                          billboards_.options().blending == Blending::nearest ? 1 : 0,
                          kDepthLayers,
                          kStepsToSurface,
                          kMissedPart,
                          {}};
  const gl::Buffer copies = buffer_of(std::span<const BillboardRecord>(copies_));
  const gl::Buffer frames = buffer_of(std::span<const FrameRecord>(frames_));
  const gl::Buffer size_block = buffer_of(std::span(&size, 1));
  const gl::Buffer looks_block = buffer_of(std::span(&looks, 1));
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, copies.name());
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, frames.name());
  gl_.BindBufferBase(GL_UNIFORM_BUFFER, 0, size_block.name());
  gl_.BindBufferBase(GL_UNIFORM_BUFFER, 1, looks_block.name());
  layers_.bind();
  rays_.bind();

  gl::draw_instanced_strips(gl_, program_.name(), no_attributes_.name(),
                            {camera.width_px(), camera.height_px()},
                            static_cast<GLsizei>(copies_.size()));
}

}  // namespace

std::unique_ptr<Renderer> make_gl_billboard_renderer(
    Context& context, const Billboards& billboards,
    std::vector<Eigen::Isometry3d> scene_from_objects, int threads) {
  return std::make_unique<GlBillboardRenderer>(context, billboards, std::move(scene_from_objects),
                                               threads);
}

}  // namespace sheen::render
