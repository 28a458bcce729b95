// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/board.h"
#include "capture/pose/tag_detector.h"
#include "core/geometry/camera.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sheen::capture {

/// How the tags that images show lie against a board. A tag is in place where the joint pose of the
/// image's tags puts its corners within half its side: no lens and no curled sheet moves one so
/// far.
struct TagPlaces {
  int seen = 0;      ///< tags of the board's family, over all images
  int known = 0;     ///< of those, such as the board holds
  int in_place = 0;  ///< of those, such as lie where it says
  struct Sightings {
    int in_place = 0, elsewhere = 0;
  };
  std::map<int, Sightings> of_tag;  ///< that the board holds, where the image has a pose
  std::map<int, int> unknown;       ///< images of each tag that it does not hold
};

/// `views` holds the tags detected in each image, ids unique within one. Tag k + `shift` of the
/// print is taken for tag k of the board.
TagPlaces place_tags(const Board& board, const core::CameraModel& camera,
                     const std::vector<std::vector<TagDetection>>& views, int shift = 0);

struct IdFault {
  std::string fault;
  std::string remedy;
};

/// Whether the board's ids are all off by one number: with it nearly every tag seen is in place,
/// and as they are some are not. Boards are regular, so that most tags of a shifted one fit a pose
/// that is a few tags off. A board without a tag out of place is believed, whatever else lies
/// there.
std::optional<IdFault> shifted_ids(const Board& board, const core::CameraModel& camera,
                                   const std::vector<std::vector<TagDetection>>& views);

}  // namespace sheen::capture
