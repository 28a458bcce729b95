// SPDX-License-Identifier: MIT
#include "app/preview/walk_window.h"

#include "app/preview/commands.h"
#include "app/preview/panel_words.h"
#include "app/preview/side_panel.h"
#include "app/preview/snapshot.h"
#include "app/preview/theme.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace sheen::app {
namespace {

using reconstruction::kViewDirections;

constexpr double kSameSize = 0.2;  // of the radius: a new hull is seen as the one before was

}  // namespace

WalkWindow::ShownObject::ShownObject(Window& window, const core::Mesh& mesh)
    : painter(window, window.gl(), mesh), view(window.gl(), mesh, Eigen::Vector3d::UnitZ(), true) {}

WalkWindow::WalkWindow(WalkSubject subject)
    : subject_(std::move(subject)),
      window_(subject_.title, layout::kWidth, layout::kHeight),
      camera_view_(window_.gl()) {}

bool WalkWindow::redraw(double longest_wait_s) {
  window_.begin_redraw(longest_wait_s);
  for (const KeyPress& press : window_.key_presses()) {
    if (const auto command = command_of(press)) obey(*command);
  }
  take_news();
  paint();
  lay_out();
  window_.draw();
  if (std::exchange(snapshot_wanted_, false)) {
    note_ = save_snapshot(window_.image(), subject_.snapshot_folder);
  }
  window_.show();
  return !window_.wants_to_close();
}

void WalkWindow::take_news() {
  const int known = sight_.frames;
  sight_ = subject_.walk.sight();
  if (sight_.frames != known) {
    camera_view_.take(sight_.image, sight_.camera, sight_.camera_from_board);
    if (sight_.camera_from_board) {
      trail_.present = sight_.camera_from_board;
      trail_.poses.push_back(*sight_.camera_from_board);
    }
    look_for_missing();
  }
  trail_.lens = &sight_.camera;
  news_ = subject_.hull.news();
  const bool is_hull = !object_ || !object_->growth;
  if (auto growth = subject_.model != nullptr ? subject_.model->growth() : nullptr) {
    if (is_hull) show_light_field(std::move(growth));
    take_light_field_news();
  } else if (news_.hull && (!object_ || object_->hull != news_.hull)) {
    show_hull(news_.hull);
  }
}

void WalkWindow::show_hull(std::shared_ptr<const core::Mesh> hull) {
  auto next = std::make_unique<ShownObject>(window_, *hull);
  next->hull = std::move(hull);
  show_instead(std::move(next));
}

void WalkWindow::show_light_field(std::shared_ptr<WalkModel::Growth> growth) {
  auto next = std::make_unique<ShownObject>(window_, growth->live->mesh());
  next->feed.emplace(*growth->live, next->painter);
  next->growth = std::move(growth);
  show_instead(std::move(next));
  state_.layer = Layer::radiance;
}

/// Seen as the one before was, where both are of about one size.
void WalkWindow::show_instead(std::unique_ptr<ShownObject> next) {
  if (object_) {
    const double before_m = object_->view.camera().object_radius_m();
    const double after_m = next->view.camera().object_radius_m();
    if (std::abs(after_m - before_m) < kSameSize * before_m) {
      next->view.camera() = object_->view.camera();
    }
  }
  object_ = std::move(next);
}

void WalkWindow::take_light_field_news() {
  status_ = object_->growth->live->status();
  object_->feed->take_news(object_->fitted);
  if (!object_->painter.draws_from_model()) object_->feed->look([this] { paint_views(); });
  // Directions first: what the light field asks for comes after somebody has looked from
  // everywhere.
  if (trail_.missing.empty()) trail_.hint = status_.hint;
}

void WalkWindow::paint() {
  if (!object_) return;
  if (object_->feed && object_->painter.draws_from_model()) {
    object_->feed->look([this] { paint_views(); });
  } else {
    paint_views();
  }
}

void WalkWindow::paint_views() {
  object_->view.paint(object_->painter, state_.layer, true);
  camera_view_.paint(object_->painter, state_);
}

void WalkWindow::look_for_missing() {
  trail_.missing.clear();
  trail_.hint.reset();
  for (const std::size_t direction : sight_.missing) {
    trail_.missing.push_back(reconstruction::middle_of_direction(direction));
  }
  if (!trail_.present || !sight_.middle || trail_.missing.empty()) return;
  const Eigen::Vector3d towards_eye = trail_.present->inverse().translation() - *sight_.middle;
  const auto nearest = std::ranges::max_element(
      trail_.missing, {}, [&](const Eigen::Vector3d& way) { return way.dot(towards_eye); });
  trail_.hint = *sight_.middle + towards_eye.norm() * *nearest;
}

void WalkWindow::lay_out() {
  show_views(layout::views_area(window_.content_scale()));
  show_panel(layout::panel_area(window_.content_scale()));
}

void WalkWindow::show_views(const layout::Area& area) {
  layout::begin_views(area);
  const layout::Area inset = layout::inset_area(area, sight_.camera, window_.content_scale());
  if (!object_) {
    camera_view_.show(area.corner, area.size, state_);
  } else if (state_.camera_is_large) {
    camera_view_.show(area.corner, area.size, state_);
    object_->view.show(inset.corner, inset.size, state_, trail_, false);
  } else {
    object_->view.show(area.corner, area.size, state_, trail_, true);
    camera_view_.show(inset.corner, inset.size, state_);
  }
  if (object_) layout::frame_inset(inset, window_.content_scale());
  ImGui::End();
}

void WalkWindow::show_panel(const layout::Area& area) {
  layout::begin_panel(area);
  ImGui::PushFont(window_.fonts().large);
  text(theme::kText, "Recording");
  ImGui::PopFont();
  if (!sight_.middle) {
    wrapped(theme::kAlarm, "The sheet is not in view");
  } else if (!sight_.camera_from_board) {
    wrapped(theme::kAlarm, "Too few tags in view");
  } else {
    wrapped(theme::kQuiet, trail_.hint ? "Follow the amber arrow" : "Seen from all sides");
  }
  if (object_ && object_->growth) {
    show_light_field_state();
    std::vector<ViewCommand> clicks;
    show_layers(state_, true, clicks);
    for (const ViewCommand click : clicks) obey(click);
  } else {
    show_shape_state();
  }
  heading("Directions");
  row("seen", fmt::format("{} of {}", kViewDirections - sight_.missing.size(), kViewDirections));
  text(theme::kWarning, "amber dots: still missing");
  gap(0.6f);
  wrapped(theme::kQuiet,
          "Close the window when you are round: camera, shape and light field are made from the "
          "recording.");
  if (!note_.empty()) wrapped(theme::kQuiet, note_);
  ImGui::End();
}

void WalkWindow::show_shape_state() const {
  heading("Shape");
  if (!news_.doubt.empty()) {
    wrapped(theme::kWarning, news_.doubt);
  } else if (!news_.hull) {
    wrapped(theme::kQuiet, "Appears once the object was seen from eight directions");
  } else if (news_.is_settled) {
    wrapped(theme::kGood, "Settled: once round, the light field begins");
  } else {
    wrapped(theme::kQuiet, "Growing: go all the way round, low views too");
  }
  const std::string doubt = subject_.model != nullptr ? subject_.model->doubt() : "";
  if (!doubt.empty()) wrapped(theme::kWarning, doubt);
}

void WalkWindow::show_light_field_state() const {
  heading("Light field so far");
  row("frames in it", fmt::format("{}", status_.frames_fitted));
  if (status_.is_flat) wrapped(theme::kGood, "Quality no longer rises: you may stop");
  wrapped(theme::kQuiet, "A preview: the one that is kept is made from the whole recording.");
  show_coverage(status_.coverage, window_.fonts());
}

void WalkWindow::obey(ViewCommand command) {
  if (turns(state_, command)) return;
  const bool has_layers = object_ && object_->growth;
  switch (command) {
    case ViewCommand::show_radiance:
      if (has_layers) state_.layer = Layer::radiance;
      break;
    case ViewCommand::show_needs_views:
      if (has_layers) state_.layer = Layer::needs_views;
      break;
    case ViewCommand::show_misfit:
      if (has_layers) state_.layer = Layer::misfit;
      break;
    case ViewCommand::show_mesh:
      state_.layer = Layer::mesh;
      break;
    case ViewCommand::frame_object:
      if (object_) object_->view.camera().frame();
      break;
    case ViewCommand::snapshot:
      snapshot_wanted_ = true;
      break;
    case ViewCommand::quit:
      window_.close();
      break;
    default:
      break;
  }
}

}  // namespace sheen::app
