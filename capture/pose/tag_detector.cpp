// SPDX-License-Identifier: MIT
#include "capture/pose/tag_detector.h"

#include "capture/pose/apriltag_family.h"

#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace sheen::capture {

class TagDetector::Implementation {
 public:
  virtual ~Implementation() = default;
  virtual std::vector<TagDetection> detect(const cv::Mat& grey) = 0;
};

class TagDetector::AprilTag : public Implementation {
 public:
  AprilTag(const TagFamily& family, int corrected_bits)
      : codes_(*AprilTagFamily::find(family.name)),
        detector_(apriltag_detector_create(), apriltag_detector_destroy) {
    apriltag_detector_add_family_bits(detector_.get(), codes_.get(), corrected_bits);
    detector_->nthreads = 1;  // results must not depend on threads
    detector_->refine_edges = true;
  }

  std::vector<TagDetection> detect(const cv::Mat& grey) override {
    // Decimation costs small tags; large images can afford it.
    detector_->quad_decimate = grey.total() < kDecimateFromPixels ? 1.0F : 2.0F;
    image_u8_t image{grey.cols, grey.rows, static_cast<int>(grey.step), grey.data};
    const std::unique_ptr<zarray_t, void (*)(zarray_t*)> found(
        apriltag_detector_detect(detector_.get(), &image), apriltag_detections_destroy);
    std::vector<TagDetection> tags;
    for (int i = 0; i < zarray_size(found.get()); ++i) {
      apriltag_detection_t* detection = nullptr;
      zarray_get(found.get(), i, &detection);
      TagDetection tag{detection->id, {}, static_cast<double>(detection->decision_margin)};
      for (std::size_t c = 0; c < 4; ++c) {
        // libapriltag's first pixel has its centre at (0.5, 0.5); its corners already start at the
        // lower left and run counter-clockwise on the print.
        tag.corners_px[c] = Eigen::Vector2d(detection->p[c][0] - 0.5, detection->p[c][1] - 0.5);
      }
      tags.push_back(tag);
    }
    return tags;
  }

 private:
  static constexpr std::size_t kDecimateFromPixels = 500'000;
  AprilTagFamily codes_;  // outlives the detector, which only points at it
  std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)> detector_;
};

class TagDetector::Aruco : public Implementation {
 public:
  explicit Aruco(const TagFamily& family)
      : half_turn_(family.half_turn),
        modules_(family.modules),
        codes_(cv::aruco::getPredefinedDictionary(family.aruco_dictionary_id)),
        parameters_(cv::aruco::DetectorParameters::create()) {
    parameters_->markerBorderBits = (family.modules - codes_->markerSize) / 2;
    // Refined below: OpenCV's one window for all tags runs away on small ones.
    parameters_->cornerRefinementMethod = cv::aruco::CORNER_REFINE_NONE;
  }

  std::vector<TagDetection> detect(const cv::Mat& grey) override {
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
    cv::aruco::detectMarkers(grey, codes_, corners, ids, parameters_);
    std::vector<TagDetection> tags;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      TagDetection tag{ids[i], {}, cv::arcLength(corners[i], true)};
      refine(grey, tag.quality / 4, corners[i]);
      for (std::size_t c = 0; c < 4; ++c) {
        // OpenCV starts at the upper left and runs clockwise: backwards from its last.
        const cv::Point2f& corner = corners[i][(3 - c + (half_turn_ ? 2 : 0)) % 4];
        tag.corners_px[c] = Eigen::Vector2f(corner.x, corner.y).cast<double>();
      }
      tags.push_back(tag);
    }
    return tags;
  }

 private:
  /// Within three quarters of a module there is nothing but the corner.
  void refine(const cv::Mat& grey, double side_px, std::vector<cv::Point2f>& corners) const {
    const int reach = std::clamp(static_cast<int>(std::lround(0.75 * side_px / modules_)), 2, 5);
    const cv::TermCriteria stop(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 0.01);
    cv::cornerSubPix(grey, corners, {reach, reach}, {-1, -1}, stop);
  }

  bool half_turn_;
  int modules_;
  cv::Ptr<cv::aruco::Dictionary> codes_;
  cv::Ptr<cv::aruco::DetectorParameters> parameters_;
};

TagDetector::TagDetector(const TagFamily& family, int corrected_bits) {
  if (family.library == TagFamily::Library::apriltag) {
    implementation_ = std::make_unique<AprilTag>(family, corrected_bits);
  } else {
    implementation_ = std::make_unique<Aruco>(family);
  }
}

TagDetector::~TagDetector() = default;
TagDetector::TagDetector(TagDetector&&) noexcept = default;
TagDetector& TagDetector::operator=(TagDetector&&) noexcept = default;

std::vector<TagDetection> TagDetector::detect(const cv::Mat& grey) const {
  assert(grey.type() == CV_8UC1);
  std::vector<TagDetection> tags = implementation_->detect(grey);
  std::stable_sort(tags.begin(), tags.end(),
                   [](const TagDetection& a, const TagDetection& b) { return a.id < b.id; });
  return tags;
}

std::vector<TagDetection> drop_ambiguous(const std::vector<TagDetection>& detections) {
  constexpr double clearly_better = 2;
  std::vector<TagDetection> unique;
  for (auto first = detections.begin(); first != detections.end();) {
    const auto last = std::find_if(first, detections.end(),
                                   [&](const TagDetection& tag) { return tag.id != first->id; });
    const auto by_quality = [](const TagDetection& a, const TagDetection& b) {
      return a.quality < b.quality;
    };
    const auto best = std::max_element(first, last, by_quality);
    const bool is_clear = std::all_of(first, last, [&](const TagDetection& tag) {
      return &tag == &*best || best->quality >= clearly_better * tag.quality;
    });
    if (is_clear) unique.push_back(*best);
    first = last;
  }
  return unique;
}

}  // namespace sheen::capture
