// SPDX-License-Identifier: MIT
#include "capture/pose/edge_alignment.h"

#include <gtest/gtest.h>

#include <random>

namespace sheen::capture::test {
namespace {

/// Edges of every direction, 400 px across at 1000 px focal length, with their rotation and
/// translation columns as independent as those of a real board.
std::vector<EdgeObservation> edges_moved_by(const Twist& twist, double swell_px) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> across(-0.2, 0.2);
  std::uniform_real_distribution<double> direction(0, 6.28);
  std::vector<EdgeObservation> edges;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d point(across(random), across(random), 0.5 + across(random) / 2);
    const double angle = direction(random);
    const Eigen::Vector3d row =
        1000 / point.z() *
        Eigen::Vector3d(std::cos(angle), std::sin(angle),
                        -(std::cos(angle) * point.x() + std::sin(angle) * point.y()) / point.z());
    EdgeObservation edge;
    edge.outward_by_twist << point.cross(row), row;
    edge.offset_px = edge.outward_by_twist.dot(twist) + swell_px;
    edges.push_back(edge);
  }
  return edges;
}

const Twist kTwist = (Twist() << 2e-3, -1e-3, 3e-3, 1e-3, 2e-3, -1e-3).finished();

TEST(AlignEdges, GivesTheTwistBack) {
  std::vector<double> scratch;
  const auto alignment = align_edges(edges_moved_by(kTwist, 0), 0.1, scratch);
  ASSERT_TRUE(alignment);
  EXPECT_LT((alignment->twist - kTwist).norm(), 1e-9);
  EXPECT_NEAR(alignment->swell_px, 0, 1e-6);
}

// The swell has a prior of a hundredth of the data's weight: 1 / 1.01 of it is found where it can
// be told from the motion, and the rest is spread over random directions.
TEST(AlignEdges, TellsSwellFromMotion) {
  std::vector<double> scratch;
  const auto alignment = align_edges(edges_moved_by(kTwist, 0.5), 0.1, scratch);
  ASSERT_TRUE(alignment);
  EXPECT_NEAR(alignment->swell_px, 0.5 / 1.01, 0.01);
  EXPECT_LT((alignment->twist - kTwist).norm(), 1e-4);
}

TEST(AlignEdges, PassesOverAThirdOfWrongEdges) {
  std::vector<EdgeObservation> edges = edges_moved_by(kTwist, 0);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> wrong_px(-15, 15);
  for (std::size_t i = 0; i < edges.size(); i += 3) edges[i].offset_px = wrong_px(random);
  std::vector<double> scratch;
  const auto alignment = align_edges(edges, 0.1, scratch);
  ASSERT_TRUE(alignment);
  // A Cauchy weight at 15 px is (0.1 / 15)^2: what is left of the pull is some hundredths of a px.
  EXPECT_LT((alignment->twist - kTwist).norm(), 2e-4);
}

TEST(AlignEdges, HasNoAnswerForTooLittle) {
  std::vector<double> scratch;
  EXPECT_FALSE(align_edges({}, 0.1, scratch));
  std::vector<EdgeObservation> edges = edges_moved_by(kTwist, 0);
  edges.resize(5);
  EXPECT_FALSE(align_edges(edges, 0.1, scratch));
  // Twenty times the same edge fixes one direction of six.
  EXPECT_FALSE(align_edges(std::vector<EdgeObservation>(20, edges[0]), 0.1, scratch));
}

TEST(Moved, IsUndoneByItsInverse) {
  Eigen::Isometry3d pose(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  pose.translation() = Eigen::Vector3d(0.1, -0.2, 0.5);
  EXPECT_TRUE(moved(pose, Twist::Zero()).isApprox(pose, 1e-15));
  // exp(w) T, then exp(-w): the rotation is undone, and with it turns the translation.
  Twist turn = Twist::Zero();
  turn.head<3>() = kTwist.head<3>();
  EXPECT_TRUE(moved(moved(pose, turn), -turn).isApprox(pose, 1e-14));
}

}  // namespace
}  // namespace sheen::capture::test
