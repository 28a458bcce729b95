// SPDX-License-Identifier: MIT
// A camera is recorded while the disk fills up, or the program is killed, at every write, or the
// power fails after every move: what is left is nothing, or a session that opens and holds images
// bit for bit, one after the other as they came, as many as were written (docs/trust.md).
#include "capture/session/session.h"
#include "capture/source/avi_reader.h"
#include "core/diagnostics/error.h"
#include "tests/app/program.h"
#include "tests/capture/scripted_http.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <optional>

namespace sheen::tests {
namespace {

namespace fs = std::filesystem;
using Images = std::vector<std::vector<std::uint8_t>>;

constexpr int kFrames = 3;
constexpr int kMostEvents = 200;

Images images_of(const fs::path& video) {
  Images images;
  auto reader = capture::AviReader::open(video);
  while (reader->advance()) {
    const auto bytes = reader->read();
    images.emplace_back(bytes.begin(), bytes.end());
  }
  return images;
}

class CaptureFaults : public ::testing::Test {
 protected:
  CaptureFaults() : like_(folder_ / "like") {
    const ProgramRun made =
        run_sheen({"synth", "matte", "-o", like_, "--size", "160x120", "--frames", "8",
                   "--held-out", "0", "--samples", "1", "--mesh-vertices", "500", "--quiet"});
    EXPECT_EQ(made.exit_code, 0) << made.standard_error;
    sent_ = images_of(like_ / "frames.avi");
  }

  /// Records into a new folder; `fault` as in fail_write.cpp.
  ProgramRun record(const std::string& fault) {
    fs::remove_all(walk_);
    capture::test::ScriptedHttp camera({[this](capture::test::HttpConnection& client) {
      client.begin_images();
      for (std::size_t i = 0; client.send_image(sent_[i % sent_.size()]); ++i) {
      }
    }});
    setenv("LD_PRELOAD", FAIL_WRITE_LIBRARY, 1);
    setenv("SHEEN_FAULT", fault.c_str(), 1);
    ProgramRun result = run_sheen({"capture", camera.address(), "-o", walk_, "--like", like_,
                                   "--frames", std::to_string(kFrames), "--headless",
                                   "--representation", "mean", "--threads", "1", "--quiet"});
    unsetenv("LD_PRELOAD");
    unsetenv("SHEEN_FAULT");
    return result;
  }

  /// How many images are there, each followed by the next; nothing where there is no session.
  std::optional<std::size_t> recorded() const {
    if (!fs::exists(walk_)) return std::nullopt;
    const capture::Session session = capture::open_session(walk_);
    const Images left = images_of(session.video.value());
    const auto number_of = [this](const auto& image) {
      return std::ranges::find(sent_, image) - sent_.begin();
    };
    const auto count = static_cast<std::ptrdiff_t>(sent_.size());
    for (std::size_t i = 0; i < left.size(); ++i) {
      EXPECT_LT(number_of(left[i]), count) << "image " << i << " is none that was sent";
      if (i > 0) {
        EXPECT_EQ((number_of(left[i - 1]) + 1) % count, number_of(left[i])) << i;
      }
    }
    return left.size();
  }

  TemporaryFolder folder_;
  fs::path like_;
  fs::path walk_ = folder_ / "walk";
  Images sent_;
};

TEST_F(CaptureFaults, KeepWhatWasWrittenBefore) {
  for (const std::string kind : {"full", "kill", "power"}) {
    std::optional<std::size_t> before;
    int n = 1;
    for (; n < kMostEvents; ++n) {
      SCOPED_TRACE(kind + ":" + std::to_string(n));
      const ProgramRun faulty = record(kind + ":" + std::to_string(n));
      const auto now = recorded();
      // One write more never leaves less; a killed fit leaves the whole recording.
      EXPECT_GE(now, before);
      before = now;
      if (faulty.exit_code == 0) break;
      if (kind == "full") {
        EXPECT_EQ(std::count(faulty.standard_error.begin(), faulty.standard_error.end(), '\n'), 1)
            << faulty.standard_error;
      }
      if (HasFailure()) return;
    }
    EXPECT_EQ(before, kFrames);
    EXPECT_TRUE(fs::exists(walk_ / "model.glb"));
    std::printf("  capture: %s at each of %d places\n", kind.c_str(), n - 1);
  }
}

}  // namespace
}  // namespace sheen::tests
