// SPDX-License-Identifier: MIT
#include "fitting/multi_eigenspace/eigenspace_fitter.h"

#include "core/mesh/bounds.h"
#include "core/visibility/depth_image.h"
#include "fitting/kept_views/mean_keeper.h"
#include "fitting/multi_eigenspace/multi_eigenspace.h"
#include "fitting/multi_eigenspace/pack_pictures.h"
#include "fitting/multi_eigenspace/partition_views.h"
#include "fitting/multi_eigenspace/rectified_picture.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace sheen::fitting::multi_eigenspace {
namespace {

/// Of the photographs that are kept while the fit runs: hardly a loss.
constexpr int kJpegQuality = 97;
/// Side of the pictures on which views are grouped.
constexpr int kWorking_px = 96;
/// So many views are the first to be packed.
constexpr std::size_t kFirst = 4;

/// A sphere round the vertices, about the middle of their box.
PictureFrame frame_around(const core::Mesh& mesh) {
  PictureFrame frame{core::bounds_of(mesh).center().cast<double>(), 0, Eigen::Vector3d::UnitZ()};
  for (const Eigen::Vector3f& position : mesh.positions) {
    frame.radius_m = std::max(frame.radius_m, (position.cast<double>() - frame.centre).norm());
  }
  return frame;
}

class EigenspaceFitter final : public Fitter {
 public:
  EigenspaceFitter(const core::Mesh& mesh, const Options& options, int threads)
      : depth_(mesh, threads),
        means_(mesh, threads),
        rectifier_(mesh, threads),
        frame_(frame_around(mesh)),
        threads_(threads),
        model_(options, mesh.positions.size()) {}

  const ModelUpdate& integrate(const core::Observation& observation) override;
  const ModelUpdate& finish() override;
  [[nodiscard]] const LightField& light_field() const override { return model_; }
  [[nodiscard]] FitStatistics statistics() const override { return means_.statistics(); }

 private:
  [[nodiscard]] bool is_wanted(const Eigen::Vector3d& eye) const;
  void pack();

  core::DepthImage depth_;
  MeanKeeper means_;
  Rectifier rectifier_;
  PictureFrame frame_;
  int threads_;
  std::vector<KeptView> photographs_;
  std::vector<Eigen::Vector3d> directions_;  ///< of the photographs
  std::size_t packed_ = 0;                   ///< of them
  MultiEigenspace model_;
  ModelUpdate update_;
};

/// Far enough from the object and from all that is kept.
bool EigenspaceFitter::is_wanted(const Eigen::Vector3d& eye) const {
  if (!sees_all(frame_, eye)) return false;
  const Eigen::Vector3d direction = (eye - frame_.centre).normalized();
  const double spacing = model_.options().view_spacing_deg * std::numbers::pi / 180;
  // By the chord, which tells small angles apart.
  const double least = 2 * std::sin(spacing / 2);
  return std::ranges::all_of(
      directions_, [&](const Eigen::Vector3d& kept) { return (kept - direction).norm() >= least; });
}

const ModelUpdate& EigenspaceFitter::integrate(const core::Observation& observation) {
  update_.elements.clear();
  means_.integrate(observation);
  model_.set_means(means_.means());
  const Eigen::Vector3d eye = observation.camera_from_object.inverse().translation();
  if (!is_wanted(eye)) return update_;
  depth_.draw(observation.view, observation.image.size(), observation.camera_from_object);
  if (depth_.box().empty()) return update_;
  directions_.push_back((eye - frame_.centre).normalized());
  photographs_.push_back(keep_view(observation, depth_, kJpegQuality, Surroundings::photographed));
  if (photographs_.size() >= std::max(2 * packed_, kFirst)) pack();
  return update_;
}

const ModelUpdate& EigenspaceFitter::finish() {
  update_.elements.clear();
  means_.finish();
  model_.set_means(means_.means());
  if (packed_ < photographs_.size()) pack();
  return update_;
}

void EigenspaceFitter::pack() {
  // Rectify.
  frame_.up = upright(photographs_);
  const Options& options = model_.options();
  std::vector<cv::Mat> pictures, small;
  const int working_px = std::min(kWorking_px, options.picture_px);
  for (const KeptView& photograph : photographs_) {
    pictures.push_back(rectifier_.picture(photograph, frame_, options.picture_px));
    cv::resize(pictures.back(), small.emplace_back(), {working_px, working_px}, 0, 0,
               cv::INTER_AREA);
  }

  // Group, on small pictures.
  const ViewGraph graph(directions_);
  const GroupRule rule{options.eigenimages, options.tolerance};
  const Partition partition =
      partition_views(gram_of(small, pixel_weights(small)), graph, rule, threads_);

  // Pack, and each space's neighbours for the transitions.
  const cv::Mat weights = pixel_weights(pictures);
  std::vector<Eigenspace> spaces;
  std::vector<ViewInSpace> views;
  for (const ViewGroup& group : partition.groups) {
    std::vector<std::uint32_t> guards;
    for (const std::uint32_t member : group.members) {
      for (const std::uint32_t next : graph.mixed_with(member)) {
        if (!std::ranges::binary_search(group.members, next)) guards.push_back(next);
      }
    }
    std::ranges::sort(guards);
    guards.erase(std::unique(guards.begin(), guards.end()), guards.end());
    PackedSpace packed = pack_pictures(pictures, weights, group.members, guards,
                                       static_cast<std::uint32_t>(spaces.size()),
                                       {options.eigenimages, rule.allowed()});
    spaces.push_back(std::move(packed.space));
    std::ranges::move(packed.views, std::back_inserter(views));
  }
  model_.set_spaces(frame_, directions_, partition.owners, std::move(spaces), std::move(views));
  packed_ = photographs_.size();
  update_.elements.resize(model_.element_count());
  std::iota(update_.elements.begin(), update_.elements.end(), 0U);
}

}  // namespace

std::unique_ptr<Fitter> make_eigenspace_fitter(const core::Mesh& mesh, const Options& options,
                                               int threads) {
  options.check();
  return std::make_unique<EigenspaceFitter>(mesh, options, threads);
}

}  // namespace sheen::fitting::multi_eigenspace
