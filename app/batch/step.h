// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace sheen::app {

/// What is done with a session, in this order: each is the command of its name.
enum class Step { survey, register_mesh, replay, evaluate, export_model };

inline constexpr std::array kAllSteps{Step::survey, Step::register_mesh, Step::replay,
                                      Step::evaluate, Step::export_model};

/// The name of the command.
constexpr std::string_view name_of(Step step) {
  switch (step) {
    case Step::survey:
      return "survey";
    case Step::register_mesh:
      return "register";
    case Step::replay:
      return "replay";
    case Step::evaluate:
      return "evaluate";
    case Step::export_model:
      return "export";
  }
  return {};
}

constexpr std::optional<Step> step_named(std::string_view name) {
  for (const Step step : kAllSteps) {
    if (name_of(step) == name) return step;
  }
  return std::nullopt;
}

}  // namespace sheen::app
