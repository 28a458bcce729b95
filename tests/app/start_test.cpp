// SPDX-License-Identifier: MIT
// The start window without a window: choices become commands, cameras are looked through.
#include "app/start/camera_looks.h"
#include "app/start/desktop_folders.h"
#include "app/start/running_command.h"
#include "app/start/start_commands.h"
#include "core/diagnostics/error.h"
#include "tests/app/playing_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <semaphore>

namespace sheen::tests {
namespace {

namespace fs = std::filesystem;
using app::Arguments;

class StartChoices : public testing::Test {
 protected:
  StartChoices() {
    choice_.sheet_folder = folder_.path();
    choice_.model_folder = folder_.path();
  }

  [[nodiscard]] std::string in(const std::string& name) const { return folder_.path() / name; }

  TemporaryFolder folder_;
  app::StartChoice choice_;
};

TEST_F(StartChoices, TheSheetIsThatOfItsPaper) {
  EXPECT_EQ(app::board_arguments(choice_), (Arguments{"board", "-o", in("sheen-board.pdf")}));
  choice_.paper = "letter";
  EXPECT_EQ(app::board_arguments(choice_),
            (Arguments{"board", "-o", in("sheen-board-letter.pdf"), "--paper", "letter"}));
}

/// What the window names is a command: the program takes it and writes the file that is opened.
TEST_F(StartChoices, TheSheetsCommandWritesTheFileThatIsPrinted) {
  choice_.paper = "letter";
  const ProgramRun run = run_sheen(app::board_arguments(choice_));
  EXPECT_EQ(run.exit_code, 0) << run.standard_error;
  EXPECT_TRUE(fs::exists(app::sheet_file(choice_)));
}

TEST_F(StartChoices, ACaptureNeedsACameraAndANameThatIsAFilesOwn) {
  EXPECT_FALSE(app::capture_arguments(choice_));
  choice_.camera = "/dev/video2";
  EXPECT_EQ(app::capture_arguments(choice_),
            (Arguments{"capture", "/dev/video2", "-o", in("object.glb")}));
  for (const char* name : {"", "..", "a/b", ".hidden"}) {
    choice_.name = name;
    EXPECT_FALSE(app::capture_arguments(choice_)) << name;
  }
}

TEST_F(StartChoices, ACaptureTakesANameThatNeitherAModelNorASessionHas) {
  choice_.camera = "/dev/video0";
  folder_.write("object.glb", "a model");
  fs::create_directory(in("object-2"));
  EXPECT_EQ(app::model_file(choice_), in("object-3.glb"));
}

TEST_F(StartChoices, WhatIsOpenedDecidesHow) {
  const auto model = folder_.write("knot.glb", "");
  EXPECT_EQ(app::open_arguments(model), (Arguments{"view", in("knot.glb")}));
  // A session beside its model, one with its model inside, one that has none.
  folder_.write("knot/session.json", "{}");
  EXPECT_EQ(app::open_arguments(in("knot")), (Arguments{"view", in("knot.glb")}));
  EXPECT_EQ(app::open_arguments(in("knot") + "/"), (Arguments{"view", in("knot.glb")}));
  folder_.write("vase/session.json", "{}");
  const Arguments made{"replay", in("vase"), "-o", in("vase/model.glb"), "--preview"};
  EXPECT_EQ(app::open_arguments(in("vase")), made);
  EXPECT_EQ(app::open_arguments(in("vase/session.json")), made);
  folder_.write("vase/model.glb", "");
  EXPECT_EQ(app::open_arguments(in("vase")), (Arguments{"view", in("vase/model.glb")}));
  // A film, pictures; their sessions and models take names that are free.
  folder_.write("Walk.MP4", "");
  EXPECT_EQ(app::open_arguments(in("Walk.MP4")),
            (Arguments{"replay", in("Walk.MP4"), "-o", in("Walk.glb"), "--preview"}));
  folder_.write("photos/1.jpg", "");
  EXPECT_EQ(app::open_arguments(in("photos")),
            (Arguments{"replay", in("photos"), "-o", in("photos-model.glb"), "--preview"}));
  // Neither.
  folder_.write("notes.txt", "");
  fs::create_directory(in("empty"));
  for (const char* name : {"notes.txt", "empty", "missing.glb"}) {
    EXPECT_FALSE(app::open_arguments(in(name))) << name;
  }
  EXPECT_FALSE(app::open_arguments(""));
}

TEST(AsTyped, IsWhatAShellReadsBack) {
  EXPECT_EQ(app::as_typed("sheen", {"view", "a.glb"}), "sheen view a.glb");
  EXPECT_EQ(app::as_typed("sheen", {"view", "my knot.glb"}), "sheen view 'my knot.glb'");
  // The shell itself is the other implementation: printf gives every word back on a line.
  const TemporaryFolder folder;
  const Arguments words{"it's", "a&b", "", "$HOME", "http://1.2.3.4:8080/video?a=1"};
  const auto out = folder.path() / "out";
  const std::string line = app::as_typed("printf", Arguments{"%s\\n"}) + " " +
                           app::as_typed(words[0], {words.begin() + 1, words.end()}) + " > " +
                           out.string();
  ASSERT_EQ(std::system(line.c_str()), 0);  // NOLINT(cert-env33-c): the shell is what is tested
  std::string expected;
  for (const std::string& word : words) expected += word + "\n";
  EXPECT_EQ(read_file(out), expected);
}

TEST(RecentFiles, NewestFirstOnceAndOnlyWhatIsThere) {
  const TemporaryFolder folder;
  setenv("XDG_STATE_HOME", folder.path().c_str(), 1);
  EXPECT_TRUE(app::recent_files().empty());
  const auto a = folder.write("a.glb", "");
  const auto b = folder.write("b.glb", "");
  app::note_recent_file(a);
  app::note_recent_file(b);
  app::note_recent_file(a);
  EXPECT_EQ(app::recent_files(), (std::vector<fs::path>{a, b}));
  fs::remove(a);
  EXPECT_EQ(app::recent_files(), std::vector<fs::path>{b});
  unsetenv("XDG_STATE_HOME");
}

app::CameraAccess played_cameras() {
  return {.list =
              [] {
                return std::vector<capture::CameraListing>{
                    {.device = "/dev/played", .name = "Player"},
                    {.device = "/dev/locked", .name = "Locked", .fault = "belongs to another"}};
              },
          .open = [](const std::string& address) -> std::unique_ptr<capture::Camera> {
            if (address == "/dev/played") return std::make_unique<PlayingCamera>();
            throw core::bad_input(address, "leads nowhere", "check it");
          }};
}

TEST(CameraLooks, ShowWhatACameraSeesOrWhyNot) {
  const auto cameras = played_cameras();
  const app::CameraLook seen = app::look_through(cameras, "/dev/played", "");
  EXPECT_EQ(seen.name, "Player");
  EXPECT_EQ(seen.fault, "");
  EXPECT_EQ(seen.picture.size(), cv::Size(640, 360));
  EXPECT_FALSE(seen.is_due);
  const app::CameraLook none = app::look_through(cameras, "http://nobody/", "");
  EXPECT_EQ(none.fault, "http://nobody/: leads nowhere; check it");
  EXPECT_TRUE(none.picture.empty());
}

/// A listed camera with a fault is shown, never opened; an address that is given joins the list.
TEST(CameraLooks, GoThroughListedAndAddedCamerasOnAThreadOfTheirOwn) {
  std::counting_semaphore<> news(0);
  app::CameraLooks looks(played_cameras(), [&] { news.release(); });
  looks.add("http://nobody/");
  const auto is_done = [&] {
    const auto all = looks.looks();
    return all.size() == 3 &&
           std::ranges::none_of(all, [](const app::CameraLook& look) { return look.is_due; });
  };
  while (!is_done()) news.acquire();  // ctest ends what never comes
  for (const app::CameraLook& look : looks.looks()) {
    if (look.address == "/dev/played") {
      EXPECT_FALSE(look.picture.empty());
    } else if (look.address == "/dev/locked") {
      EXPECT_EQ(look.fault, "belongs to another");
    } else {
      EXPECT_EQ(look.address, "http://nobody/");
      EXPECT_NE(look.fault.find("leads nowhere"), std::string::npos);
    }
  }
}

TEST(CameraLooks, EndWhileCamerasAreDue) {
  for (int i = 0; i < 20; ++i) {
    app::CameraLooks looks(played_cameras());
    looks.add("http://nobody/");
  }
}

}  // namespace
}  // namespace sheen::tests
