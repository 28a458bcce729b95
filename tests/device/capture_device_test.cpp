// SPDX-License-Identifier: MIT
#include "capture/source/avi_reader.h"
#include "tests/app/program.h"
#include "tests/device/loopback_player.h"
#include "tests/device/rig.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <future>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace sheen::capture {
namespace {

using namespace test;
using namespace std::chrono_literals;
using tests::read_file;
using tests::run_sheen;
using tests::TemporaryFolder;

using DeviceCapture = RigTest;

std::vector<std::vector<std::uint8_t>> compressed_images(const std::filesystem::path& video) {
  std::vector<std::vector<std::uint8_t>> images;
  auto reader = AviReader::open(video);
  while (reader && reader->advance()) {
    const auto bytes = reader->read();
    images.emplace_back(bytes.begin(), bytes.end());
  }
  return images;
}

/// Given to both: a replay would measure it, which a capture cannot before it has begun.
constexpr const char* kTexel_mm = "0.4";

/// Runs `sheen capture` on the loopback for so many images, as the sample session was recorded.
tests::ProgramRun capture(const std::string& session, int images) {
  return run_sheen({"capture", loopback_node, "-o", session, "--like", tests::sample_session(),
                    "--headless", "--frames", std::to_string(images), "--texel-mm", kTexel_mm,
                    "--json"});
}

/// The model that the capture fitted live is that of a replay of what it recorded.
void expect_replays_to_its_model(const std::string& session) {
  const TemporaryFolder folder;
  const std::string model = folder.path() / "model.glb";
  const auto replay = run_sheen({"replay", session, "-o", model, "--texel-mm", kTexel_mm});
  ASSERT_EQ(replay.exit_code, 0) << replay.standard_error;
  EXPECT_EQ(read_file(session + "/model.glb"), read_file(model));
}

TEST_F(DeviceCapture, AHeadlessCaptureGivesTheModelOfItsReplay) {
  const Recording recording = sample_recording();
  const TemporaryFolder folder;
  const std::string session = folder.path() / "session";
  {
    const LoopbackPlayer player(loopback_node, recording);
    const auto run = capture(session, 60);
    ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  }
  expect_replays_to_its_model(session);

  // What was recorded is what was played, bit for bit and without a gap.
  const auto recorded = compressed_images(session + "/frames.avi");
  ASSERT_EQ(recorded.size(), 60u);
  const auto& played = recording.images;
  const auto first = std::find(played.begin(), played.end(), recorded.front()) - played.begin();
  for (std::size_t n = 0; n < recorded.size(); ++n)
    EXPECT_EQ(recorded[n], played[(static_cast<std::size_t>(first) + n) % played.size()]);
}

TEST_F(DeviceCapture, ACaptureGoesOnInTheSameSessionWhenTheCameraIsBack) {
  const Recording recording = sample_recording();
  const TemporaryFolder folder;
  const std::string session = folder.path() / "session";
  // Two seconds of images after the settling, then none for longer than a camera may be silent.
  // Silence is what is tested, so time must pass; the rig's clock is simulated and passes exactly.
  std::optional<LoopbackPlayer> player(std::in_place, loopback_node, recording);
  auto cable = std::async(std::launch::async, [&] {
    std::this_thread::sleep_for(4s);
    player.reset();
    std::this_thread::sleep_for(8s);
    player.emplace(loopback_node, recording);
  });
  const auto run = capture(session, 90);
  cable.get();
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  const auto told = run.json()["recording"];
  EXPECT_EQ(told["recorded"], 90);
  EXPECT_EQ(told["reconnections"], 1);
  EXPECT_EQ(told["complete"], true);
  expect_replays_to_its_model(session);
}

}  // namespace
}  // namespace sheen::capture
