// SPDX-License-Identifier: MIT
#include "app/state/joined_model.h"

#include "app/interrupt.h"
#include "core/diagnostics/error.h"
#include "fitting/model_file/model_file.h"
#include "fitting/state/level_walks.h"

#include <fmt/format.h>

#include <map>

namespace sheen::app {
namespace {

fitting::ViewsDone shower(Progress& progress) {
  return [&progress](std::size_t views) {
    throw_if_interrupted();
    progress.show(static_cast<int>(views));
  };
}

struct Frames {
  int count = 0;
  int first = 0;
  int last = 0;
};

/// What was done about walks of different exposure.
nlohmann::ordered_json exposure_json(const fitting::WalkLevels& levels) {
  nlohmann::ordered_json walks = nlohmann::json::array();
  for (const fitting::LevelledWalk& walk : levels.walks) {
    walks.push_back({{"session", walk.session}, {"views", walk.views}, {"gain", walk.gain}});
  }
  return {{"levelled", levels.is_used},
          {"held_out_rmse", levels.trial ? nlohmann::ordered_json(levels.trial->as_is) : nullptr},
          {"held_out_rmse_levelled",
           levels.trial ? nlohmann::ordered_json(levels.trial->levelled) : nullptr},
          {"walks", std::move(walks)}};
}

std::string exposure_text(const fitting::WalkLevels& levels) {
  if (!levels.trial) return {};
  std::string text = fmt::format(
      "exposure {}: error of held-out views {:.4f} as they are, {:.4f} levelled\n",
      levels.is_used ? "levelled" : "left as it is", levels.trial->as_is, levels.trial->levelled);
  for (const fitting::LevelledWalk& walk : levels.walks) {
    text += fmt::format("         {}: light times {:.3f} {:.3f} {:.3f}\n", walk.session,
                        walk.gain[0], walk.gain[1], walk.gain[2]);
  }
  return text;
}

/// In the order of the names.
std::map<std::string, Frames> frames_by_session(const States& states,
                                                std::span<const fitting::JoinedView> views) {
  std::map<std::string, Frames> sessions;
  for (const fitting::JoinedView& view : views) {
    if (states[view.state]->header().share.number > 1) continue;  // counted with the first share
    const fitting::StateView& name = states[view.state]->views()[view.view];
    Frames& frames =
        sessions.try_emplace(name.session, Frames{0, name.frame, name.frame}).first->second;
    ++frames.count;
    frames.first = std::min(frames.first, name.frame);
    frames.last = std::max(frames.last, name.frame);
  }
  return sessions;
}

}  // namespace

void write_joined_model(const States& states, std::span<const fitting::JoinedView> views,
                        const JoinedOutputs& outputs, const CommandContext& context) {
  nlohmann::ordered_json document{{"views", 0}, {"sessions", nlohmann::json::array()}};
  int whole_views = 0;
  std::string text;
  for (const auto& [name, frames] : frames_by_session(states, views)) {
    whole_views += frames.count;
    document["sessions"].push_back({{"name", name},
                                    {"views", frames.count},
                                    {"first_frame", frames.first},
                                    {"last_frame", frames.last}});
    text += fmt::format("{}  {} views, frames {} to {}\n", name, frames.count, frames.first,
                        frames.last);
  }
  document["views"] = whole_views;
  // The model first: when this ends between the two, the old state still gives both.
  const int count = static_cast<int>(views.size());
  if (!outputs.model.empty()) {
    const fitting::WalkLevels levels = [&] {
      Progress progress = context.progress("comparing walks", count);
      return fitting::level_walks(states, views, context.threads, shower(progress));
    }();
    Progress progress = context.progress("fitting", count);
    const fitting::JoinedFit fit =
        fitting::fit_joined(states, views, levels, context.threads, shower(progress));
    fitting::write_model(outputs.model, states.front()->header().mesh, fit.fitter->light_field(),
                         fit.seen);
    document["samples"] = fit.fitter->statistics().samples;
    document["exposure"] = exposure_json(levels);
    text += exposure_text(levels);
    document["representation"] = states.front()->header().representation;
    document["model"] = outputs.model.string();
    text += fmt::format("written  {}\n", outputs.model.string());
  }
  if (!outputs.state.empty()) {
    Progress progress = context.progress("writing", count);
    fitting::write_joined(outputs.state, states, views, shower(progress));
    document["state"] = outputs.state.string();
    text += fmt::format("written  {}\n", outputs.state.string());
  }
  context.publish(document, text);
}

std::string fault_of_model_name(const std::string& path) {
  return path.ends_with(".glb") ? std::string() : path + " does not end in .glb";
}

}  // namespace sheen::app
