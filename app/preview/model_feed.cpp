// SPDX-License-Identifier: MIT
#include "app/preview/model_feed.h"

#include <utility>

namespace sheen::app {
namespace {

constexpr std::size_t kBytesPerRedraw = 512 * 1024;

}  // namespace

void ModelFeed::take_news(std::vector<Eigen::Isometry3d>& path) {
  auto news = live_.path_since(path.size(), generation_);
  if (std::exchange(generation_, news.generation) != news.generation) path.clear();
  path.insert(path.end(), news.poses.begin(), news.poses.end());
  if (auto advice = live_.take_advice()) {
    painter_.set_scores(std::move(advice->scores));
    reachable_ = std::move(advice->reachable);
  }
}

void ModelFeed::look(const std::function<void()>& draw) {
  live_.try_look([&](const fitting::LightField& light_field, const fitting::ModelUpdate& changes,
                     std::size_t undos) {
    if (!has_model_ || undos != undos_) {
      painter_.show(light_field);
      has_model_ = true;
      undos_ = undos;
    } else {
      painter_.note_changes(changes);
    }
    painter_.send_changes(kBytesPerRedraw);
    if (painter_.draws_from_model()) draw();
  });
}

}  // namespace sheen::app
