// SPDX-License-Identifier: MIT
#pragma once

#include "capture/source/network_camera.h"
#include "core/diagnostics/error.h"

#include <gtest/gtest.h>

#include <string>

namespace sheen::capture::test {

/// What a camera says that cannot be opened: one line without the password, which is "secret".
inline std::string refusal(const NetworkCameraOptions& options) {
  try {
    NetworkCamera camera(options);
  } catch (const core::Error& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    EXPECT_EQ(what.find("secret"), std::string::npos) << what;
    return what;
  }
  ADD_FAILURE() << "was opened";
  return {};
}

inline bool has(const std::string& text, const std::string& word) {
  EXPECT_NE(text.find(word), std::string::npos) << text << " lacks " << word;
  return text.find(word) != std::string::npos;
}

}  // namespace sheen::capture::test
