// SPDX-License-Identifier: MIT
#pragma once

#include "tests/app/program.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>

namespace sheen::tests {

/// A copy of the sample session, whose files a test may change, and the name of a model.
class CopiedSession : public testing::Test {
 protected:
  CopiedSession() : session_(folder_.path() / "session"), model_(folder_.path() / "model.glb") {
    std::filesystem::create_directories(session_);
    for (const char* name :
         {"session.json", "camera.yaml", "board.yaml", "object.ply", "frames.avi"}) {
      std::filesystem::copy_file(sample_session() / name, session_ / name);
    }
  }

  /// Every match of `pattern`, of which there is at least one.
  void replace(const std::string& file, const std::string& pattern, const std::string& by) const {
    const std::string before = read_file(session_ / file);
    const std::string after = std::regex_replace(before, std::regex(pattern), by);
    ASSERT_NE(before, after) << pattern << " is not in " << file;
    write_file(session_ / file, after);
  }

  TemporaryFolder folder_;
  std::filesystem::path session_;
  std::filesystem::path model_;
};

}  // namespace sheen::tests
