// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/sparse/patch_model.h"
#include "fitting/sparse/sample_store.h"

#include <Eigen/Core>

namespace sheen::fitting::sparse {

/// Mean colour of a patch towards the views of its samples, each weighted with the views that it
/// stands for and the squared cosine between them and the normal; zero without samples.
Eigen::Vector3f mean_over_views(const PatchModel& model, const SampleStore& samples,
                                const SamplePool& pool);

}  // namespace sheen::fitting::sparse
