// SPDX-License-Identifier: MIT
#pragma once

#include "evaluation/views/evaluate_views.h"

#include <opencv2/core/mat.hpp>

#include <string>
#include <vector>

namespace sheen::evaluation {

/// An image that lets people judge with their eyes: one column per view; the rows are the
/// photograph, what each renderer drew, and each one's difference to the photograph, brightened.
/// Every cell is cropped to the object.
class ContactSheet {
 public:
  /// `names` label the renderers' rows, in order.
  explicit ContactSheet(std::vector<std::string> names);

  void add(const ComparedView& view);

  /// The sheet so far, CV_8UC3; empty when nothing was added.
  [[nodiscard]] cv::Mat image() const;

 private:
  std::vector<std::string> names_;
  std::vector<std::vector<cv::Mat>> columns_;       ///< per view: one cell per row
  std::vector<std::vector<std::string>> captions_;  ///< per view: one per row
};

}  // namespace sheen::evaluation
