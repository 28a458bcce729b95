// SPDX-License-Identifier: MIT
#include "reconstruction/object/object_mesh.h"

#include "core/concurrency/parallel_for.h"
#include "core/diagnostics/error.h"
#include "core/numerics/median.h"
#include "reconstruction/hull/visual_hull.h"
#include "reconstruction/object/coarse_pass.h"
#include "reconstruction/object/failure_cause.h"
#include "reconstruction/object/outline_pass.h"
#include "reconstruction/object/refusals.h"
#include "reconstruction/object/shape.h"
#include "reconstruction/silhouette/segmentation.h"
#include "reconstruction/stereo/carve_roofs.h"
#include "reconstruction/stereo/depth_maps.h"
#include "reconstruction/stereo/proven_carving.h"
#include "reconstruction/surface/marching_tetrahedra.h"
#include "reconstruction/surface/surface_mesh.h"
#include "reconstruction/views/depth_image.h"

#include <opencv2/core.hpp>

#include <algorithm>
#include <optional>

namespace sheen::reconstruction {
namespace {

constexpr double kMostTexels = 1e6;
constexpr std::size_t kCoarseViews = 40;  // of the first passes
constexpr int kCoarseWidth_px = 480;
constexpr std::size_t kOneViewIn = 32;   // may be wrong in the last pass
constexpr float kOutlineBlur_px = 1.5F;  // by which one outline may lie wrong
constexpr int kCoarseCells = 72;         // along the longest side
constexpr std::size_t kMostViews = 120;  // of the last pass
constexpr int kFineCells = 160;
constexpr std::size_t kStereoViews = 48;
constexpr float kStereoObject_px = 300;  // its longest side, at most
constexpr float kSmoothLimit_cells = 3;
constexpr int kSmoothRounds = 2;      // against the steps of pixels
constexpr int kSmoothRoundsMore = 4;  // where triangles would cross else
constexpr float kFootRounded_px = 1;  // by the triangles at the foot's edge

/// Everything that is kept while an object is measured.
class Measurement {
 public:
  Measurement(std::filesystem::path session, const core::CameraModel& camera,
              const capture::Board& board, const std::vector<PosedImage>& images, int threads,
              WorkProgress progress)
      : session_(std::move(session)),
        board_(board),
        threads_(threads),
        progress_(std::move(progress)),
        views_(reduced(make_view_set(camera, images, threads), kMostViews, camera.width_px(),
                       threads)) {}

  ObjectMesh run() {
    refuse_narrow_range(session_, board_, views_);
    try {
      Shape shape = find_coarse_shape();
      shape = find_fine_shape(shape);
      return make_surface(shape);
    } catch (const core::Error&) {
      refuse_by_cause(session_, board_, coarse_views(), paper_share_, threads_);
      throw;
    }
  }

 private:
  [[nodiscard]] ViewSet coarse_views() const {
    return reduced(views_, kCoarseViews, kCoarseWidth_px, threads_);
  }

  /// In which the object is as large as stereo needs: more pixels cost time and show little more.
  [[nodiscard]] ViewSet stereo_views(const Eigen::AlignedBox3f& object) const {
    const float object_px = object.sizes().maxCoeff() / pixel_at(object.center());
    const float share = std::min(1.0F, kStereoObject_px / object_px);
    const auto width_px = static_cast<int>(share * static_cast<float>(views_.camera.width_px()));
    return reduced(views_, kStereoViews, std::max(1, width_px), threads_);
  }

  [[nodiscard]] Shape find_coarse_shape() {
    const ViewSet views = coarse_views();
    const CoarseGrids grids{plane_grid(views, stage_region(board_), kMostTexels),
                            object_region(board_), kCoarseCells};
    std::optional<Shape> shape;
    for (int pass = 0; pass < kCoarsePasses; ++pass) {
      CoarseHull found = carve_coarsely(board_, views, grids, pass, shape ? &*shape : nullptr,
                                        threads_, progress_);
      if (pass == 0) result_.hidden_share = refuse_hidden_sheet(session_, board_, found.stage);
      paper_share_ = found.paper_share;
      shape = pass + 1 < kCoarsePasses ? likeliest_shape(session_, std::move(found.grid))
                                       : only_shape(session_, board_, std::move(found.grid));
    }
    return std::move(shape).value();
  }

  [[nodiscard]] Shape find_fine_shape(const Shape& coarse) {
    const PlaneGrid plane = plane_grid(views_, stage_region(board_), kMostTexels);
    const auto masks = masks_of(coarse, views_, threads_);
    progress_("learning the sheet", 0, 1);
    LearnedStage stage = learn_stage(board_, views_, plane, masks, threads_);
    stage.gains = estimate_gains(views_, stage.map, masks, threads_);
    progress_("learning the sheet", 1, 1);
    const auto silhouettes = cut_out_all(stage, views_, masks, OutlineDetail::matted, threads_,
                                         "outlines, last pass", progress_);
    keep(silhouettes);
    paper_share_ = paper_share(board_, stage, views_, silhouettes);

    Eigen::AlignedBox3f box = coarse.grown(0.06F);
    const float cell = box.sizes().maxCoeff() / kFineCells;
    const float foot_m = -kFootRounded_px * pixel_at(coarse.box.center());
    box.min().z() = foot_m - 2 * cell;
    DistanceGrid grid(box, cell, 1);
    carve_hull(views_, votes_of(silhouettes),
               {.wrong = one_in(kOneViewIn, views_.views.size()),
                .guesses_wrong = one_in(kOneGuessIn, views_.views.size()),
                .blur_px = kOutlineBlur_px},
               &coarse.grid, 2.5F * coarse.grid.cell_m(), threads_, grid);
    carve_what_stereo_shows(coarse.box, grid);
    grid.smooth(kSmoothLimit_cells * cell, kSmoothRounds, threads_);
    grid.cut_below(foot_m);  // last, so that the foot's edge stays sharp
    return only_shape(session_, board_, std::move(grid));
  }

  /// Roofs that no silhouette shows.
  void carve_what_stereo_shows(const Eigen::AlignedBox3f& object, DistanceGrid& grid) const {
    const DistanceGrid hull = grid;
    const DepthMaps maps =
        find_depths(stereo_views(object), march_tetrahedra(hull), threads_, progress_);
    carve_roofs(maps, kSmoothLimit_cells * grid.cell_m(), threads_, grid);
    keep_proven_carving(maps, hull, threads_, grid);
  }

  /// What the refinement reads of the silhouettes.
  void keep(const std::vector<Silhouette>& silhouettes) {
    for (const Silhouette& silhouette : silhouettes) {
      labels_.push_back(silhouette.labels);
      ViewBackground kept;
      silhouette.background.colour.convertTo(kept.colour, CV_8UC3, 255);
      kept.known = silhouette.background.source == static_cast<double>(TexelSource::seen);
      backgrounds_.push_back(std::move(kept));
    }
  }

  [[nodiscard]] float pixel_at(const Eigen::Vector3f& point) const {
    std::vector<double> px_per_m;
    for (const View& view : views_.views) {
      const auto pixel = view.project(point);
      if (pixel) px_per_m.push_back(static_cast<double>(view.project.px_per_m(pixel.depth_m)));
    }
    return px_per_m.empty() ? 0.001F : static_cast<float>(1 / core::upper_median(px_per_m));
  }

  /// Share of the silhouettes' pixels that the mesh covers.
  [[nodiscard]] float covered_share(const core::Mesh& mesh) const {
    std::vector<std::array<double, 2>> counts(views_.views.size());
    core::parallel_for(
        counts.size(), threads_,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t v = begin; v < end; ++v) {
            const cv::Mat object = labels_[v] == static_cast<double>(PixelLabel::object);
            const cv::Mat drawn = draw_depth(mesh, views_.views[v].project).mask();
            counts[v] = {static_cast<double>(cv::countNonZero(object & drawn)),
                         static_cast<double>(cv::countNonZero(object))};
          }
        },
        1);
    double covered = 0;
    double all = 0;
    for (const auto& [some, of] : counts) {
      covered += some;
      all += of;
    }
    return all == 0 ? 0 : static_cast<float>(covered / all);
  }

  [[nodiscard]] Surface surface_of(const DistanceGrid& grid, const core::Mesh& hull) const {
    return make_surface_mesh({views_, backgrounds_, hull, grid, result_.pixel_m}, threads_,
                             progress_);
  }

  [[nodiscard]] ObjectMesh make_surface(const Shape& shape) {
    const core::Mesh hull = march_tetrahedra(shape.grid);
    refuse_moved_object(session_, covered_share(hull));
    result_.pixel_m = pixel_at(shape.box.center());
    Surface surface = surface_of(shape.grid, hull);
    if (!surface.is_refined) {  // creases that carving left are smoothed away
      DistanceGrid smoother = shape.grid;
      smoother.smooth(kSmoothLimit_cells * smoother.cell_m(), kSmoothRoundsMore, threads_);
      smoother.cut_below(-kFootRounded_px * result_.pixel_m);
      Surface again = surface_of(smoother, march_tetrahedra(smoother));
      if (again.is_refined) surface = std::move(again);
    }
    result_.mesh = std::move(surface.mesh);
    result_.confidence = std::move(surface.confidence);
    result_.edge_m = surface.edge_m;
    result_.covered_share = covered_share(result_.mesh);
    result_.views = views_.views.size();
    return std::move(result_);
  }

  std::filesystem::path session_;
  const capture::Board& board_;
  int threads_;
  WorkProgress progress_;
  ViewSet views_;
  float paper_share_ = 0;  ///< of what was cut out last
  std::vector<cv::Mat> labels_;
  std::vector<ViewBackground> backgrounds_;
  ObjectMesh result_;
};

}  // namespace

ObjectMesh measure_object(const std::filesystem::path& session, const core::CameraModel& camera,
                          const capture::Board& board, const std::vector<PosedImage>& images,
                          int threads, const WorkProgress& progress) {
  return Measurement(session, camera, board, images, threads, progress).run();
}

}  // namespace sheen::reconstruction
