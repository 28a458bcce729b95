// SPDX-License-Identifier: MIT
#include "reconstruction/object/object_mesh.h"

#include "core/concurrency/parallel_for.h"
#include "core/numerics/median.h"
#include "reconstruction/hull/visual_hull.h"
#include "reconstruction/object/refusals.h"
#include "reconstruction/silhouette/cut_out.h"
#include "reconstruction/silhouette/segmentation.h"
#include "reconstruction/stage/print_check.h"
#include "reconstruction/surface/marching_tetrahedra.h"
#include "reconstruction/surface/surface_mesh.h"
#include "reconstruction/views/depth_image.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <atomic>
#include <string>

namespace sheen::reconstruction {
namespace {

constexpr float kStageMargin = 0.35F;  // of the tags' extent, learned beyond it
constexpr float kHighest = 0.8F;       // of the lowest camera: an object ends below
constexpr float kSpaceMargin = 0.05F;  // and where an object is looked for
constexpr double kMostTexels = 1e6;
constexpr std::size_t kCoarseViews = 40;  // of the first passes
constexpr int kCoarseWidth_px = 480;
constexpr int kCoarsePasses = 5;
constexpr std::size_t kOneViewIn = 32;   // may be wrong in the last pass,
constexpr std::size_t kOneGuessIn = 6;   // where the stage is guessed
constexpr float kOutlineBlur_px = 1.5F;  // by which one outline may lie wrong
constexpr int kCoarseCells = 72;         // along the longest side
constexpr std::size_t kMostViews = 120;  // of the last pass
constexpr std::size_t kStageViews = 60;  // that the stage is learned from, at full size
constexpr int kFineCells = 160;
constexpr float kSmoothLimit_cells = 3;
constexpr int kSmoothRounds = 2;      // against the steps of pixels
constexpr float kFoot = 0.06F;        // of the space: objects stand on the sheet
constexpr float kFootRounded_px = 1;  // by the triangles at the foot's edge
constexpr float kMaskGrown_px = 2;

/// What was found of the object so far.
struct Shape {
  DistanceGrid grid;
  Eigen::AlignedBox3f box;  ///< of its inside
};

float longest_side(const Eigen::AlignedBox3f& box) {
  return box.sizes().maxCoeff();
}

Eigen::AlignedBox2f grown_by(const Eigen::AlignedBox2f& region, float share) {
  const Eigen::Vector2f margin = share * region.sizes();
  return {region.min() - margin, region.max() + margin};
}

Eigen::AlignedBox2f stage_region(const capture::Board& board) {
  return grown_by(tags_region(board), kStageMargin);
}

/// Where an object may be: above the sheet, below every camera.
Eigen::AlignedBox3f space_above(const capture::Board& board, const ViewSet& views) {
  const Eigen::AlignedBox2f region = grown_by(tags_region(board), kSpaceMargin);
  float top = region.sizes().maxCoeff();
  for (const View& view : views.views) top = std::min(top, kHighest * view.project.eye().z());
  return {Eigen::Vector3f(region.min().x(), region.min().y(), 0),
          Eigen::Vector3f(region.max().x(), region.max().y(), std::max(top, 0.01F))};
}

/// Where each view sees a shape, grown a little.
std::vector<cv::Mat> masks_of(const Shape& shape, const ViewSet& views, int threads) {
  const core::Mesh surface = march_tetrahedra(shape.grid);
  std::vector<cv::Mat> masks(views.views.size());
  const int side = 1 + 2 * static_cast<int>(kMaskGrown_px);
  const cv::Mat element = cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side});
  core::parallel_for(
      masks.size(), threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
          cv::dilate(draw_depth(surface, views.views[v].project).mask(), masks[v], element);
        }
      },
      1);
  return masks;
}

/// One pass: learn the stage, cut the object out of every view, intersect what was cut out.
class Pass {
 public:
  Pass(const ViewSet& views, int threads) : views_(views), threads_(threads) {}

  void cut(const LearnedStage& stage, const std::vector<cv::Mat>& masks, OutlineDetail detail,
           const WorkProgress& progress, std::string_view step) {
    silhouettes_.resize(views_.views.size());
    // In batches, so that progress is told by the thread that called.
    const auto batch = static_cast<std::size_t>(std::max(1, 2 * threads_));
    for (std::size_t first = 0; first < silhouettes_.size(); first += batch) {
      const std::size_t count = std::min(batch, silhouettes_.size() - first);
      core::parallel_for(
          count, threads_,
          [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = first + begin; v < first + end; ++v) {
              silhouettes_[v] =
                  cut_out(stage, views_, v, masks.empty() ? cv::Mat() : masks[v], detail);
              if (detail == OutlineDetail::pixels) silhouettes_[v].background.colour.release();
            }
          },
          1);
      progress(step, static_cast<int>(first + count), static_cast<int>(silhouettes_.size()));
    }
  }

  [[nodiscard]] std::vector<OutlineVote> votes() const {
    std::vector<OutlineVote> votes;
    for (const Silhouette& silhouette : silhouettes_) {
      votes.push_back({silhouette.distance, silhouette.background.source ==
                                                static_cast<double>(TexelSource::inpainted)});
    }
    return votes;
  }
  [[nodiscard]] const std::vector<Silhouette>& silhouettes() const { return silhouettes_; }

 private:
  const ViewSet& views_;
  int threads_;
  std::vector<Silhouette> silhouettes_;
};

int one_in(std::size_t share, std::size_t views) {
  return std::clamp(static_cast<int>(views / share), 1, 24);
}

/// The first passes know the stage badly: they had better find too much than too little, since what
/// is not found is learned as stage.
CarvingVotes votes_of_pass(int pass, std::size_t views) {
  constexpr std::array<std::size_t, kCoarsePasses> shares{8, 12, 20, 24, 24};
  return {.wrong = one_in(shares[static_cast<std::size_t>(pass)], views),
          .guesses_wrong = one_in(kOneGuessIn, views)};
}

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
    Shape shape = find_coarse_shape();
    shape = find_fine_shape(shape);
    return make_surface(shape);
  }

 private:
  [[nodiscard]] Shape find_coarse_shape() {
    const ViewSet views = reduced(views_, kCoarseViews, kCoarseWidth_px, threads_);
    const PlaneGrid grid = plane_grid(views, stage_region(board_), kMostTexels);
    Shape shape;
    for (int pass = 0; pass < kCoarsePasses; ++pass) {
      const auto masks = pass == 0 ? std::vector<cv::Mat>() : masks_of(shape, views, threads_);
      const LearnedStage stage = learn_stage(board_, views, grid, masks, threads_);
      if (pass == 0) result_.hidden_share = refuse_hidden_sheet(session_, board_, stage.map);
      Pass work(views, threads_);
      work.cut(stage, masks, OutlineDetail::pixels, progress_,
               "outlines, pass " + std::to_string(pass + 1));
      Eigen::AlignedBox3f box = space_above(board_, views);
      if (pass > 0) box = box.intersection(grown(shape, 0.3F));
      box.min().z() = -longest_side(box) / kCoarseCells;
      DistanceGrid next(box, longest_side(box) / kCoarseCells, 1);
      carve_hull(views, work.votes(), votes_of_pass(pass, views.views.size()), nullptr, 0, threads_,
                 next);
      next.cut_below(0);
      shape = pass + 1 < kCoarsePasses ? likeliest(std::move(next)) : checked(std::move(next));
    }
    return shape;
  }

  [[nodiscard]] Shape find_fine_shape(const Shape& coarse) {
    const ViewSet some = reduced(views_, kStageViews, views_.camera.width_px(), threads_);
    const PlaneGrid plane = plane_grid(views_, stage_region(board_), kMostTexels);
    progress_("learning the sheet", 0, 1);
    LearnedStage stage =
        learn_stage(board_, some, plane, masks_of(coarse, some, threads_), threads_);
    const auto masks = masks_of(coarse, views_, threads_);
    stage.gains = estimate_gains(views_, stage.map, masks, threads_);
    progress_("learning the sheet", 1, 1);
    Pass work(views_, threads_);
    work.cut(stage, masks, OutlineDetail::matted, progress_, "outlines, last pass");
    keep(work.silhouettes());

    Eigen::AlignedBox3f box = grown(coarse, 0.06F);
    const float cell = longest_side(box) / kFineCells;
    const float foot_m = -kFootRounded_px * pixel_at(coarse.box.center());
    box.min().z() = foot_m - 2 * cell;
    DistanceGrid grid(box, cell, 1);
    carve_hull(views_, work.votes(),
               {.wrong = one_in(kOneViewIn, views_.views.size()),
                .guesses_wrong = one_in(kOneGuessIn, views_.views.size()),
                .blur_px = kOutlineBlur_px},
               &coarse.grid, 2.5F * coarse.grid.cell_m(), threads_, grid);
    grid.smooth(kSmoothLimit_cells * cell, kSmoothRounds, threads_);
    grid.cut_below(foot_m);  // last, so that the foot's edge stays sharp
    return checked(std::move(grid));
  }

  [[nodiscard]] static Eigen::AlignedBox3f grown(const Shape& shape, float share) {
    const Eigen::Vector3f margin =
        Eigen::Vector3f::Constant(share * longest_side(shape.box) + 2 * shape.grid.cell_m());
    return {shape.box.min() - margin, shape.box.max() + margin};
  }

  /// While the stage is half known, pieces of it may float about: the largest one over the tags.
  [[nodiscard]] Shape likeliest(DistanceGrid grid) const {
    const Components components = find_standing(kFoot * longest_side(grid.box()), grid);
    refuse_empty_sheet(session_, components);
    // What reaches the space's sides goes on beyond them.
    const Eigen::Vector3f margin(1.5F * grid.cell_m(), 1.5F * grid.cell_m(), -1);
    const Eigen::AlignedBox3f inner(grid.box().min() + margin, grid.box().max() - margin);
    std::size_t kept = 0;
    while (kept < components.parts.size() && !inner.contains(components.parts[kept].box)) ++kept;
    if (kept == components.parts.size()) kept = 0;
    keep_component(components, static_cast<int>(kept), grid);
    return {std::move(grid), components.parts[kept].box};
  }

  [[nodiscard]] Shape checked(DistanceGrid grid) const {
    const Components components = find_standing(kFoot * longest_side(grid.box()), grid);
    refuse_empty_sheet(session_, components);
    refuse_what_stands_there(session_, board_, components);
    keep_component(components, 0, grid);
    return {std::move(grid), components.parts.front().box};
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

  [[nodiscard]] ObjectMesh make_surface(const Shape& shape) {
    const core::Mesh hull = march_tetrahedra(shape.grid);
    refuse_moved_object(session_, covered_share(hull));
    result_.pixel_m = pixel_at(shape.box.center());
    const SurfaceInputs inputs{views_, backgrounds_, hull, shape.grid, result_.pixel_m};
    Surface surface = make_surface_mesh(inputs, threads_, progress_);
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
