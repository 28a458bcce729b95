// SPDX-License-Identifier: MIT
#include "capture/calibration/camera_file.h"
#include "capture/pose/board.h"
#include "capture/pose/trajectory.h"
#include "tests/capture/expect_bad_input.h"
#include "tests/capture/rendered_board.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <string>

namespace sheen::capture::test {
namespace {

using tests::TemporaryFolder;

std::string camera_text(const std::string& K, const std::string& distortion,
                        const std::string& width = "640") {
  return "%YAML:1.0\n---\nimage_width: " + width +
         "\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
         "   data: [ " +
         K +
         " ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 1\n"
         "   cols: 4\n   dt: d\n   data: [ " +
         distortion + " ]\n";
}
const std::string kGoodK = "600., 0., 320., 0., 610., 240., 0., 0., 1.";
const std::string kGoodD = "0.1, -0.2, 0.001, 0.002";

TEST(CameraFile, ReadsWhatItWrote) {
  const TemporaryFolder scratch;
  for (const double k4 : {0.0, 0.3}) {  // five and eight coefficients
    auto intrinsics = make_camera(1280, 720, true).intrinsics();
    intrinsics.distortion[5] = k4;
    const auto path = scratch.path() / "camera.yaml";
    write_camera(path, core::CameraModel(intrinsics));
    const auto read = read_camera(path).intrinsics();
    EXPECT_EQ(read.width_px, intrinsics.width_px);
    EXPECT_EQ(read.height_px, intrinsics.height_px);
    // OpenCV writes 17 digits, which give doubles back exactly.
    EXPECT_EQ(read.focal_px, intrinsics.focal_px);
    EXPECT_EQ(read.principal_px, intrinsics.principal_px);
    EXPECT_EQ(read.distortion, intrinsics.distortion);
  }
}

TEST(CameraFile, ReadsFourCoefficients) {
  const TemporaryFolder scratch;
  const auto camera = read_camera(scratch.write("camera.yaml", camera_text(kGoodK, kGoodD)));
  EXPECT_EQ(camera.intrinsics().focal_px, Eigen::Vector2d(600, 610));
  EXPECT_EQ(camera.intrinsics().distortion,
            (std::array<double, 8>{0.1, -0.2, 0.001, 0.002, 0, 0, 0, 0}));
}

TEST(CameraFile, RefusesEachFault) {
  const TemporaryFolder scratch;
  const auto refuse = [&](const std::string& text, const char* word) {
    const auto path = scratch.write("camera.yaml", text);
    expect_bad_input([&] { read_camera(path); }, "camera.yaml", word);
  };
  expect_bad_input([&] { read_camera(scratch.path() / "none.yaml"); }, "none.yaml", "no such file");
  refuse("", "FileStorage");
  refuse("garbage \x01\x02", "FileStorage");
  std::string deep = "%YAML:1.0\n---\n";
  deep.append(5000, '[');
  refuse(deep, "nested");
  refuse(camera_text(kGoodK, kGoodD).substr(0, 150), "FileStorage");
  refuse(camera_text(kGoodK, kGoodD, "0"), "image_width");
  refuse(camera_text(kGoodK, kGoodD, "6.5"), "image_width");
  refuse(camera_text("-600., 0., 320., 0., 610., 240., 0., 0., 1.", kGoodD), "focal");
  refuse(camera_text("600., 0., 5000., 0., 610., 240., 0., 0., 1.", kGoodD), "principal");
  refuse(camera_text("600., 3., 320., 0., 610., 240., 0., 0., 1.", kGoodD), "camera_matrix");
  refuse(camera_text(".Nan, 0., 320., 0., 610., 240., 0., 0., 1.", kGoodD), "finite");
  refuse(camera_text(kGoodK, "0.1, 0.2, 0.3"), "3 entries");
  refuse(camera_text(kGoodK, "0.1, 0.2, 0.3, .Inf"), "finite");
  refuse(camera_text(kGoodK, "\"a\", 0.2, 0.3, 0.1"), "number");
}

TEST(BoardFile, ReadsWhatItWrote) {
  const TemporaryFolder scratch;
  Board board = make_grid_board("tag36h11", 3, 2, 0.0456, 0.0611);
  board.border_bits = 2;
  board.tags[4].board_from_tag.rotate(
      Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()));
  const auto path = scratch.path() / "board.yaml";
  write_board(path, board);
  const Board read = read_board(path);
  EXPECT_EQ(read.family, board.family);
  EXPECT_EQ(read.border_bits, board.border_bits);
  ASSERT_EQ(read.tags.size(), board.tags.size());
  for (const auto& [id, tag] : board.tags) {
    EXPECT_NEAR(read.tags.at(id).size_m, tag.size_m, 1e-9);
    // Ten digits of numbers below one.
    EXPECT_TRUE(read.tags.at(id).board_from_tag.isApprox(tag.board_from_tag, 1e-8));
  }
}

TEST(BoardFile, ReadsSeveralBundles) {
  const TemporaryFolder scratch;
  const Board board = read_board(scratch.write("board.yaml", R"(tag_family: DICT_6X6_250
tag_bundles:
  - name: floor
    layout: [{id: 3, size: 0.04, x: 0.1, y: 0.2, z: 0, qw: 1, qx: 0, qy: 0, qz: 0}]
  - name: wall
    layout: [{id: 7, size: 0.05, x: 0, y: 0, z: 0.3, qw: 0.7071068, qx: 0.7071068, qy: 0, qz: 0}]
)"));
  ASSERT_EQ(board.tags.size(), 2U);
  EXPECT_TRUE(board.tags.at(3).corners_in_board()[0].isApprox(Eigen::Vector3d(0.08, 0.18, 0)));
  // A quarter turn about x sends the tag's y upwards: its upper right corner stands at z + size
  // / 2.
  EXPECT_TRUE(
      board.tags.at(7).corners_in_board()[2].isApprox(Eigen::Vector3d(0.025, 0, 0.325), 1e-6));
}

TEST(BoardFile, LaysOutKalibrsGrid) {
  const TemporaryFolder scratch;
  const Board board = read_board(scratch.write("board.yaml",
                                               "target_type: 'aprilgrid'\ntagCols: 6\ntagRows: 5\n"
                                               "tagSize: 0.08\ntagSpacing: 0.25\n"));
  EXPECT_EQ(board.family, "tag36h11");
  EXPECT_EQ(board.border_bits, 2);
  ASSERT_EQ(board.tags.size(), 30U);
  EXPECT_TRUE(board.tags.at(0).corners_in_board()[0].isZero(1e-15));
  // Pitch 0.08 * 1.25 = 0.1 m; id 13 = 2 * 6 + 1 stands in column 1, row 2 from below.
  EXPECT_TRUE(board.tags.at(13).corners_in_board()[0].isApprox(Eigen::Vector3d(0.1, 0.2, 0)));
}

TEST(BoardFile, RefusesEachFault) {
  const TemporaryFolder scratch;
  const auto refuse = [&](const std::string& text, const char* word) {
    const auto path = scratch.write("board.yaml", text);
    expect_bad_input([&] { read_board(path); }, "board.yaml", word);
  };
  const auto bundle = [](const std::string& family, const std::string& tags) {
    return "tag_family: " + family + "\ntag_bundles:\n  - layout: [" + tags + "]\n";
  };
  refuse("", "board");
  refuse("[1, 2", "YAML");
  refuse(std::string(100000, '['), "nests");
  refuse("a: 1\n", "tag_bundles");
  refuse("tag_bundles: 3\n", "list");
  refuse(bundle("tag99h9", "{id: 0, size: 1}"), "tag99h9");
  refuse(bundle("tag36h11", ""), "no tag");
  refuse(bundle("tag36h11", "{id: 0, size: 1}, {id: 0, size: 1}"), "twice");
  refuse(bundle("tag36h11", "{id: 0, size: 0}"), "size");
  refuse(bundle("tag36h11", "{id: 0, size: -1}"), "size");
  refuse(bundle("tag36h11", "{id: 0, size: .nan}"), "size");
  refuse(bundle("tag36h11", "{id: 0, size: 1, x: .inf}"), "x is");
  refuse(bundle("tag36h11", "{id: -1, size: 1}"), "id");
  refuse(bundle("tag36h11", "{id: 587, size: 1}"), "587");
  refuse(bundle("tag36h11", "{id: 0, size: 1, qw: 0}"), "quaternion");
  refuse(bundle("tag36h11", "7"), "no tag");
  const std::string grid = "target_type: aprilgrid\ntagSize: 0.1\ntagSpacing: 0.3\n";
  refuse(grid + "tagCols: 6\n", "tagRows");
  refuse(grid + "tagCols: 60\ntagRows: 60\n", "more tags");
  refuse(grid + "tagCols: 2000000000\ntagRows: 2000000000\n", "more tags");
  // Either number is below the 48714 codes of this family, their product above what an int holds.
  refuse(
      "tag_family: tagStandard52h13\nborder_bits: 1\n" + grid + "tagCols: 48000\ntagRows: 48000\n",
      "more tags");
  refuse(grid + "tagCols: 0\ntagRows: 6\n", "tagCols");
}

Trajectory::Entry entry_at(double stamp, double x) {
  Trajectory::Entry entry;
  entry.stamp = stamp;
  entry.board_from_camera.translation().x() = x;
  entry.board_from_camera.linear() =
      Eigen::AngleAxisd(x, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  return entry;
}

TEST(TrajectoryFile, ReadsWhatItWrote) {
  const TemporaryFolder scratch;
  const std::vector<Trajectory::Entry> entries{entry_at(0, 0.25), entry_at(0.04, 1.5),
                                               entry_at(12345.0625, 3)};
  write_trajectory(scratch.path() / "poses.txt", entries);
  const Trajectory read = read_trajectory(scratch.path() / "poses.txt");
  ASSERT_EQ(read.entries().size(), entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    EXPECT_EQ(read.entries()[i].stamp, entries[i].stamp);
    // Twelve digits.
    EXPECT_TRUE(read.entries()[i].board_from_camera.isApprox(entries[i].board_from_camera, 1e-10));
  }
}

TEST(TrajectoryFile, TakesIntegersAsIndicesAndElseSeconds) {
  const TemporaryFolder scratch;
  const Trajectory indices = read_trajectory(
      scratch.write("a.txt", "# comment\n\n4 1 0 0 0 0 0 1\r\n  2\t2 0 0 0 0 0 1\n"));
  EXPECT_EQ(indices.board_from_camera({{}, 99, 4}, 10)->translation().x(), 1);
  EXPECT_EQ(indices.board_from_camera({{}, 99, 2}, 10)->translation().x(), 2);
  EXPECT_FALSE(indices.board_from_camera({{}, 4, 3}, 10));

  // At 10 frames per second an entry serves times up to 0.05 s away.
  const Trajectory seconds =
      read_trajectory(scratch.write("b.txt", "1 1 0 0 0 0 0 1\n1.5 2 0 0 0 0 0 1\n"));
  EXPECT_EQ(seconds.board_from_camera({{}, 1.04, 0}, 10)->translation().x(), 1);
  EXPECT_EQ(seconds.board_from_camera({{}, 1.46, 0}, 10)->translation().x(), 2);
  EXPECT_FALSE(seconds.board_from_camera({{}, 1.25, 1}, 10));
  EXPECT_FALSE(seconds.board_from_camera({{}, 9, 1}, 10));
}

TEST(TrajectoryFile, RefusesEachFault) {
  const TemporaryFolder scratch;
  const auto refuse = [&](const std::string& text, const char* word) {
    const auto path = scratch.write("poses.txt", text);
    expect_bad_input([&] { read_trajectory(path); }, "poses.txt", word);
  };
  refuse("", "no pose");
  refuse("# only a comment\n", "no pose");
  refuse("0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0\n", "line 2");
  refuse("0 0 0 0 0 0 0 1 5\n", "line 1");
  refuse("0 0 0 x 0 0 0 1\n", "eight numbers");
  refuse("0 nan 0 0 0 0 0 1\n", "finite");
  refuse("0 1e400 0 0 0 0 0 1\n", "eight numbers");
  refuse("0 1e30 0 0 0 0 0 1\n", "far");
  refuse("0 0 0 0 0 0 0 0\n", "quaternion");
  refuse("3 0 0 0 0 0 0 1\n3 1 0 0 0 0 0 1\n", "stamp 3");
}

}  // namespace
}  // namespace sheen::capture::test
