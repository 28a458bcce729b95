// SPDX-License-Identifier: MIT
#include "app/start/sheet_picture.h"

#include "capture/board_print/board_plan.h"
#include "capture/board_print/tag_bitmap.h"
#include "capture/pose/apriltag_family.h"

#include <opencv2/imgproc.hpp>

#include <cmath>

namespace sheen::app {
namespace {

constexpr double kPxPerMm = 2;

int pixels(double mm) {
  return static_cast<int>(std::lround(kPxPerMm * mm));
}

capture::BoardDesign design_on(const std::string& paper) {
  capture::BoardDesign design;
  for (const capture::Paper& known : capture::kPapers) {
    if (known.name == paper) design.paper = known;
  }
  return design;
}

}  // namespace

cv::Mat draw_sheet(const std::string& paper) {
  const capture::BoardPlan plan = capture::plan_board(design_on(paper));
  const auto family = capture::AprilTagFamily::find(plan.design.family).value();
  const double height_mm = plan.design.paper.height_mm;
  cv::Mat picture(pixels(height_mm), pixels(plan.design.paper.width_mm), CV_8UC3,
                  cv::Scalar::all(246));
  const auto [left_mm, foot_mm] = capture::block_corner_mm(plan, plan.sheets.front());
  for (int row = 0; row < plan.rows; ++row) {
    for (int column = 0; column < plan.columns; ++column) {
      const auto id = plan.tag_id(column, row);
      if (!id) continue;
      const capture::TagBitmap tag = capture::draw_tag(family, *id);
      const double module_mm = plan.design.tag_mm / tag.modules_across_tag;
      const double x_mm = left_mm + plan.pitch_mm * (column + 0.5) - 0.5 * module_mm * tag.modules;
      const double top_mm =
          height_mm - foot_mm - plan.pitch_mm * (row + 0.5) - 0.5 * module_mm * tag.modules;
      for (int y = 0; y < tag.modules; ++y) {
        for (int x = 0; x < tag.modules; ++x) {
          if (!tag.is_black(y, x)) continue;
          const cv::Point from(pixels(x_mm + x * module_mm), pixels(top_mm + y * module_mm));
          const cv::Point to(pixels(x_mm + (x + 1) * module_mm),
                             pixels(top_mm + (y + 1) * module_mm));
          picture(cv::Rect(from, to)) = cv::Scalar(40, 36, 34);
        }
      }
    }
  }
  return picture;
}

}  // namespace sheen::app
