// SPDX-License-Identifier: MIT
#include "evaluation/study/study_set.h"

namespace sheen::evaluation {

std::vector<core::SampleBatch> StudySet::batches() const {
  std::vector<core::SampleBatch> batches(frame_count);
  for (std::size_t point = 0; point < points.size(); ++point) {
    for (const TrainingSample& sample : points[point].training) {
      core::SampleBatch& batch = batches[sample.frame_idx];
      batch.patch.push_back(static_cast<std::uint32_t>(point));
      batch.u.push_back(sample.uv.x());
      batch.v.push_back(sample.uv.y());
      batch.r.push_back(sample.rgb.x());
      batch.g.push_back(sample.rgb.y());
      batch.b.push_back(sample.rgb.z());
    }
  }
  return batches;
}

std::size_t StudySet::sample_count() const {
  std::size_t count = 0;
  for (const StudyPoint& point : points) count += point.training.size();
  return count;
}

StudySet only(const StudySet& set, MaterialClass material) {
  StudySet part{set.name, set.frame_count, {}};
  for (const StudyPoint& point : set.points) {
    if (point.material == material) part.points.push_back(point);
  }
  return part;
}

}  // namespace sheen::evaluation
