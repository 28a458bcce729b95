// SPDX-License-Identifier: MIT
#include "app/preview/preview_window.h"

#include "app/preview/snapshot.h"
#include "core/geometry/tangent_frame.h"
#include "fitting/patch_light_field.h"

#include <utility>

namespace sheen::app {
namespace {

constexpr double kUndo_s = 5;
constexpr double kFineAfter_s = 0.15;  // stillness after which the model is drawn finer

}  // namespace

PreviewWindow::PreviewWindow(const PreviewSubject& subject)
    : subject_(subject),
      window_(subject.title, layout::kWidth, layout::kHeight),
      painter_(window_, window_.gl(), subject.mesh),
      model_view_(window_.gl(), subject.mesh, subject.up, subject.live != nullptr),
      camera_view_(window_.gl()) {
  if (subject_.light_field != nullptr) painter_.show(*subject_.light_field);
  if (subject_.live != nullptr) {
    feed_.emplace(*subject_.live, painter_);
    trail_.lens = &subject_.live->camera();
    subject_.live->set_wake([] { Window::wake(); });
  }
}

bool PreviewWindow::redraw(double longest_wait_s) {
  const double coarse_wait_s = model_view_.is_coarse() ? kFineAfter_s : longest_wait_s;
  window_.begin_redraw(painter_.has_changes() ? 0 : std::min(coarse_wait_s, longest_wait_s));
  pace_.begin();
  for (const KeyPress& press : window_.key_presses()) {
    if (const auto command = command_of(press)) obey(*command);
  }
  if (subject_.live != nullptr) take_news();
  paint();
  lay_out();
  window_.draw();
  if (std::exchange(snapshot_wanted_, false)) save_snapshot();
  window_.show();
  pace_.end();
  return !window_.wants_to_close();
}

void PreviewWindow::take_news() {
  // Counters, image and pose.
  status_ = subject_.live->status();
  if (status_.frames_read != shown_frame_ && !status_.image.empty()) {
    shown_frame_ = status_.frames_read;
    camera_view_.take(status_.image, subject_.live->camera(), status_.camera_from_object);
  }
  if (status_.camera_from_object) trail_.present = status_.camera_from_object;
  trail_.hint = status_.phase == LiveStatus::Phase::finished ? std::nullopt : status_.hint;

  feed_->take_news(trail_.poses);
  if (!painter_.draws_from_model()) feed_->look([this] { paint_views(); });
}

void PreviewWindow::paint() {
  if (feed_ && painter_.draws_from_model()) {
    feed_->look([this] { paint_views(); });
  } else {
    paint_views();
  }
}

void PreviewWindow::paint_views() {
  model_view_.paint(painter_, state_.layer, pace_.is_slow());
  if (feed_) camera_view_.paint(painter_, state_);
}

void PreviewWindow::lay_out() {
  const layout::Area views = layout::views_area(window_.content_scale());
  show_views(views);
  show_panel(layout::panel_area(window_.content_scale()));
  if (const auto patch = patch_news()) {
    const float margin = layout::kMargin * window_.content_scale();
    show_patch_card(*patch, {views.size.x - margin, views.size.y - margin});
  }
  if (state_.help) show_help(subject_.live != nullptr);
}

void PreviewWindow::show_views(const layout::Area& area) {
  layout::begin_views(area);
  const bool has_camera = subject_.live != nullptr;
  const bool camera_is_large = has_camera && state_.camera_is_large;
  if (camera_is_large) {
    camera_view_.show(area.corner, area.size, state_);
  } else {
    model_view_.show(area.corner, area.size, state_, trail_, true);
  }
  if (has_camera) {
    // The other one stands in the lower left corner, framed.
    const layout::Area inset =
        layout::inset_area(area, subject_.live->camera(), window_.content_scale());
    if (camera_is_large) {
      model_view_.show(inset.corner, inset.size, state_, trail_, false);
    } else {
      camera_view_.show(inset.corner, inset.size, state_);
    }
    layout::frame_inset(inset, window_.content_scale());
  }
  ImGui::End();
}

void PreviewWindow::show_panel(const layout::Area& area) {
  layout::begin_panel(area);
  PanelContents contents;
  if (!note_.empty()) status_.note = note_;
  contents.live = subject_.live != nullptr ? &status_ : nullptr;
  contents.facts = subject_.facts;
  contents.drawing_ms = pace_.work_ms();
  for (const ViewCommand command : show_side_panel(contents, state_, window_.fonts()))
    obey(command);
  ImGui::End();
}

std::optional<PatchNews> PreviewWindow::patch_news() {
  const auto vertex = model_view_.vertex_under_cursor();
  if (!vertex || state_.camera_is_large) return std::nullopt;
  PatchNews news;
  news.patch_idx = *vertex;
  const auto direction = core::direction_towards(
      core::tangent_frame(subject_.mesh.normals[*vertex]), subject_.mesh.positions[*vertex],
      core::eye_in_object(model_view_.camera().camera_from_object()));
  news.present_uv = direction.uv;
  if (subject_.live == nullptr) {
    const auto* const patches = fitting::as_patches(*subject_.light_field);
    if (patches == nullptr) return std::nullopt;
    news.colour_at = [patches, idx = *vertex](const Eigen::Vector2f& uv) -> Eigen::Vector3f {
      return patches->evaluate(idx, uv).colour();
    };
    return news;
  }
  const auto known = subject_.live->knowledge_of(*vertex);
  news.samples = known.samples;
  news.seen = known.seen;
  if (const auto* reachable = feed_->reachable()) news.reachable = (*reachable)[*vertex];
  return news;
}

void PreviewWindow::obey(ViewCommand command) {
  switch (command) {
    case ViewCommand::show_radiance:
      state_.layer = Layer::radiance;
      break;
    case ViewCommand::show_mesh:
      state_.layer = Layer::mesh;
      break;
    case ViewCommand::frame_object:
      model_view_.camera().frame();
      break;
    case ViewCommand::snapshot:
      snapshot_wanted_ = true;
      break;
    case ViewCommand::help:
      state_.help = !state_.help;
      break;
    case ViewCommand::quit:
      window_.close();
      break;
    default:
      if (subject_.live != nullptr) obey_session(command);
  }
}

void PreviewWindow::obey_session(ViewCommand command) {
  note_.clear();
  if (turns(state_, command)) return;
  switch (command) {
    case ViewCommand::show_needs_views:
      state_.layer = Layer::needs_views;
      break;
    case ViewCommand::show_misfit:
      state_.layer = Layer::misfit;
      break;
    case ViewCommand::pause:
      subject_.live->set_paused(status_.phase != LiveStatus::Phase::paused);
      break;
    case ViewCommand::undo:
      subject_.live->request_undo(kUndo_s);
      break;
    case ViewCommand::save:
      subject_.live->request_save();
      break;
    default:
      break;
  }
}

void PreviewWindow::save_snapshot() {
  image_ = window_.image();
  if (subject_.snapshot_folder.empty()) return;
  note_ = app::save_snapshot(image_, subject_.snapshot_folder);
}

}  // namespace sheen::app
