// SPDX-License-Identifier: MIT
#include "app/preview/object_painter.h"

#include "core/mesh/bounds.h"
#include "render/preview/clay_shader.h"
#include "render/preview/score_shader.h"
#include "render/surface/patch_buffer.h"

#include <algorithm>
#include <utility>

namespace sheen::app {
namespace {

constexpr std::size_t kPiece = 256;  // elements sent between two looks at the budget
constexpr int kThreads = 1;          // the fit has the others

// Views: from quiet teal to red. Misfit: from grey to violet, so that nobody takes one for the
// other. What nobody has seen is on neither: blue.
const Eigen::Vector3f kUnseen{0.15f, 0.24f, 0.62f};
const render::ScorePalette kNeedsViews{
    {0.20f, 0.42f, 0.44f}, {0.91f, 0.74f, 0.40f}, {0.82f, 0.25f, 0.25f}, kUnseen};
const render::ScorePalette kMisfit{
    {0.33f, 0.35f, 0.38f}, {0.56f, 0.46f, 0.76f}, {0.95f, 0.55f, 0.93f}, kUnseen};

std::size_t slot_of(Layer layer) {
  return static_cast<std::size_t>(layer);
}

}  // namespace

std::array<std::array<float, 3>, 3> scale_of(Layer layer) {
  const render::ScorePalette& palette = layer == Layer::misfit ? kMisfit : kNeedsViews;
  std::array<std::array<float, 3>, 3> scale{};
  const std::array<Eigen::Vector3f, 3> stops{palette.low, palette.middle, palette.high};
  for (std::size_t i = 0; i < stops.size(); ++i) {
    scale[i] = {stops[i].x(), stops[i].y(), stops[i].z()};
  }
  return scale;
}

std::array<float, 3> unseen_colour() {
  return {kUnseen.x(), kUnseen.y(), kUnseen.z()};
}

ObjectPainter::ObjectPainter(render::Context& context, const render::gl::Functions& gl,
                             const core::Mesh& mesh)
    : context_(context),
      gl_(gl),
      mesh_(mesh),
      bounds_(core::bounds_of(mesh).cast<double>()),
      scores_{std::vector<float>(mesh.positions.size(), render::kUnseenScore),
              std::vector<float>(mesh.positions.size(), render::kUnseenScore)} {}

void ObjectPainter::show(const fitting::LightField& light_field) {
  radiance_ = render::make_renderer(context_, mesh_, light_field, kThreads);
  is_changed_.assign(light_field.element_count(), 0);
  changed_count_ = 0;
  cursor_ = 0;
  ++version_;
}

void ObjectPainter::note_changes(const fitting::ModelUpdate& update) {
  if (update.elements.empty()) return;
  if (update.elements.back() >= is_changed_.size()) is_changed_.resize(update.elements.back() + 1);
  for (const std::uint32_t element : update.elements) {
    changed_count_ += is_changed_[element] == 0;
    is_changed_[element] = 1;
  }
}

std::size_t ObjectPainter::send_changes(std::size_t budget_bytes) {
  std::size_t sent = 0;
  while (radiance_ && changed_count_ > 0 && sent < budget_bytes) {
    piece_.clear();
    if (cursor_ >= is_changed_.size()) cursor_ = 0;
    for (; cursor_ < is_changed_.size() && piece_.size() < kPiece; ++cursor_) {
      if (std::exchange(is_changed_[cursor_], std::uint8_t{0}) != 0) {
        piece_.push_back(static_cast<std::uint32_t>(cursor_));
      }
    }
    changed_count_ -= piece_.size();
    if (!piece_.empty()) sent += radiance_->upload(piece_);
  }
  version_ += sent > 0;
  return sent;
}

void ObjectPainter::set_scores(PatchScores scores) {
  scores_ = std::move(scores);
  ++version_;
  const auto all = render::all_patches(scores_.misfit.size());
  for (const Layer layer : {Layer::needs_views, Layer::misfit}) {
    if (auto& made = layers_[slot_of(layer)]) made->upload(all);
  }
}

void ObjectPainter::draw(Layer layer, render::gl::OffscreenTarget& target,
                         const core::CameraModel& camera,
                         const Eigen::Isometry3d& camera_from_object) {
  if (layer == Layer::radiance && radiance_) {
    radiance_->draw(target, camera, camera_from_object);
    return;
  }
  painted(layer == Layer::radiance ? Layer::mesh : layer).draw(target, camera, camera_from_object);
}

render::SurfaceLayer& ObjectPainter::painted(Layer layer) {
  auto& made = layers_[slot_of(layer)];
  if (!made) {
    auto paint = layer == Layer::mesh ? render::make_clay_shader()
                 : layer == Layer::misfit
                     ? render::make_score_shader(gl_, scores_.misfit, kMisfit)
                     : render::make_score_shader(gl_, scores_.needs_views, kNeedsViews);
    made = std::make_unique<render::SurfaceLayer>(gl_, mesh_, std::move(paint));
  }
  return *made;
}

}  // namespace sheen::app
