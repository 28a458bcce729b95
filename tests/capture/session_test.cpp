// SPDX-License-Identifier: MIT
#include "capture/session/session.h"

#include "capture/calibration/camera_file.h"
#include "capture/pose/board.h"
#include "capture/session/session_file.h"
#include "tests/capture/expect_bad_input.h"
#include "tests/capture/rendered_board.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

namespace sheen::capture::test {
namespace {

using nlohmann::json;
using tests::TemporaryFolder;

constexpr int kWidth = 64;
constexpr int kHeight = 48;
constexpr int kFrames = 40;

/// Frames are told apart by their brightness, in steps that lossy compression keeps.
cv::Mat frame_image(int index) {
  return {kHeight, kWidth, CV_8UC3, cv::Scalar::all(20 + 5 * index)};
}

int index_of(const cv::Mat& image) {
  return static_cast<int>(std::lround((cv::mean(image)[0] - 20) / 5));
}

/// A complete session in a scratch folder, with a JSON document to spoil.
class SessionFiles {
 public:
  SessionFiles() {
    write_camera(scratch_.path() / "camera.yaml", make_camera(kWidth, kHeight, false));
    write_board(scratch_.path() / "board.yaml", make_grid_board("tag36h11", 2, 2, 0.04, 0.05));
    scratch_.write("object.ply", "ply\n");
    document = json::parse(R"({"format": "sheen-session", "version": 1,
      "frames": {"images": "images/%04d.png"}, "camera": "camera.yaml", "board": "board.yaml",
      "object": {"mesh": "object.ply", "T_stage_object": [1,0,0,0.5, 0,1,0,0, 0,0,1,0, 0,0,0,1]}})");
  }

  [[nodiscard]] const std::filesystem::path& folder() const { return scratch_.path(); }
  void write(const std::string& name, const std::string& text) const { scratch_.write(name, text); }

  [[nodiscard]] Session open() const {
    scratch_.write("session.json", document.dump());
    return open_session(scratch_.path());
  }

  template <typename... Words>
  void expect_refused(const Words&... words) const {
    expect_bad_input([&] { static_cast<void>(open()); }, words...);
  }

  void write_images(int first, int count) const {
    std::filesystem::create_directories(folder() / "images");
    for (int i = 0; i < count; ++i) cv::imwrite(image_path(first + i).string(), frame_image(i));
  }

  [[nodiscard]] std::filesystem::path image_path(int number) const {
    const std::string digits = std::to_string(number);
    return folder() / "images" / (std::string(4 - digits.size(), '0') + digits + ".png");
  }

  void write_video() {
    cv::VideoWriter writer((folder() / "frames.avi").string(), cv::CAP_OPENCV_MJPEG,
                           cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25, {kWidth, kHeight});
    ASSERT_TRUE(writer.isOpened());
    for (int i = 0; i < kFrames; ++i) writer.write(frame_image(i));
    writer.release();
    document["frames"] = {{"video", "frames.avi"}};
  }

  json document;

 private:
  TemporaryFolder scratch_;
};

std::vector<int> read_all(FrameSource& source) {
  std::vector<int> seen;
  while (const auto frame = source.next()) {
    EXPECT_EQ(frame->index, index_of(frame->image));
    seen.push_back(frame->index);
  }
  return seen;
}

std::vector<int> range(int begin, int end) {
  std::vector<int> numbers;
  for (int i = begin; i < end; ++i) numbers.push_back(i);
  return numbers;
}

TEST(Session, SaysWhatIsWrongWithItsText) {
  const SessionFiles files;
  const std::string text = files.document.dump();
  const auto refuse = [&](const std::string& by, const std::string& cause) {
    files.write("session.json", by);
    expect_bad_input([&] { static_cast<void>(open_session(files.folder())); }, "session.json",
                     cause);
  };
  refuse("", "is empty");
  refuse("{\"version\": 1, " + text.substr(1), "\"version\" twice");
  refuse("{\"size\": 1e400, " + text.substr(1), "too large");
}

TEST(Session, PathsOfWindowsAreRead) {
  SessionFiles files;
  std::filesystem::create_directories(files.folder() / "meshes");
  std::filesystem::rename(files.folder() / "object.ply", files.folder() / "meshes" / "toy.ply");
  files.document["object"]["mesh"] = "meshes\\toy.ply";
  EXPECT_EQ(files.open().mesh, files.folder() / "meshes/toy.ply");
  files.document["object"]["mesh"] = "meshes\\..\\..\\toy.ply";
  files.expect_refused("leaves the session folder");
  files.document["object"]["mesh"] = "meshes/Toy.PLY";
  files.expect_refused("the folder holds toy.ply");
}

TEST(Session, ImagesOfOtherNamesAreToldWithTheirPattern) {
  SessionFiles files;
  files.write_images(0, 3);
  const auto refuse = [&](const std::string& pattern, const std::string& word) {
    files.document["frames"]["images"] = pattern;
    expect_bad_input([&] { open_frames(files.open()); }, word);
  };
  refuse("images/%04d.jpg", "write \"images\": \"images/%04d.png\"");
  refuse("images/%d.png", "images/%04d.png");
  refuse("pictures/%04d.png", "no such folder");
  for (int i = 0; i < 3; ++i) {
    std::filesystem::rename(files.image_path(i),
                            files.folder() / "images" / ("IMG_" + std::to_string(98 + i) + ".PNG"));
  }
  refuse("images/%04d.png", "images/IMG_%d.PNG");
  refuse("images/IMG_%d.PNG", "IMG_98.PNG: is the first image");
}

TEST(Session, DoubtfulCamerasAreNoted) {
  SessionFiles files;
  const auto warnings = [&](double cx, double cy, double p1) {
    core::CameraModel::Intrinsics lens = make_camera(kWidth, kHeight, false).intrinsics();
    lens.principal_px = {cx, cy};
    lens.distortion[2] = p1;
    write_camera(files.folder() / "camera.yaml", core::CameraModel(lens));
    std::string all;
    for (const std::string& warning : files.open().warnings) all += warning;
    return all;
  };
  EXPECT_EQ(warnings(33, 22, 0.002), "");
  EXPECT_NE(warnings(16, 40, 0).find("principal point"), std::string::npos);
  EXPECT_NE(warnings(23.5, 37, 0).find("cx and cy exchanged"), std::string::npos);
  EXPECT_NE(warnings(33, 22, 0.08).find("order of the coefficients"), std::string::npos);
}

TEST(Session, ReadsACompleteOne) {
  SessionFiles files;
  files.document["frames"]["fps"] = 15;
  const Session session = files.open();
  EXPECT_EQ(session.image_pattern, "images/%04d.png");
  EXPECT_FALSE(session.video);
  EXPECT_EQ(session.fps, 15);
  EXPECT_EQ(session.camera.width_px(), kWidth);
  EXPECT_EQ(session.board, files.folder() / "board.yaml");
  EXPECT_FALSE(session.poses);
  EXPECT_EQ(session.board_from_object.translation(), Eigen::Vector3d(0.5, 0, 0));
  EXPECT_TRUE(session.warnings.empty());
}

TEST(Session, WarnsOnceAboutEachUnknownKey) {
  SessionFiles files;
  files.document["colour\n"] = 1;
  files.document["frames"]["codec"] = "mjpg";
  files.document["object"]["name"] = "x";
  const Session session = files.open();
  ASSERT_EQ(session.warnings.size(), 3U);
  for (const std::string& warning : session.warnings) {
    EXPECT_EQ(warning.find('\n'), std::string::npos) << warning;
  }
}

TEST(Session, RefusesOtherFormatsAndLaterVersions) {
  SessionFiles files;
  files.document["version"] = 2;
  files.expect_refused("session.json", "version 2", "newer");
  files.document["version"] = "1";
  files.expect_refused("version");
  files.document["version"] = 1;
  files.document["format"] = "other";
  files.expect_refused("format");
  files.document = json::array();
  files.expect_refused("object");
  files.write("session.json", "{\"format\": ");
  expect_bad_input([&] { open_session(files.folder()); }, "session.json");
  expect_bad_input([&] { open_session(files.folder() / "none"); }, "none", "no such session");
}

TEST(Session, RefusesPathsThatLeaveTheFolder) {
  for (const char* path : {"../board.yaml", "/etc/passwd", "a/../../b", "..", ".."}) {
    SessionFiles files;
    files.document["board"] = path;
    files.expect_refused("session.json", "board", "leaves");
  }
  SessionFiles files;
  files.document["frames"]["images"] = "../%04d.png";
  files.expect_refused("images", "leaves");
}

TEST(Session, NamesMissingFiles) {
  for (const char* key : {"camera", "board", "poses"}) {
    SessionFiles files;
    files.document[key] = "absent.txt";
    files.expect_refused("absent.txt", "no such file");
  }
  SessionFiles files;
  files.document["frames"] = {{"video", "absent.avi"}};
  files.expect_refused("absent.avi", "no such file");
  files.document["frames"] = {{"images", "images/%04d.png"}};
  files.document["object"]["mesh"] = "absent.ply";
  files.expect_refused("absent.ply");
}

TEST(Session, MayBeWithoutAnObjectUntilOneIsMade) {
  SessionFiles files;
  files.document.erase("object");
  EXPECT_TRUE(files.open().mesh.empty());
  const auto file = files.folder() / "session.json";
  write_object(file, file, "object.ply");
  const Session session = open_session(files.folder());
  EXPECT_EQ(session.mesh, files.folder() / "object.ply");
  EXPECT_TRUE(session.board_from_object.isApprox(Eigen::Isometry3d::Identity(), 0));
  EXPECT_TRUE(session.warnings.empty());
}

TEST(Session, NeedsOneKindOfFramesAndOneKindOfPose) {
  SessionFiles files;
  files.document["frames"]["video"] = "frames.avi";
  files.expect_refused("exactly one");
  files.document["frames"] = json::object();
  files.expect_refused("exactly one");
  files.document["frames"] = {{"images", "images/%n.png"}};
  files.expect_refused("pattern");
  files.document["frames"] = {{"images", "images/%04d.png"}, {"fps", -1}};
  files.expect_refused("fps");
  files.document["frames"].erase("fps");
  files.document.erase("board");
  files.expect_refused("board", "poses");
}

TEST(Session, RefusesTransformsThatAreNotRigid) {
  const auto expect = [](const std::vector<double>& T, const char* word) {
    SessionFiles files;
    files.document["object"]["T_stage_object"] = T;
    files.expect_refused("T_stage_object", word);
  };
  expect({0.001, 0, 0, 0, 0, 0.001, 0, 0, 0, 0, 0.001, 0, 0, 0, 0, 1}, "scales by 0.001");
  expect({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1}, "mirrors");
  expect({1, 0.5, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "shears");
  expect({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}, "shears");
  expect({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.5, 0, 0, 1}, "last row");
  expect({1, 0, 0}, "16");
  SessionFiles files;
  files.document["object"]["T_stage_object"][3] = nullptr;
  files.expect_refused("finite");
}

class ImagesFrom : public testing::TestWithParam<int> {};

TEST_P(ImagesFrom, AreReadInOrder) {
  const SessionFiles files;
  files.write_images(GetParam(), 12);
  const Session session = files.open();
  const auto all = open_frames(session);
  EXPECT_EQ(all->frame_count(), 12);
  EXPECT_EQ(read_all(*all), range(0, 12));
  const auto some = open_frames(session, 3, 7);
  EXPECT_EQ(some->frame_count(), 4);
  EXPECT_EQ(read_all(*some), range(3, 7));
  EXPECT_EQ(read_all(*open_frames(session, 3, 700)), range(3, 12));
  expect_bad_input([&] { open_frames(session, 12); }, "12 frames");
  expect_bad_input([&] { open_frames(session, 5, 5); }, "range");
}
INSTANTIATE_TEST_SUITE_P(FirstNumber, ImagesFrom, testing::Values(0, 1));

TEST(Images, AreRefusedWhereOneIsMissingBrokenOrOfAnotherSize) {
  const SessionFiles files;
  const Session session = files.open();
  expect_bad_input([&] { open_frames(session); }, "images", "no such folder");
  files.write_images(0, 6);
  std::filesystem::remove(files.image_path(2));
  expect_bad_input([&] { open_frames(session); }, "0002.png", "missing");

  files.write("images/0002.png", "no image");
  const auto source = open_frames(session);
  source->next();
  source->next();
  expect_bad_input([&] { source->next(); }, "0002.png");

  cv::imwrite(files.image_path(0).string(), cv::Mat(10, 20, CV_8UC3, cv::Scalar::all(0)));
  expect_bad_input([&] { open_frames(session); }, "0000.png", "20x10", "64x48");
}

TEST(Video, IsReadExactlyFromAnyStart) {
  SessionFiles files;
  files.write_video();
  const Session session = files.open();
  const auto all = open_frames(session);
  EXPECT_EQ(all->frame_count(), kFrames);
  const auto first = all->next();
  const auto second = all->next();
  ASSERT_TRUE(first && second);
  // 25 frames per second.
  EXPECT_EQ(first->time_s, 0);
  EXPECT_NEAR(second->time_s, 0.04, 1e-6);
  EXPECT_EQ(read_all(*all), range(2, kFrames));
  EXPECT_EQ(read_all(*open_frames(session, 17, 23)), range(17, 23));
  EXPECT_EQ(read_all(*open_frames(session, kFrames - 1)), range(kFrames - 1, kFrames));
  expect_bad_input([&] { open_frames(session, kFrames); }, "frames.avi", "40 frames");
}

TEST(Video, TakesTimesFromTheSessionWhereItSaysSo) {
  SessionFiles files;
  files.write_video();
  files.document["frames"]["fps"] = 10;
  const auto source = open_frames(files.open(), 3);
  EXPECT_DOUBLE_EQ(source->next()->time_s, 0.3);
}

TEST(Video, IsRefusedWhereItIsTruncated) {
  SessionFiles files;
  files.write_video();
  const auto path = files.folder() / "frames.avi";
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  const Session session = files.open();
  expect_bad_input(
      [&] {
        const auto source = open_frames(session);
        while (source->next()) continue;
      },
      "frames.avi", "decoding stops after", "of 40");
  // What is whole can still be used.
  EXPECT_EQ(read_all(*open_frames(session, 2, 8)), range(2, 8));
}

TEST(Video, IsRefusedWhereItIsEmptyGarbageOrOfAnotherSize) {
  SessionFiles files;
  files.write_video();
  const Session session = files.open();
  files.write("frames.avi", "");
  expect_bad_input([&] { open_frames(session); }, "frames.avi");
  files.write("frames.avi", std::string(5000, 'x'));
  expect_bad_input([&] { open_frames(session); }, "frames.avi");
  files.write_video();
  write_camera(files.folder() / "camera.yaml", make_camera(80, 60, false));
  expect_bad_input([&] { open_frames(files.open()); }, "frames.avi", "64x48", "80x60");
}

}  // namespace
}  // namespace sheen::capture::test
