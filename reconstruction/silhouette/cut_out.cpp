// SPDX-License-Identifier: MIT
#include "reconstruction/silhouette/cut_out.h"

#include "reconstruction/silhouette/evidence.h"
#include "reconstruction/silhouette/outline.h"
#include "reconstruction/silhouette/segmentation.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <vector>

namespace sheen::reconstruction {
namespace {

constexpr float kTrustInGain = 1;
constexpr float kPriorPerPixel = 0.25F;  // log odds per pixel of distance from the earlier outline
constexpr float kPriorInside = 1.0F;     // most other views agree there is something on this ray
constexpr float kPriorOutside = -1;      // weaker: what was lost by mistake may come back

/// Log odds from what was found before.
cv::Mat prior_of(const cv::Mat& mask) {
  cv::Mat inside;
  cv::Mat outside;
  cv::distanceTransform(mask, inside, cv::DIST_L2, cv::DIST_MASK_5);
  cv::distanceTransform(mask == 0, outside, cv::DIST_L2, cv::DIST_MASK_5);
  cv::Mat prior = kPriorPerPixel * (inside - outside);
  return cv::min(cv::max(prior, static_cast<double>(kPriorOutside)),
                 static_cast<double>(kPriorInside));
}

/// Gives back to the stage what does not touch where the object was found: a lifted corner of the
/// sheet, somebody's hand.
void drop_pieces_apart(const cv::Mat& mask, cv::Mat& labels) {
  cv::Mat pieces;
  const int count =
      cv::connectedComponents(labels == static_cast<double>(PixelLabel::object), pieces);
  std::vector<std::uint8_t> touches(static_cast<std::size_t>(count), 0);
  for (int y = 0; y < labels.rows; ++y) {
    for (int x = 0; x < labels.cols; ++x) {
      if (mask.at<std::uint8_t>(y, x) != 0) {
        touches[static_cast<std::size_t>(pieces.at<int>(y, x))] = 1;
      }
    }
  }
  for (int y = 0; y < labels.rows; ++y) {
    for (int x = 0; x < labels.cols; ++x) {
      const int piece = pieces.at<int>(y, x);
      if (piece != 0 && touches[static_cast<std::size_t>(piece)] == 0) {
        labels.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(PixelLabel::stage);
      }
    }
  }
}

/// Where the object may be: round where it was found.
cv::Rect region_of(const cv::Mat& mask) {
  cv::Rect box = cv::boundingRect(mask);
  if (box.empty()) return {{0, 0}, mask.size()};
  const int margin = 8 + std::max(box.width, box.height) / 8;
  box -= cv::Point(margin, margin);
  box += cv::Size(2 * margin, 2 * margin);
  return box;
}

}  // namespace

Silhouette cut_out(const LearnedStage& stage, const ViewSet& views, std::size_t index,
                   const cv::Mat& mask, OutlineDetail detail) {
  const View& view = views.views[index];
  Silhouette silhouette;
  silhouette.background =
      predict_background(stage.map, views, view, stage.gains[index], mask, kTrustInGain);
  const Evidence evidence = compare_with_background(view.image, silhouette.background);
  silhouette.labels = mask.empty() ? segment(evidence, {}, {{0, 0}, view.image.size()})
                                   : segment(evidence, prior_of(mask), region_of(mask));
  if (!mask.empty()) drop_pieces_apart(mask, silhouette.labels);
  silhouette.distance = detail == OutlineDetail::pixels
                            ? silhouette_distance(silhouette.labels)
                            : matted_distance(silhouette.labels, view.image, silhouette.background);
  return silhouette;
}

}  // namespace sheen::reconstruction
