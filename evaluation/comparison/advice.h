// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/comparison/comparison.h"

#include <optional>
#include <span>
#include <string>

namespace sheen::evaluation {

/// What to use for recordings like these, and why.
struct Advice {
  std::string candidate;  ///< its name in the registry
  std::string sentence;
};

/// The smallest model within half a decibel of the most accurate one; one that jumps as the viewer
/// moves or leaves holes only where all of these do. What else speaks against it is said: its worst
/// view, edges, what it draws beside the object, memory. `rows` are the candidates' averages over
/// `sessions` recordings. Nothing when there are no rows.
std::optional<Advice> advise(std::span<const ComparedCandidate> rows, std::size_t sessions);

}  // namespace sheen::evaluation
