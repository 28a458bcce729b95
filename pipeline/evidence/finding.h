// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sheen::pipeline {

/// Something about a recording that its own data contradict, or that they show to be too little.
struct Finding {
  std::string cause;  ///< a name for programs: "exposure-drift"
  std::string line;   ///< for people: what is seen, and what to do
};

}  // namespace sheen::pipeline
