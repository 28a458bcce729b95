// SPDX-License-Identifier: MIT
#include "capture/pose/edge_search.h"

#include "capture/pose/edge_profile.h"
#include "capture/pose/rolling_shutter.h"
#include "core/numerics/median.h"

#include <algorithm>
#include <cmath>

namespace sheen::capture {
namespace {

// Stay clear of the corners, where two edges melt into each other.
constexpr double kFirst = 0.12;
constexpr double kLast = 0.88;

double position_along(std::size_t i, std::size_t count) {
  return kFirst + (kLast - kFirst) * static_cast<double>(i) / static_cast<double>(count - 1);
}

/// Sign of the step out of a tag.
int outward_sign(const TagView& view) {
  return view.tag().pattern.is_black_inside ? 1 : -1;
}

}  // namespace

double EdgeSearch::share_of(const EdgePoint& edge) const {
  return row_share(edge.px.y(), camera_.height_px());
}

void EdgeSearch::find_steps(const cv::Mat& grey, const std::vector<TagView>& views,
                            double reach_modules) {
  constexpr std::size_t positions = 4;
  constexpr double shortest_px = 3;
  constexpr double longest_px = 24;
  observations_.clear();
  for (const TagView& view : views) {
    for (std::size_t side = 0; side < 4; ++side) {
      const double half_length_px =
          std::clamp(reach_modules * view.module_px(side), shortest_px, longest_px);
      for (std::size_t i = 0; i < positions; ++i) {
        const auto edge = view.edge(camera_, side, position_along(i, positions));
        const auto profile =
            edge ? EdgeProfile::sample(grey, edge->px, edge->outward, half_length_px)
                 : std::nullopt;
        const auto step = profile ? profile->strongest_step_px(outward_sign(view)) : std::nullopt;
        if (step) observations_.push_back({edge->outward_by_twist, *step, share_of(*edge)});
      }
    }
  }
}

std::optional<double> EdgeSearch::measure_widths(const cv::Mat& grey,
                                                 const std::vector<TagView>& views) {
  // Motion widens only the edges it crosses: measure both pairs of sides of every tag.
  tag_widths_px_.clear();
  for (auto& widths : pair_widths_px_) widths.clear();
  for (const TagView& view : views) {
    double widest_px = 0;
    for (std::size_t pair = 0; pair < 2; ++pair) {
      measure_pair(grey, view, pair);
      if (room_.empty()) continue;
      const double width_px = core::upper_median(room_);
      pair_widths_px_[pair].push_back(width_px);
      widest_px = std::max(widest_px, width_px);
    }
    if (widest_px > 0) tag_widths_px_.push_back(widest_px);
  }

  // One width for all sides of a direction: a width of its own would make each side's place noisy.
  for (std::size_t pair = 0; pair < 2; ++pair) {
    auto& widths = pair_widths_px_[pair];
    width_px_[pair] = widths.empty() ? 0 : core::upper_median(widths);
  }
  if (tag_widths_px_.empty()) return std::nullopt;
  return core::upper_median(tag_widths_px_);
}

void EdgeSearch::measure_pair(const cv::Mat& grey, const TagView& view, std::size_t pair) {
  constexpr std::size_t positions = 3;
  room_.clear();
  for (const std::size_t side : {pair, pair + 2}) {
    const double half_length_px = std::clamp(0.9 * view.module_px(side), 1.5, 8.0);
    for (std::size_t i = 0; i < positions; ++i) {
      const auto edge = view.edge(camera_, side, position_along(i, positions));
      const auto profile =
          edge ? EdgeProfile::sample(grey, edge->px, edge->outward, half_length_px) : std::nullopt;
      const auto width_px = profile ? profile->rise_width_px() : std::nullopt;
      if (width_px) room_.push_back(*width_px);
    }
  }
}

EdgePositions EdgeSearch::measure_side(const cv::Mat& grey, const TagView& view, std::size_t side,
                                       const std::array<Eigen::Vector2d, 2>& outward,
                                       std::size_t wanted) const {
  // 1.25 times the rise is 3.2 standard deviations of a Gaussian blur: the step is over there.
  // Two thirds of a module reach neither the code inside nor the next tag outside.
  constexpr double shortest_px = 1.5;
  const double longest_px = std::max(0.65 * view.module_px(side), shortest_px);
  const double half_length_px = std::clamp(1.25 * width_px_[side % 2], shortest_px, longest_px);
  EdgePositions positions;
  for (std::size_t i = 0; i < wanted; ++i) {
    const double t = position_along(i, wanted);
    const auto px = view.point_px(camera_, side, t);
    const auto profile =
        px ? EdgeProfile::sample(grey, *px, outward[t < 0.5 ? 0 : 1], half_length_px)
           : std::nullopt;
    if (!profile || profile->polarity() != outward_sign(view)) continue;
    const auto position = profile->position_px();
    if (position && std::abs(*position) <= 0.8 * half_length_px) positions.add(t, *position);
  }
  return positions;
}

void EdgeSearch::find_sides(const cv::Mat& grey, const std::vector<TagView>& views) {
  constexpr double spacing_px = 2;
  constexpr double first_quarter = 0.25;
  constexpr double last_quarter = 0.75;
  observations_.clear();
  sides_.clear();
  for (std::size_t v = 0; v < views.size(); ++v) {
    for (std::size_t side = 0; side < 4; ++side) {
      const auto near_begin = views[v].edge(camera_, side, first_quarter);
      const auto near_end = views[v].edge(camera_, side, last_quarter);
      if (!near_begin || !near_end) continue;
      const std::array<Eigen::Vector2d, 2> outward{near_begin->outward, near_end->outward};
      const auto wanted = std::clamp<std::size_t>(
          static_cast<std::size_t>(views[v].side_px(side) / spacing_px), 6, 20);
      const EdgePositions positions = measure_side(grey, views[v], side, outward, wanted);
      if (2 * positions.count < wanted) continue;
      const auto line = fit_line(positions);
      if (!line) continue;
      sides_.push_back({v, side, *line, outward});
      observations_.push_back(
          {near_begin->outward_by_twist, line->at(first_quarter), share_of(*near_begin)});
      observations_.push_back(
          {near_end->outward_by_twist, line->at(last_quarter), share_of(*near_end)});
    }
  }
}

}  // namespace sheen::capture
