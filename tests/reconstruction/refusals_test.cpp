// SPDX-License-Identifier: MIT
// Every refusal names the session, the cause and what to film instead.
#include "reconstruction/object/refusals.h"

#include "core/diagnostics/error.h"
#include "tests/reconstruction/stage_for_tests.h"

#include <gtest/gtest.h>

namespace sheen::reconstruction {
namespace {

template <typename Call>
void expect_refused(const Call& call, const std::string& cause, const std::string& remedy) {
  try {
    call();
    ADD_FAILURE() << "not refused: " << cause;
  } catch (const core::Error& error) {
    const std::string line = error.what();
    EXPECT_EQ(error.kind(), core::Error::Kind::bad_input);
    EXPECT_NE(line.find("walk"), std::string::npos) << line;
    EXPECT_NE(line.find(cause), std::string::npos) << line;
    EXPECT_NE(line.find(remedy), std::string::npos) << line;
  }
}

ViewSet views_over(double arc_deg, double elevation_deg) {
  return tests::views_without_images(
      tests::small_camera(64, 48),
      tests::ring_of_poses(30, 0.5, elevation_deg, Eigen::Vector3d::Zero(), arc_deg));
}

TEST(Refusals, AViewRangeThatShowsNoDepth) {
  const capture::Board board = tests::ring_board();
  expect_refused([&] { refuse_narrow_range("walk", board, views_over(10, 40)); },
                 "views come from too few sides", "a walk all the way round");
  EXPECT_NO_THROW(refuse_narrow_range("walk", board, views_over(360, 40)));
  EXPECT_NO_THROW(refuse_narrow_range("walk", board, views_over(180, 20)));
}

Components parts(const std::vector<std::pair<std::size_t, Eigen::Vector3f>>& list) {
  Components components;
  for (const auto& [points, middle] : list) {
    Component part;
    part.points = points;
    part.box.extend(middle - Eigen::Vector3f::Constant(0.01F));
    part.box.extend(middle + Eigen::Vector3f::Constant(0.01F));
    components.parts.push_back(part);
  }
  return components;
}

TEST(Refusals, WhatStandsThere) {
  const capture::Board board = tests::ring_board();
  expect_refused([&] { refuse_empty_sheet("walk", {}); }, "no object is found", "differs from");
  const Eigen::Vector3f middle(0, 0, 0.02F);
  const Eigen::Vector3f beside(0.3F, 0, 0.02F);
  expect_refused(
      [&] {
        refuse_what_stands_there("walk", board, parts({{1000, middle}, {400, -middle}}));
      },
      "more than one object", "one object at a time");
  expect_refused(
      [&] {
        refuse_what_stands_there("walk", board, parts({{1000, beside}}));
      },
      "beside the sheet's tags", "in their middle");
  // A speck is no object.
  EXPECT_NO_THROW(refuse_what_stands_there("walk", board, parts({{1000, middle}, {3, beside}})));
}

TEST(Refusals, ASheetThatIsHidden) {
  const capture::Board board = tests::ring_board();
  StageMap map;
  map.grid = {{-0.15F, -0.15F}, 0.01F, {31, 31}};
  map.source = cv::Mat(31, 31, CV_8UC1, cv::Scalar(static_cast<double>(TexelSource::unknown)));
  expect_refused([&] { refuse_hidden_sheet("walk", board, map); },
                 "100 % of the sheet is never seen", "larger sheet or a smaller object");
  map.source.setTo(static_cast<double>(TexelSource::seen));
  EXPECT_EQ(refuse_hidden_sheet("walk", board, map), 0);
}

TEST(Refusals, AnObjectThatLooksLikeItsSheet) {
  expect_refused([] { refuse_paper_like("walk", 0.81F); },
                 "looks like the sheet that it stands on (81 % of what could be cut out",
                 "print the sheet on coloured or grey paper");
  EXPECT_NO_THROW(refuse_paper_like("walk", 0.2F));
}

TEST(Refusals, AnObjectInTwoPlaces) {
  const auto first = parts({{1000, {0, 0, 0.02F}}}).parts[0];
  const auto second = parts({{1000, {0.04F, 0.03F, 0.02F}}}).parts[0];
  expect_refused([&] { refuse_two_places("walk", first, second); },
                 "elsewhere in the second half of the walk (50 mm away)",
                 "leave object and sheet where they are");
  // 4 mm of 20: an outline that differs from half to half.
  const auto nearly = parts({{1000, {0.004F, 0, 0.02F}}}).parts[0];
  EXPECT_NO_THROW(refuse_two_places("walk", first, nearly));
}

TEST(Refusals, AnObjectThatMoved) {
  expect_refused([] { refuse_moved_object("walk", 0.5F); }, "contradict each other (only 50 %",
                 "leave object and sheet where they are");
  EXPECT_NO_THROW(refuse_moved_object("walk", 0.97F));
}

}  // namespace
}  // namespace sheen::reconstruction
