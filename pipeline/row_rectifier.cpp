// SPDX-License-Identifier: MIT
#include "pipeline/row_rectifier.h"

#include "capture/pose/rolling_shutter.h"
#include "core/concurrency/parallel_for.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace sheen::pipeline {
namespace {

constexpr int kNode_px = 16;  // between nodes the motion of a pixel is linear to a thousandth of it

Eigen::Vector2f between(const std::vector<Eigen::Vector2f>& nodes, std::size_t first,
                        std::size_t columns, float fx, float fy) {
  return (1 - fy) * ((1 - fx) * nodes[first] + fx * nodes[first + 1]) +
         fy * ((1 - fx) * nodes[first + columns] + fx * nodes[first + columns + 1]);
}

}  // namespace

RowRectifier::RowRectifier(const capture::Session& session, const core::Mesh* mesh, int threads)
    : camera_(session.camera),
      board_from_object_(session.board_from_object),
      mesh_(mesh),
      threads_(threads) {}

void RowRectifier::prepare() {
  columns_ = (camera_.width_px() - 1) / kNode_px + 2;
  rows_ = (camera_.height_px() - 1) / kNode_px + 2;
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      const auto ray = camera_.unproject(Eigen::Vector2d(x, y) * kNode_px);
      rays_.push_back(ray ? Eigen::Vector2f(ray->head<2>().cast<float>())
                          : Eigen::Vector2f::Constant(std::nanf("")));
    }
  }
  if (mesh_ != nullptr) {
    points_ = core::surface_points(*mesh_);
    depth_.emplace(*mesh_, threads_);
  }
}

capture::Frame RowRectifier::rectify(const capture::Frame& frame,
                                     const Eigen::Isometry3d& camera_from_board,
                                     const capture::Twist& readout_motion) {
  if (readout_motion.isZero()) return frame;
  if (rays_.empty()) prepare();
  see(camera_from_board);
  place_nodes(readout_motion);
  fill_map(camera_from_board);
  capture::Frame rectified = frame;
  rectified.grey = cv::Mat();
  rectified.image = cv::Mat();  // its own: the frame's is shared
  cv::remap(frame.image, rectified.image, map_, cv::noArray(), cv::INTER_CUBIC,
            cv::BORDER_REPLICATE);
  return rectified;
}

/// How far the mesh lies behind every pixel, and what is nearest.
void RowRectifier::see(const Eigen::Isometry3d& camera_from_board) {
  nodes_.nearest = static_cast<float>(1 / camera_from_board.translation().norm());
  if (!depth_) return;
  const Eigen::Isometry3d camera_from_object = camera_from_board * board_from_object_;
  core::project_vertices(points_, camera_, camera_from_object, {}, threads_, view_);
  depth_->draw(view_, {camera_.width_px(), camera_.height_px()}, camera_from_object);
}

/// Exact at two depths; in between an image moves as the inverse depth does.
void RowRectifier::place_nodes(const capture::Twist& readout_motion) {
  const auto place = [&](const Eigen::Vector2f& ray, float inverse_depth) -> Eigen::Vector2f {
    // A point and the motion's shift may be scaled alike: then points may lie infinitely far.
    capture::Twist motion = readout_motion;
    motion.tail<3>() *= static_cast<double>(inverse_depth);
    const Eigen::Vector3d point = ray.cast<double>().homogeneous();
    const auto px = camera_.project(capture::when_its_row_is_read(camera_, motion, point));
    return px ? Eigen::Vector2f(px->cast<float>()) : Eigen::Vector2f::Constant(std::nanf(""));
  };
  nodes_.far.resize(rays_.size());
  nodes_.near.resize(rays_.size());
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    const Eigen::Vector2f node =
        static_cast<float>(kNode_px) *
        Eigen::Vector2f(static_cast<float>(i % static_cast<std::size_t>(columns_)),
                        static_cast<float>(i / static_cast<std::size_t>(columns_)));
    nodes_.far[i] = node;  // where the lens says nothing the image stays
    nodes_.near[i] = node;
    if (!rays_[i].allFinite()) continue;
    const Eigen::Vector2f far = place(rays_[i], 0), near = place(rays_[i], nodes_.nearest);
    if (!far.allFinite() || !near.allFinite()) continue;
    nodes_.far[i] = far;
    nodes_.near[i] = near;
  }
}

/// Of what a pixel shows, 1/m; `plane` gives that of the board from the pixel's ray.
float RowRectifier::inverse_depth(int x, int y, const Eigen::Vector3f& plane) const {
  if (depth_ && depth_->box().contains({x, y})) {
    const float depth_m = depth_->depth_m().at<float>(y - depth_->box().y, x - depth_->box().x);
    if (depth_m > 0) return 1 / depth_m;
  }
  const auto column = static_cast<std::size_t>(x / kNode_px);
  const auto row = static_cast<std::size_t>(y / kNode_px);
  const Eigen::Vector2f ray = between(
      rays_, row * static_cast<std::size_t>(columns_) + column, static_cast<std::size_t>(columns_),
      static_cast<float>(x % kNode_px) / kNode_px, static_cast<float>(y % kNode_px) / kNode_px);
  const float inverse = plane.dot(ray.homogeneous());
  return inverse > 0 ? inverse : 0;  // above the board's horizon, or beyond the lens
}

void RowRectifier::fill_map(const Eigen::Isometry3d& camera_from_board) {
  // Points of the plane: normal . (depth * ray) = offset.
  const Eigen::Vector3d normal = camera_from_board.linear().col(2);
  const Eigen::Vector3f plane =
      (normal / normal.dot(camera_from_board.translation())).cast<float>();
  map_.create(camera_.height_px(), camera_.width_px(), CV_32FC2);
  const auto columns = static_cast<std::size_t>(columns_);
  core::parallel_for(
      static_cast<std::size_t>(map_.rows), threads_,
      [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
          auto* const row = map_.ptr<cv::Vec2f>(y);
          const float fy = static_cast<float>(y % kNode_px) / kNode_px;
          for (int x = 0; x < map_.cols; ++x) {
            const std::size_t first = static_cast<std::size_t>(y / kNode_px) * columns +
                                      static_cast<std::size_t>(x / kNode_px);
            const float fx = static_cast<float>(x % kNode_px) / kNode_px;
            const Eigen::Vector2f far = between(nodes_.far, first, columns, fx, fy);
            const Eigen::Vector2f near = between(nodes_.near, first, columns, fx, fy);
            const float share = inverse_depth(x, y, plane) / nodes_.nearest;
            const Eigen::Vector2f px = far + share * (near - far);
            row[x] = {px.x(), px.y()};
          }
        }
      },
      16);
}

}  // namespace sheen::pipeline
