// SPDX-License-Identifier: MIT
#include "reconstruction/refine/rims.h"

#include "core/concurrency/parallel_for.h"
#include "reconstruction/views/bilinear.h"
#include "reconstruction/views/depth_image.h"

#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sheen::reconstruction {
namespace {

constexpr float kStep_px = 0.5F;
constexpr float kLeastContrast = 0.06F;
constexpr float kFullContrast = 0.2F;  // from which on a rim has full weight
constexpr float kRound_px = 30;        // by which a surface may come nearer just within its rim
constexpr float kJump_px = 6;          // depth step, in pixels' size, that makes a rim
constexpr float kFoot_px = 6;          // above the sheet, where an object meets its own shadow

struct Profile {
  float shift_px, weight;
};

/// A place on the outline in one image.
struct Outline {
  cv::Point2f place;
  cv::Point2f outward;
};

/// Position of the object's edge along a profile from -reach to +reach: sum of its shares.
template <typename BehindAt>
std::optional<Profile> match_profile(const cv::Mat& image, const Outline& outline, float reach_px,
                                     const BehindAt& behind_at) {
  const int steps = static_cast<int>(std::lround(reach_px / kStep_px));
  const auto at = [&](int i) {
    return outline.place + outline.outward * (kStep_px * static_cast<float>(i));
  };
  cv::Vec3f object(0, 0, 0);
  float inner = 0;
  for (int i = -steps; i <= -steps / 2; ++i, ++inner) {
    object += bilinear_bgr(image, at(i).x, at(i).y);
  }
  object *= 1 / inner;
  float sum = 0;
  float first = 1;
  float last = 0;
  float contrast_sum = 0;
  for (int i = -steps; i <= steps; ++i) {
    const std::optional<cv::Vec3f> behind = behind_at(at(i));
    if (!behind) return std::nullopt;
    const cv::Vec3f contrast = object - *behind;
    const float strength = contrast.dot(contrast);
    if (strength < kLeastContrast * kLeastContrast) return std::nullopt;
    contrast_sum += std::sqrt(strength);
    const float alpha = std::clamp(
        (bilinear_bgr(image, at(i).x, at(i).y) - *behind).dot(contrast) / strength, 0.0F, 1.0F);
    if (i == 1 - steps) first = alpha;
    if (i == steps - 1) last = alpha;
    sum += alpha;
  }
  if (first < 0.75F || last > 0.25F) return std::nullopt;
  const float contrast = contrast_sum / static_cast<float>(2 * steps + 1) / kFullContrast;
  return Profile{(sum - 0.5F) * kStep_px - reach_px, std::min(1.0F, contrast * contrast)};
}

class RimFinder {
 public:
  RimFinder(const View& view, const ViewBackground& background, const core::Mesh& mesh,
            const cv::Mat& depth, float reach_px)
      : view_(view), background_(background), mesh_(mesh), depth_(depth), reach_px_(reach_px) {}

  void find(std::vector<RimPoint>& rims) const {
    std::vector<float> facing(mesh_.positions.size());
    for (std::size_t i = 0; i < facing.size(); ++i) {
      facing[i] = mesh_.normals[i].dot(view_.project.eye() - mesh_.positions[i]);
    }
    for (const auto& triangle : mesh_.triangles) {
      for (int corner = 0; corner < 3; ++corner) {
        const std::uint32_t a = triangle[corner];
        const std::uint32_t b = triangle[(corner + 1) % 3];
        // Each edge once: in the triangle where it runs upwards.
        if (a > b || (facing[a] > 0) == (facing[b] > 0)) continue;
        const float share = facing[a] / (facing[a] - facing[b]);
        if (auto rim = look(a, b, share)) rims.push_back(*rim);
      }
    }
  }

 private:
  [[nodiscard]] std::optional<RimPoint> look(std::uint32_t a, std::uint32_t b, float share) const {
    const Eigen::Vector3f point =
        mesh_.positions[a] + share * (mesh_.positions[b] - mesh_.positions[a]);
    const Eigen::Vector3f normal =
        (mesh_.normals[a] + share * (mesh_.normals[b] - mesh_.normals[a])).normalized();
    const auto pixel = view_.project(point);
    if (!pixel || !view_.project.in_image(pixel, reach_px_ + 4)) return std::nullopt;
    const float px_per_m = view_.project.px_per_m(pixel.depth_m);
    const auto out = view_.project(point + normal / px_per_m);
    if (!out) return std::nullopt;
    Outline outline{{pixel.x_px, pixel.y_px}, {out.x_px - pixel.x_px, out.y_px - pixel.y_px}};
    const float length = std::hypot(outline.outward.x, outline.outward.y);
    if (length < 0.8F) return std::nullopt;
    outline.outward *= 1 / length;

    // Itself just within, something farther or nothing just without.
    const float jump_m = kJump_px / px_per_m;
    const float within = depth_at(outline.place - 1.5F * outline.outward);
    if (!(within > pixel.depth_m - kRound_px / px_per_m) || within > pixel.depth_m + jump_m) {
      return std::nullopt;
    }
    bool on_stage = true;
    for (float s = 1.5F; s <= reach_px_ + 1; s += 1) {
      const float without = depth_at(outline.place + s * outline.outward);
      if (without > 0 && without < pixel.depth_m + jump_m) return std::nullopt;
      on_stage = on_stage && !(without > 0);
    }
    const auto profile = on_stage ? against_stage(outline) : against_object(outline);
    if (!profile) return std::nullopt;
    // The dark line where an object meets the sheet is neither's colour and seems to cut it short.
    if (profile->shift_px < 0 && point.z() * px_per_m < kFoot_px) return std::nullopt;
    return RimPoint{{a, b}, share, profile->shift_px / px_per_m, profile->weight, on_stage};
  }

  [[nodiscard]] float depth_at(const cv::Point2f& place) const {
    return depth_.at<float>(static_cast<int>(std::lround(place.y)),
                            static_cast<int>(std::lround(place.x)));
  }

  [[nodiscard]] std::optional<Profile> against_stage(const Outline& outline) const {
    return match_profile(
        view_.image, outline, reach_px_, [&](const cv::Point2f& p) -> std::optional<cv::Vec3f> {
          if (background_.known.at<std::uint8_t>(static_cast<int>(std::lround(p.y)),
                                                 static_cast<int>(std::lround(p.x))) == 0) {
            return std::nullopt;
          }
          return bilinear_bgr(background_.colour, p.x, p.y);
        });
  }

  /// Against a farther part of the object, whose colour is that just without.
  [[nodiscard]] std::optional<Profile> against_object(const Outline& outline) const {
    cv::Vec3f behind(0, 0, 0);
    float count = 0;
    for (float s = 0.5F * reach_px_; s <= reach_px_; s += kStep_px, ++count) {
      const cv::Point2f p = outline.place + s * outline.outward;
      behind += bilinear_bgr(view_.image, p.x, p.y);
    }
    behind *= 1 / count;
    return match_profile(view_.image, outline, reach_px_,
                         [&](const cv::Point2f&) -> std::optional<cv::Vec3f> { return behind; });
  }

  const View& view_;
  const ViewBackground& background_;
  const core::Mesh& mesh_;
  const cv::Mat& depth_;
  float reach_px_;
};

}  // namespace

std::vector<RimPoint> find_rims(const ViewSet& views,
                                const std::vector<ViewBackground>& backgrounds,
                                const core::Mesh& mesh, float reach_px, int threads) {
  std::vector<std::vector<RimPoint>> of_view(views.views.size());
  core::parallel_for(
      of_view.size(), threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
          const cv::Mat depth = draw_depth(mesh, views.views[v].project).depth;
          RimFinder(views.views[v], backgrounds[v], mesh, depth, reach_px).find(of_view[v]);
        }
      },
      1);
  std::vector<RimPoint> rims;
  for (const auto& some : of_view) rims.insert(rims.end(), some.begin(), some.end());
  return rims;
}

}  // namespace sheen::reconstruction
