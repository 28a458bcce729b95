// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

namespace sheen::evaluation {

/// Gets one short line when a part of a study begins; what it throws ends the study.
using Progress = std::function<void(const std::string&)>;

}  // namespace sheen::evaluation
