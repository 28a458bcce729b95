// SPDX-License-Identifier: MIT
// The printed board: what the PDF shows lies where board.yaml says.
#include "capture/board_print/board_pdf.h"
#include "capture/pose/corner_refinement.h"
#include "capture/pose/tag_detector.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <cstdlib>
#include <set>

namespace sheen::capture::test {
namespace {

using tests::TemporaryFolder;

constexpr double kDotsPerInch = 200;
constexpr double kPixelsPerMm = kDotsPerInch / 25.4;

/// The pages of a PDF as grey images, drawn by poppler; empty without it.
std::vector<cv::Mat> draw_pages(const std::filesystem::path& pdf, std::size_t count) {
  const auto prefix = pdf.parent_path() / "page";
  const std::string command = "pdftoppm -gray -r " + std::to_string(kDotsPerInch) + " '" +
                              pdf.string() + "' '" + prefix.string() + "'";
  if (std::system("command -v pdftoppm > /dev/null") != 0) return {};
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::vector<cv::Mat> pages;
  for (std::size_t i = 1; i <= count; ++i) {
    const auto name = prefix.string() + "-" + std::to_string(i) + ".pgm";
    pages.push_back(cv::imread(name, cv::IMREAD_GRAYSCALE));
    EXPECT_FALSE(pages.back().empty()) << name;
  }
  return pages;
}

/// Straight sides: any camera without distortion will do.
core::CameraModel scanner(const cv::Mat& page) {
  core::CameraModel::Intrinsics intrinsics;
  intrinsics.width_px = page.cols;
  intrinsics.height_px = page.rows;
  intrinsics.focal_px.setConstant(page.cols);
  intrinsics.principal_px << page.cols / 2.0, page.rows / 2.0;
  return core::CameraModel(intrinsics);
}

/// A place of the board (metres) on the drawn page of a sheet.
Eigen::Vector2d pixel_of(const BoardPlan& plan, const BoardSheet& sheet,
                         const Eigen::Vector3d& in_board) {
  const auto [left, bottom] = block_corner_mm(plan, sheet);
  const double x_mm =
      1000 * in_board.x() + left + (plan.columns / 2.0 - sheet.first_column) * plan.pitch_mm;
  const double y_mm =
      1000 * in_board.y() + bottom + (plan.rows / 2.0 - sheet.first_row) * plan.pitch_mm;
  return {x_mm * kPixelsPerMm - 0.5, (plan.design.paper.height_mm - y_mm) * kPixelsPerMm - 0.5};
}

class PrintedBoard : public testing::TestWithParam<BoardDesign> {};

// Every tag of board.yaml is found on exactly one page, its corners where the board has them.
// Poppler blackens every quarter of a pixel that a shape touches, so a side may lie a quarter too
// far out and a corner sqrt(2) / 4 = 0.36 px (0.045 mm); the middle of a tag, where opposite sides
// make up for each other, half of that at most.
TEST_P(PrintedBoard, ShowsEveryTagInItsPlace) {
  const BoardPlan plan = plan_board(GetParam());
  const TemporaryFolder folder;
  write_board_pdf(folder.path() / "board.pdf", plan);
  write_board(folder.path() / "board.yaml", plan.board);
  const Board board = read_board(folder.path() / "board.yaml");
  const auto pages = draw_pages(folder.path() / "board.pdf", plan.sheets.size());
  if (pages.empty()) GTEST_SKIP() << "pdftoppm (poppler-utils) is not on this machine";

  const TagFamily family = find_tag_family(board.family, 1).value();
  const TagDetector detector(family);
  std::set<int> seen;
  for (std::size_t i = 0; i < pages.size(); ++i) {
    EXPECT_NEAR(pages[i].cols, plan.design.paper.width_mm * kPixelsPerMm, 1);
    for (TagDetection& tag : detector.detect(pages[i])) {
      ASSERT_TRUE(board.tags.contains(tag.id)) << tag.id;
      EXPECT_TRUE(seen.insert(tag.id).second) << tag.id << " is there twice";
      refine_corners(pages[i], scanner(pages[i]), family.modules, tag.corners_px);
      const auto corners = board.tags.at(tag.id).corners_in_board();
      Eigen::Vector2d mean_error = Eigen::Vector2d::Zero();
      for (std::size_t c = 0; c < 4; ++c) {
        const Eigen::Vector2d error =
            tag.corners_px[c] - pixel_of(plan, plan.sheets[i], corners[c]);
        EXPECT_LT(error.norm(), 0.36) << tag.id;
        mean_error += error / 4;
      }
      EXPECT_LT(mean_error.norm(), 0.18) << tag.id;
    }
  }
  EXPECT_EQ(seen.size(), board.tags.size());
}

BoardDesign design(const Paper& paper, double tag_mm, bool full) {
  BoardDesign result;
  result.paper = paper;
  result.tag_mm = tag_mm;
  result.full_grid = full;
  return result;
}

BoardDesign tiled() {
  BoardDesign result = design(kPapers[0], 50, false);
  result.columns = 5;
  result.rows = 6;
  result.family = "tag25h9";
  return result;
}

INSTANTIATE_TEST_SUITE_P(Designs, PrintedBoard,
                         testing::Values(design(kPapers[0], 30, false),
                                         design(kPapers[2], 24, true), tiled()));

TEST(BoardPlan, LeavesTheMiddleFreeAndNumbersTheRimWithoutGaps) {
  const BoardPlan plan = plan_board({});
  // A4: 5 x 7 cells of 37.5 mm; the rim is 2 * 5 + 2 * 5 cells.
  EXPECT_EQ(plan.columns, 5);
  EXPECT_EQ(plan.rows, 7);
  ASSERT_EQ(plan.board.tags.size(), 20U);
  // The default sheet's ids begin at 500.
  EXPECT_EQ(plan.board.tags.begin()->first, 500);
  EXPECT_EQ(plan.board.tags.rbegin()->first, 519);
  // Nothing of a tag reaches into the free middle, whose size is stated.
  for (const auto& [id, tag] : plan.board.tags) {
    const Eigen::Vector3d centre = tag.board_from_tag.translation();
    const bool beside = std::abs(centre.x()) >= (plan.free_width_mm + 30) / 2000 - 1e-9;
    const bool above = std::abs(centre.y()) >= (plan.free_height_mm + 30) / 2000 - 1e-9;
    EXPECT_TRUE(beside || above) << id;
  }
}

TEST(BoardPlan, SheetsHoldEveryCellOnceAndFitTheirPaper) {
  for (const double tag_mm : {12.0, 30.0, 47.0, 120.0}) {
    BoardDesign wide = design(kPapers[2], tag_mm, false);
    wide.columns = 11;
    wide.rows = 8;
    const BoardPlan plan = plan_board(wide);
    std::set<std::pair<int, int>> cells;
    for (const BoardSheet& sheet : plan.sheets) {
      const auto [left, bottom] = block_corner_mm(plan, sheet);
      const double gap_mm = plan.pitch_mm - tag_mm;
      EXPECT_GE(left + gap_mm / 2, kMarginMm - 1e-9);
      EXPECT_GE(bottom + gap_mm / 2, kFootMm - 1e-9);
      for (int row = 0; row < sheet.rows; ++row) {
        for (int column = 0; column < sheet.columns; ++column) {
          EXPECT_TRUE(cells.emplace(sheet.first_column + column, sheet.first_row + row).second);
        }
      }
    }
    EXPECT_EQ(cells.size(), 88U);
  }
}

TEST(BoardPlan, FollowsTheMeasuredRuler) {
  // A printer that makes 150 mm into 147 mm shrinks every length by 2 %.
  const BoardPlan plan = plan_board({});
  const Board printed = board_as_printed(plan.board, 147);
  for (const auto& [id, tag] : plan.board.tags) {
    const auto& other = printed.tags.at(id);
    EXPECT_NEAR(other.size_m, 0.98 * tag.size_m, 1e-12);
    EXPECT_TRUE(other.board_from_tag.translation().isApprox(0.98 * tag.board_from_tag.translation(),
                                                            1e-12));
  }
}

TEST(BoardPlan, RefusesWhatCannotBePrinted) {
  EXPECT_THROW(plan_board(design(kPapers[0], 240, false)), std::invalid_argument) << "too large";
  EXPECT_THROW(plan_board(design(kPapers[0], -1, false)), std::invalid_argument);
  BoardDesign unknown;
  unknown.family = "tagCircle21h7";
  EXPECT_THROW(plan_board(unknown), std::invalid_argument) << "no black square";
  BoardDesign many = design(kPapers[0], 20, true);
  many.family = "tag16h5";  // 30 codes
  EXPECT_THROW(plan_board(many), std::invalid_argument) << "more tags than codes";
}

}  // namespace
}  // namespace sheen::capture::test
