// SPDX-License-Identifier: MIT
#include "app/preview/walk_window.h"

#include "app/preview/commands.h"
#include "app/preview/panel_words.h"
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

WalkWindow::ShownHull::ShownHull(Window& window, std::shared_ptr<const core::Mesh> hull)
    : mesh(std::move(hull)),
      painter(window, window.gl(), *mesh),
      view(window.gl(), *mesh, Eigen::Vector3d::UnitZ(), true) {}

WalkWindow::WalkWindow(WalkSubject subject)
    : subject_(std::move(subject)),
      window_(subject_.title, layout::kWidth, layout::kHeight),
      camera_view_(window_.gl()) {}

bool WalkWindow::redraw(double longest_wait_s) {
  window_.begin_redraw(longest_wait_s);
  for (const KeyPress& press : window_.key_presses()) obey(press);
  take_news();
  if (hull_) {
    hull_->view.paint(hull_->painter, Layer::mesh, false);
    camera_view_.paint(hull_->painter, state_);
  }
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
  if (news_.hull && (!hull_ || hull_->mesh != news_.hull)) show_hull(news_.hull);
}

void WalkWindow::show_hull(std::shared_ptr<const core::Mesh> hull) {
  auto next = std::make_unique<ShownHull>(window_, std::move(hull));
  if (hull_) {
    const double before_m = hull_->view.camera().object_radius_m();
    const double after_m = next->view.camera().object_radius_m();
    if (std::abs(after_m - before_m) < kSameSize * before_m) {
      next->view.camera() = hull_->view.camera();
    }
  }
  hull_ = std::move(next);
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
  if (!hull_) {
    camera_view_.show(area.corner, area.size, state_);
  } else if (state_.camera_is_large) {
    camera_view_.show(area.corner, area.size, state_);
    hull_->view.show(inset.corner, inset.size, state_, trail_, false);
  } else {
    hull_->view.show(area.corner, area.size, state_, trail_, true);
    camera_view_.show(inset.corner, inset.size, state_);
  }
  if (hull_) layout::frame_inset(inset, window_.content_scale());
  ImGui::End();
}

void WalkWindow::show_panel(const layout::Area& area) const {
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
  heading("Shape");
  if (!news_.doubt.empty()) {
    wrapped(theme::kWarning, news_.doubt);
  } else if (!news_.hull) {
    wrapped(theme::kQuiet, "Appears once the object was seen from eight directions");
  } else if (news_.is_settled) {
    wrapped(theme::kGood, "Settled: further views add appearance");
  } else {
    wrapped(theme::kQuiet, "Growing: go all the way round, low views too");
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

void WalkWindow::obey(const KeyPress& press) {
  const auto command = command_of(press);
  if (!command || turns(state_, *command)) return;
  switch (*command) {
    case ViewCommand::frame_object:
      if (hull_) hull_->view.camera().frame();
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
