// SPDX-License-Identifier: MIT
#include "capture/pose/pose_convention.h"
#include "capture/pose/stamp_check.h"
#include "capture/pose/trajectory.h"
#include "capture/source/stated_rate.h"
#include "tests/capture/expect_bad_input.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <vector>

namespace sheen::capture::test {
namespace {

using tests::TemporaryFolder;

/// One line for every stamp; the pose's x is the number of the line.
std::string lines_of(const std::vector<std::string>& stamps) {
  std::string text;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    text += stamps[i] + " " + std::to_string(i) + " 0 0 0 0 0 1\n";
  }
  return text;
}

Frame frame_at(int index, double time_s, double spacing_s = 0) {
  Frame frame;
  frame.index = index;
  frame.time_s = time_s;
  frame.spacing_s = spacing_s;
  return frame;
}

TEST(Stamps, DecimalsThatHappenToBeWholeAreSeconds) {
  const TemporaryFolder folder;
  const auto seconds = read_trajectory(folder.write("s.txt", lines_of({"0.0", "1.0", "2.0"})));
  EXPECT_EQ(seconds.stamps(), Stamps::seconds);
  const auto indices = read_trajectory(folder.write("i.txt", lines_of({"0", "1", "2"})));
  EXPECT_EQ(indices.stamps(), Stamps::indices);
  // Exponents are no counts either; one stamp with a point makes all of them seconds.
  EXPECT_EQ(read_trajectory(folder.write("e.txt", lines_of({"0", "1e0", "2"}))).stamps(),
            Stamps::seconds);

  // At 30 a second the second line belongs to frame 30, or to frame 1.
  EXPECT_EQ(seconds.board_from_camera(frame_at(30, 1), 30)->translation().x(), 1);
  EXPECT_FALSE(seconds.board_from_camera(frame_at(1, 1 / 30.0), 30));
  EXPECT_EQ(indices.board_from_camera(frame_at(1, 1 / 30.0), 30)->translation().x(), 1);
  EXPECT_FALSE(indices.board_from_camera(frame_at(30, 1), 30));
}

TEST(Stamps, NearestMeansWithinHalfOfTheFramesOwnSpacing) {
  const TemporaryFolder folder;
  const auto poses = read_trajectory(folder.write("p.txt", lines_of({"0.000", "0.100", "0.500"})));
  // 10 a second, then a pause: 0.06 s are more than half a frame before it, less in it.
  EXPECT_TRUE(poses.board_from_camera(frame_at(1, 0.149, 0.1), 30));
  EXPECT_FALSE(poses.board_from_camera(frame_at(1, 0.151, 0.1), 30));
  EXPECT_TRUE(poses.board_from_camera(frame_at(2, 0.44, 0.4), 30));
  EXPECT_FALSE(poses.board_from_camera(frame_at(2, 0.44, 0.1), 30));
  // Without a spacing the rate decides.
  EXPECT_FALSE(poses.board_from_camera(frame_at(2, 0.44), 30));
}

TEST(Stamps, OtherClocksAreNamedWithTheirUnit) {
  const FrameSpan frames{
      .count = 90, .first_index = 0, .last_index = 89, .first_s = 0, .last_s = 3};
  const auto fault = [&](const std::vector<double>& stamps, Stamps kind) {
    std::vector<Trajectory::Entry> entries;
    for (const double stamp : stamps) entries.push_back({stamp});
    const StampFault found = unmatched_stamps(Trajectory(entries, kind), frames);
    return found.fault + "; " + found.remedy;
  };
  const auto contains = [](const std::string& text, const std::string& word) {
    return testing::AssertionResult(text.find(word) != std::string::npos) << text;
  };
  const double epoch = 1'700'000'000;
  const std::string seconds = fault({epoch + 0.25, epoch + 3.5}, Stamps::seconds);
  EXPECT_TRUE(contains(seconds, "seconds since 1970"));
  EXPECT_TRUE(contains(seconds, "subtract"));
  EXPECT_TRUE(contains(fault({1e3 * epoch, 1e3 * epoch + 3000}, Stamps::indices), "milliseconds"));
  EXPECT_TRUE(contains(fault({1e6 * epoch, 1e6 * epoch + 3e6}, Stamps::indices), "microseconds"));
  EXPECT_TRUE(contains(fault({1e9 * epoch, 1e9 * epoch + 3e9}, Stamps::indices), "nanoseconds"));
  EXPECT_TRUE(contains(fault({120, 153, 187, 2990}, Stamps::indices), "milliseconds"));
  EXPECT_TRUE(contains(fault({10.5, 13.5}, Stamps::seconds), "shift"));
  EXPECT_TRUE(contains(fault({0.25, 0.75}, Stamps::seconds), "half a frame"));
}

TEST(Stamps, CountsFromOneAreSaid) {
  std::vector<Trajectory::Entry> entries;
  for (int i = 1; i <= 40; ++i) entries.push_back({static_cast<double>(i)});
  const Trajectory from_one(entries);
  ASSERT_TRUE(shifted_stamps(from_one, 40));
  EXPECT_NE(shifted_stamps(from_one, 40)->fault.find("1 to 40"), std::string::npos);
  // Frame 0 may simply have no pose in a recording of 41: that is a doubt.
  EXPECT_FALSE(shifted_stamps(from_one, 41));
  const FrameSpan span{.count = 41, .first_index = 0, .last_index = 40};
  EXPECT_TRUE(miscounting_stamps(from_one, span, 0));
  // Lost poses leave the count from 1 visible at the end.
  entries.erase(entries.begin(), entries.begin() + 3);
  entries.erase(entries.begin() + 5);
  EXPECT_TRUE(shifted_stamps(Trajectory(entries), 40));
  // Only images that are numbered from 1 themselves make a later beginning doubtful.
  EXPECT_FALSE(miscounting_stamps(Trajectory(entries), span, 0));
  EXPECT_TRUE(miscounting_stamps(Trajectory(entries), span, 1));
  for (auto& entry : entries) entry.stamp -= 1;
  EXPECT_FALSE(shifted_stamps(Trajectory(entries), 40));
}

TEST(Stamps, CountsOfKeyFramesAreDoubtful) {
  const FrameSpan span{.count = 90, .first_index = 0, .last_index = 89, .first_s = 0, .last_s = 3};
  std::vector<Trajectory::Entry> counts, frames;
  for (const int frame : {0, 4, 9, 17, 22, 40, 61, 88}) {
    counts.push_back({static_cast<double>(counts.size())});
    frames.push_back({static_cast<double>(frame)});
  }
  ASSERT_TRUE(miscounting_stamps(Trajectory(counts), span, 0));
  EXPECT_NE(miscounting_stamps(Trajectory(counts), span, 0)->remedy.find("key frames"),
            std::string::npos);
  // The frames' own numbers are right, however sparse.
  EXPECT_FALSE(miscounting_stamps(Trajectory(frames), span, 0));
  EXPECT_FALSE(stamps_outside(Trajectory(frames), span));
}

TEST(Stamps, PosesOfNoFrameAreTold) {
  const FrameSpan span{.count = 91, .first_index = 0, .last_index = 90, .first_s = 0, .last_s = 3};
  const auto outside = [&](double step, double shift, Stamps kind) {
    std::vector<Trajectory::Entry> entries;
    for (int i = 0; i <= 90; ++i) entries.push_back({shift + step * i});
    return stamps_outside(Trajectory(entries, kind), span);
  };
  EXPECT_FALSE(outside(1 / 30.0, 0, Stamps::seconds));
  EXPECT_FALSE(outside(1 / 29.97, 0, Stamps::seconds));
  EXPECT_TRUE(outside(1 / 25.0, 0, Stamps::seconds));
  EXPECT_TRUE(outside(1 / 30.0, 0.5, Stamps::seconds));
  EXPECT_FALSE(outside(1, 0, Stamps::indices));
  const auto doubled = outside(2, 0, Stamps::indices);
  ASSERT_TRUE(doubled);
  EXPECT_NE(doubled->fault.find("45 of its 91 poses"), std::string::npos) << doubled->fault;
}

TEST(Stamps, SecondsThatCountFramesAreTold) {
  std::vector<Trajectory::Entry> entries;
  for (int i = 0; i < 90; ++i) entries.push_back({static_cast<double>(i)});
  const Trajectory counting(entries, Stamps::seconds);
  FrameSpan frames{
      .count = 90, .first_index = 0, .last_index = 89, .first_s = 0, .last_s = 89 / 30.0};
  ASSERT_TRUE(counting_stamps(counting, frames));
  EXPECT_NE(counting_stamps(counting, frames)->fault.find("0 to 89"), std::string::npos);
  EXPECT_FALSE(counting_stamps(Trajectory(entries, Stamps::indices), frames));
  frames.last_s = 89;  // a camera that takes one a second
  EXPECT_FALSE(counting_stamps(counting, frames));
  frames.last_s = 89 / 30.0;
  // A pose a second for these three seconds.
  EXPECT_FALSE(counting_stamps(Trajectory({{0.0}, {1.0}, {2.0}}, Stamps::seconds), frames));
  entries[5].stamp = 5.5;
  EXPECT_FALSE(counting_stamps(Trajectory(entries, Stamps::seconds), frames));
}

TEST(Stamps, FinerUnitsAreToldWhereAFewFramesMatch) {
  // Four seconds of 30 images; as milliseconds 0, 33, 67 and 100 are frames, too.
  const FrameSpan frames{
      .count = 120, .first_index = 0, .last_index = 119, .first_s = 0, .last_s = 119 / 30.0};
  const auto told = [&frames](double per_second, Stamps kind, int every = 1) {
    std::vector<Trajectory::Entry> entries;
    for (int i = 0; i < 120; i += every) {
      const double stamp = i * per_second / 30;
      entries.push_back({kind == Stamps::indices ? std::round(stamp) : stamp});
    }
    const auto fault = finer_stamps(Trajectory(entries, kind), frames);
    return fault ? fault->fault : std::string();
  };
  for (const Stamps kind : {Stamps::indices, Stamps::seconds}) {
    EXPECT_NE(told(1e3, kind).find("milliseconds"), std::string::npos);
    EXPECT_NE(told(1e3, kind, 5).find("milliseconds"), std::string::npos);
    EXPECT_NE(told(1e6, kind).find("microseconds"), std::string::npos);
    EXPECT_NE(told(1e9, kind).find("nanoseconds"), std::string::npos);
  }
  // Seconds, indices of all frames and of every 33rd, whose steps are those of milliseconds, and
  // the indices of a longer recording that this one was cut from.
  EXPECT_EQ(told(1, Stamps::seconds), "");
  EXPECT_EQ(told(30, Stamps::indices), "");
  EXPECT_EQ(told(30, Stamps::indices, 33), "");
  EXPECT_EQ(told(30 * 10, Stamps::indices), "");
}

TEST(PoseConvention, NamesWhatWasDoneToThePoses) {
  core::CameraModel::Intrinsics lens;
  lens.width_px = 640;
  lens.height_px = 480;
  lens.focal_px = {600, 600};
  lens.principal_px = {320, 240};
  const core::CameraModel camera(lens);
  // Cameras on a circle of 0.4 m, 0.3 m high, that look at the origin.
  std::vector<Eigen::Isometry3d> good;
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d eye(0.4 * std::cos(0.5 * i), 0.4 * std::sin(0.5 * i), 0.3);
    Eigen::Matrix3d axes;
    axes.col(2) = -eye.normalized();
    axes.col(0) = axes.col(2).cross(Eigen::Vector3d::UnitZ()).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    Eigen::Isometry3d board_from_camera = Eigen::Isometry3d::Identity();
    board_from_camera.linear() = axes;
    board_from_camera.translation() = eye;
    good.push_back(board_from_camera.inverse());
  }
  const Eigen::Vector3d middle(0.01, 0, 0.02);
  EXPECT_FALSE(other_convention(good, camera, middle));
  EXPECT_FALSE(other_convention({}, camera, middle));
  const auto said = [&](const auto& change) {
    std::vector<Eigen::Isometry3d> changed;
    for (const auto& pose : good) changed.push_back(change(pose.inverse()).inverse());
    const auto found = other_convention(changed, camera, middle);
    return found ? found->fault : std::string();
  };
  const auto inverted = [](const Eigen::Isometry3d& pose) { return pose.inverse(); };
  const auto w_first = [](Eigen::Isometry3d pose) {
    const Eigen::Quaterniond q(pose.linear());
    pose.linear() = Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()).toRotationMatrix();
    return pose;
  };
  const auto backwards = [](Eigen::Isometry3d pose) {
    pose.linear() = pose.linear() * Eigen::Vector3d(1, -1, -1).asDiagonal();
    return pose;
  };
  EXPECT_NE(said(inverted).find("board to the camera"), std::string::npos);
  EXPECT_NE(said(w_first).find("begin with w"), std::string::npos);
  EXPECT_NE(said(backwards).find("OpenGL"), std::string::npos);
}

TEST(StatedRate, SpeaksUpBeyondHalfAFrame) {
  StatedRate rate(30);
  EXPECT_DOUBLE_EQ(*rate.time_s(45), 1.5);
  rate.compare(10, 10 / 30.0 + 0.016);  // less than half of 1/30 s
  EXPECT_FALSE(rate.disagreement());
  rate.compare(60, 4.0);
  ASSERT_TRUE(rate.disagreement());
  EXPECT_NE(rate.disagreement()->find("2 s at frame 60"), std::string::npos)
      << *rate.disagreement();
  // Where nothing is stated there is nothing to contradict.
  StatedRate none(std::nullopt);
  none.compare(60, 4.0);
  EXPECT_FALSE(none.disagreement());
  EXPECT_FALSE(none.time_s(1));
}

TEST(TrajectoryFile, ReadsTheTextOfOtherSystems) {
  const TemporaryFolder folder;
  const auto count = [&](const std::string& text) {
    return read_trajectory(folder.write("poses.txt", text)).entries().size();
  };
  const std::string usual = lines_of({"0", "1", "2"});
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = usual;
    for (std::size_t i = text.find(from); i != std::string::npos;
         i = text.find(from, i + to.size()))
      text.replace(i, from.size(), to);
    return text;
  };
  EXPECT_EQ(count("\xef\xbb\xbf# heading\n" + usual), 3u);
  EXPECT_EQ(count(with("\n", "\r\n")), 3u);
  EXPECT_EQ(count(with("\n", "\r")), 3u);
  EXPECT_EQ(count(with(" ", "\t")), 3u);
  EXPECT_EQ(count(with("\n", "  \n\n")), 3u);
  EXPECT_EQ(count(lines_of({"2", "0", "1"})), 3u);
  EXPECT_EQ(count("0 1e-320 0 0 0 0 0 1\n1 1e-400 0 0 0 0 0 1\n"), 2u);
}

TEST(TrajectoryFile, NamesTheLineAndTheCause) {
  const TemporaryFolder folder;
  const auto refuse = [&](const std::string& text, const char* word) {
    const auto path = folder.write("poses.txt", text);
    expect_bad_input([&] { read_trajectory(path); }, "poses.txt", word);
  };
  const std::string first = "0 0 0 0 0 0 0 1\n";
  refuse(first + "1,0,0,0,0,0,0,1\n", "line 2");
  refuse(first + "1,0,0,0,0,0,0,1\n", "commas");
  refuse(first + "1;0;0;0;0;0;0;1\n", "semicolons");
  refuse(first + "1 0,5 0,25 0 0 0 0 1\n", "decimal comma");
  refuse("time tx ty tz qx qy qz qw\n" + first, "heading");
  refuse(first + "1 0 0 0 0 0 0 0\n", "zeros");
  refuse(first + "1 5D-1 0 0 0 0 0 1\n", "write e");
  refuse(first + "1 0 0 0 1 0 0 0 1 0 0 0\n", "KITTI");
  refuse(first + "0 0 0 0 0 0 1\n", "stamp is missing");
  refuse(first + first, "stamp 0");
}

}  // namespace
}  // namespace sheen::capture::test
