// SPDX-License-Identifier: MIT
#include "evaluation/views/contact_sheet.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>

namespace sheen::evaluation {
namespace {

constexpr int kCellWidth = 300;
constexpr int kCellHeight = 240;
constexpr int kGap = 10;
constexpr int kMargin = 24;
constexpr int kLabelHeight = 30;
constexpr double kDifferenceGain = 4;
const cv::Scalar kPaper(250, 250, 250);
const cv::Scalar kInk(60, 55, 50);

/// The object's place in the image with some air, in the cell's proportions.
cv::Rect crop_around(const cv::Mat& mask) {
  cv::Rect box = cv::boundingRect(mask);
  const cv::Point2d centre(box.x + box.width / 2.0, box.y + box.height / 2.0);
  const double aspect = static_cast<double>(kCellWidth) / kCellHeight;
  double height = std::max<double>(box.height, box.width / aspect) * 1.12;
  height = std::min({height, static_cast<double>(mask.rows), mask.cols / aspect});
  const double width = height * aspect;
  const double x = std::clamp(centre.x - width / 2, 0.0, std::max(0.0, mask.cols - width));
  const double y = std::clamp(centre.y - height / 2, 0.0, std::max(0.0, mask.rows - height));
  return cv::Rect(static_cast<int>(x), static_cast<int>(y), static_cast<int>(width),
                  static_cast<int>(height)) &
         cv::Rect(0, 0, mask.cols, mask.rows);
}

cv::Mat cell(const cv::Mat& image, const cv::Rect& crop) {
  cv::Mat scaled;
  const int interpolation = crop.width > kCellWidth ? cv::INTER_AREA : cv::INTER_LANCZOS4;
  cv::resize(image(crop), scaled, {kCellWidth, kCellHeight}, 0, 0, interpolation);
  return scaled;
}

/// Light where the image is right, dark where it is wrong.
cv::Mat difference(const render::RenderedView& view, const cv::Mat& photograph) {
  cv::Mat brightened;
  cv::absdiff(view.image, photograph, brightened);
  cv::cvtColor(brightened, brightened, cv::COLOR_BGR2GRAY);
  brightened.convertTo(brightened, -1, -kDifferenceGain, 255);
  cv::cvtColor(brightened, brightened, cv::COLOR_GRAY2BGR);
  cv::Mat image(photograph.size(), CV_8UC3, kPaper);
  brightened.copyTo(image, view.mask);
  return image;
}

/// On white, so that the object is compared and not the missing background.
cv::Mat on_paper(const render::RenderedView& view) {
  cv::Mat image(view.image.size(), CV_8UC3, kPaper);
  view.image.copyTo(image, view.mask);
  return image;
}

void write(cv::Mat& sheet, const std::string& text, cv::Point place) {
  cv::putText(sheet, text, place, cv::FONT_HERSHEY_DUPLEX, 0.5, kInk, 1, cv::LINE_AA);
}

}  // namespace

ContactSheet::ContactSheet(std::vector<std::string> names) : names_(std::move(names)) {}

void ContactSheet::add(const ComparedView& view) {
  const cv::Rect crop = crop_around(view.mask);
  std::vector<cv::Mat> cells{cell(view.photograph.image, crop)};
  std::vector<std::string> captions{fmt::format("view {}: photograph", view.photograph.index)};
  for (std::size_t i = 0; i < names_.size(); ++i) {
    cells.push_back(cell(on_paper(view.rendered[i]), crop));
    captions.push_back(fmt::format("{}  {:.1f} dB", names_[i], view.errors[i].error.psnr_db));
  }
  for (std::size_t i = 0; i < names_.size(); ++i) {
    cells.push_back(cell(difference(view.rendered[i], view.photograph.image), crop));
    captions.push_back(fmt::format("{}: error x {:.0f}", names_[i], kDifferenceGain));
  }
  columns_.push_back(std::move(cells));
  captions_.push_back(std::move(captions));
}

cv::Mat ContactSheet::image() const {
  if (columns_.empty()) return {};
  const int rows = static_cast<int>(columns_.front().size());
  const int columns = static_cast<int>(columns_.size());
  const int row_height = kCellHeight + kLabelHeight + kGap;
  cv::Mat sheet(2 * kMargin - kGap + rows * row_height,
                2 * kMargin - kGap + columns * (kCellWidth + kGap), CV_8UC3, kPaper);
  for (int column = 0; column < columns; ++column) {
    for (int row = 0; row < rows; ++row) {
      const cv::Point corner(kMargin + column * (kCellWidth + kGap), kMargin + row * row_height);
      const auto column_idx = static_cast<std::size_t>(column);
      const auto row_idx = static_cast<std::size_t>(row);
      columns_[column_idx][row_idx].copyTo(
          sheet(cv::Rect(corner.x, corner.y, kCellWidth, kCellHeight)));
      write(sheet, captions_[column_idx][row_idx], corner + cv::Point(2, kCellHeight + 20));
    }
  }
  return sheet;
}

}  // namespace sheen::evaluation
