// SPDX-License-Identifier: MIT
#include "fitting/sparse/mean_over_views.h"

#include "fitting/sparse/columns.h"

#include <algorithm>
#include <cmath>

namespace sheen::fitting::sparse {
namespace {

/// The samples' directions and weights; rows behind the last lie outside the disc and weigh
/// nothing.
struct WeightedViews {
  std::size_t rows;
  Column u, v, z, weight;
  float total = 0;

  WeightedViews(const SampleStore& samples, const SamplePool& pool) : rows(padded(samples.size())) {
    constexpr float far_outside = 8.0f;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Eigen::Vector2f uv = samples.direction(i, pool);
      const float squared_cosine = std::max(0.0f, 1.0f - uv.squaredNorm());
      u.row[i] = uv.x();
      v.row[i] = uv.y();
      z.row[i] = std::sqrt(squared_cosine);
      weight.row[i] = samples.count(i, pool) * squared_cosine;
      total += weight.row[i];
    }
    for (std::size_t i = samples.size(); i < rows; ++i) {
      u.row[i] = v.row[i] = far_outside;
      z.row[i] = weight.row[i] = 0;
    }
  }
};

}  // namespace

// The mean of a sum of functions is the sum of their means.
Eigen::Vector3f mean_over_views(const PatchModel& model, const SampleStore& samples,
                                const SamplePool& pool) {
  const WeightedViews views(samples, pool);
  if (!(views.total > 0.0f)) return Eigen::Vector3f::Zero();
  Eigen::Vector3f sum = views.total * model.coefficient[0];
  if (model.base_terms == kLinearBase) {
    sum += columns::dot(views.weight, views.u, views.rows) * model.coefficient[1];
    sum += columns::dot(views.weight, views.v, views.rows) * model.coefficient[2];
    sum += columns::dot(views.weight, views.z, views.rows) * model.coefficient[3];
  }
  for (std::size_t rbf = 0; rbf < model.rbf_count; ++rbf) {
    const Atom& atom = atoms()[model.atom[rbf]];
    sum += columns::wendland_sum(views.u, views.v, views.weight, views.rows, atom.center.x(),
                                 atom.center.y(), atom.support) *
           model.coefficient[model.base_terms + rbf];
  }
  return sum / views.total;
}

}  // namespace sheen::fitting::sparse
