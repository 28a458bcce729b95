// SPDX-License-Identifier: MIT
#include "fitting/depth_quads/quad_fitter.h"

#include "core/mesh/bounds.h"
#include "core/visibility/depth_image.h"
#include "fitting/depth_quads/depth_quads.h"
#include "fitting/kept_views/mean_keeper.h"

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <algorithm>

namespace sheen::fitting::depth_quads {
namespace {

class QuadFitter final : public Fitter {
 public:
  QuadFitter(const core::Mesh& mesh, const Options& options, int threads)
      : box_(core::bounds_of(mesh)),
        depth_(mesh, threads),
        means_(mesh, threads),
        model_(options, mesh.positions.size()) {}

  [[nodiscard]] bool needs_depth() const override {
    return model_.options().depths == Depths::session;
  }

  const ModelUpdate& integrate(const core::Observation& observation) override;
  const ModelUpdate& finish() override;
  [[nodiscard]] const LightField& light_field() const override { return model_; }
  [[nodiscard]] FitStatistics statistics() const override { return means_.statistics(); }

 private:
  [[nodiscard]] cv::Mat depths_of(const core::Observation& observation) const;

  Eigen::AlignedBox3f box_;  ///< of the mesh
  core::DepthImage depth_;
  MeanKeeper means_;
  DepthQuads model_;
  ModelUpdate update_;
};

/// CV_32FC1 of the crop, 0 where there is no quad. What a sensor measured before or behind all of
/// the object belongs to something else.
cv::Mat QuadFitter::depths_of(const core::Observation& observation) const {
  if (!needs_depth() || observation.depth_m.empty()) return depth_.depth_m();
  const double middle_m = (observation.camera_from_object * box_.center().cast<double>()).z();
  const double reach_m = static_cast<double>(box_.diagonal().norm()) / 2;
  const cv::Mat measured = observation.depth_m(depth_.box());
  cv::Mat depths = cv::Mat::zeros(measured.size(), CV_32FC1);
  measured.copyTo(depths, (depth_.depth_m() > 0.0f) & (measured > middle_m - reach_m) &
                              (measured < middle_m + reach_m) & (measured > 0.0f));
  return depths;
}

const ModelUpdate& QuadFitter::integrate(const core::Observation& observation) {
  update_.elements.clear();
  means_.integrate(observation);
  model_.set_means(means_.means());
  depth_.draw(observation.view, observation.image.size(), observation.camera_from_object);
  if (depth_.box().empty()) return update_;
  const Options& options = model_.options();
  const auto levels = quad_levels(depth_.box().size(), options.spacing_px, options.levels);
  QuadDepths depths = quad_depths(depths_of(observation), levels, options.median);
  // A photograph that misses all middles of the finest cells shows nothing.
  const auto finest = depths.codes.begin() + static_cast<std::ptrdiff_t>(levels.front().size());
  if (std::all_of(depths.codes.begin(), finest, [](auto code) { return code == 0; })) {
    return update_;
  }
  update_.elements = {static_cast<std::uint32_t>(model_.element_count())};
  model_.add(keep_view(observation, depth_, options.views.quality, Surroundings::continued),
             std::move(depths));
  return update_;
}

const ModelUpdate& QuadFitter::finish() {
  update_.elements.clear();
  means_.finish();
  model_.set_means(means_.means());
  return update_;
}

}  // namespace

std::unique_ptr<Fitter> make_quad_fitter(const core::Mesh& mesh, const Options& options,
                                         int threads) {
  options.check();
  return std::make_unique<QuadFitter>(mesh, options, threads);
}

}  // namespace sheen::fitting::depth_quads
