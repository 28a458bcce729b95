// SPDX-License-Identifier: MIT
#pragma once

#include "core/diagnostics/error.h"

#include <gtest/gtest.h>

#include <string>

namespace sheen::capture::test {

/// `action` must throw core::Error (bad_input) on one line that contains every given word.
template <typename Action, typename... Words>
void expect_bad_input(const Action& action, const Words&... words) {
  try {
    action();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const core::Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(error.kind(), core::Error::Kind::bad_input) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& word : {std::string(words)...}) {
      EXPECT_NE(message.find(word), std::string::npos) << message << " lacks " << word;
    }
  }
}

}  // namespace sheen::capture::test
