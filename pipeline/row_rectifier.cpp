// SPDX-License-Identifier: MIT
#include "pipeline/row_rectifier.h"

#include "capture/pose/rolling_shutter.h"
#include "core/concurrency/parallel_for.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace sheen::pipeline {
namespace {

constexpr std::size_t kNode_px =
    16;  // between nodes the motion of a pixel is linear to a thousandth of it

constexpr float kNodeShare = 1.0f / kNode_px;

}  // namespace

RowRectifier::RowRectifier(const capture::Session& session, const core::Mesh* mesh, int threads)
    : camera_(session.camera),
      board_from_object_(session.board_from_object),
      mesh_(mesh),
      threads_(threads) {}

void RowRectifier::prepare() {
  columns_ = static_cast<std::size_t>((camera_.width_px() - 1) / kNode_px + 2);
  rows_ = static_cast<std::size_t>((camera_.height_px() - 1) / kNode_px + 2);
  for (std::size_t y = 0; y < rows_; ++y) {
    for (std::size_t x = 0; x < columns_; ++x) {
      rays_.push_back(camera_.unproject(kNode_px * Eigen::Vector2d(x, y)));
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
  place_nodes(camera_from_board, readout_motion);
  fill_map();
  capture::Frame rectified = frame;
  rectified.grey = cv::Mat();
  rectified.image = cv::Mat();  // its own: the frame's is shared
  cv::remap(frame.image, rectified.image, map_, cv::noArray(), cv::INTER_CUBIC,
            cv::BORDER_REPLICATE);
  return rectified;
}

/// How far the mesh lies behind every pixel.
void RowRectifier::see(const Eigen::Isometry3d& camera_from_board) {
  if (!depth_) return;
  const Eigen::Isometry3d camera_from_object = camera_from_board * board_from_object_;
  core::project_vertices(points_, camera_, camera_from_object, {}, threads_, view_);
  depth_->draw(view_, {camera_.width_px(), camera_.height_px()}, camera_from_object);
}

/// Exact at two depths, infinity and the board's middle; an image moves as the inverse depth does.
void RowRectifier::place_nodes(const Eigen::Isometry3d& camera_from_board,
                               const capture::Twist& readout_motion) {
  const auto place = [&](const Eigen::Vector3d& ray, double inverse_depth) {
    // A point and the motion's shift may be scaled alike: then points may lie infinitely far.
    capture::Twist motion = readout_motion;
    motion.tail<3>() *= inverse_depth;
    return camera_.project(capture::when_its_row_is_read(camera_, motion, ray));
  };
  // Points of the board's plane: normal . (depth * ray) = normal . translation.
  const Eigen::Vector3d normal = camera_from_board.linear().col(2);
  const Eigen::Vector3d plane = normal / normal.dot(camera_from_board.translation());
  const double nearby = 1 / camera_from_board.translation().norm();
  nodes_.resize(rays_.size());
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    // Where the lens says nothing the image stays.
    nodes_[i] << static_cast<float>(kNode_px * (i % columns_)),
        static_cast<float>(kNode_px * (i / columns_)), 0, 0, 0;
    const auto far = rays_[i] ? place(*rays_[i], 0) : std::nullopt;
    const auto near = rays_[i] ? place(*rays_[i], nearby) : std::nullopt;
    if (!far || !near) continue;
    const Eigen::Vector2d by_inverse_depth = (*near - *far) / nearby;
    Eigen::Matrix<double, 5, 1> node;
    node << far->x(), far->y(), by_inverse_depth.x(), by_inverse_depth.y(),
        std::max(plane.dot(*rays_[i]), 0.0);
    nodes_[i] = node.cast<float>();
  }
}

/// 1/m; 0 where the pixel does not show it.
float RowRectifier::inverse_depth_of_mesh(int x, int y) const {
  if (!depth_ || !depth_->box().contains({x, y})) return 0;
  const float depth_m = depth_->depth_m().at<float>(y - depth_->box().y, x - depth_->box().x);
  return depth_m > 0 ? 1 / depth_m : 0;
}

void RowRectifier::fill_map() {
  map_.create(camera_.height_px(), camera_.width_px(), CV_32FC2);
  core::parallel_for(
      static_cast<std::size_t>(map_.rows), threads_,
      [&](std::size_t begin, std::size_t end) {
        std::vector<Node> line(columns_);  // the grid at a row of pixels
        for (std::size_t y = begin; y < end; ++y) {
          const Node* upper = &nodes_[y / kNode_px * columns_];
          const float down = kNodeShare * static_cast<float>(y % kNode_px);
          for (std::size_t c = 0; c < columns_; ++c) {
            line[c] = (1 - down) * upper[c] + down * upper[columns_ + c];
          }
          auto* const row = map_.ptr<cv::Vec2f>(static_cast<int>(y));
          for (int x = 0; x < map_.cols; ++x) {
            const Node* left = &line[static_cast<std::size_t>(x / kNode_px)];
            const float right = kNodeShare * static_cast<float>(x % kNode_px);
            const Node node = (1 - right) * left[0] + right * left[1];
            const float of_mesh = inverse_depth_of_mesh(x, static_cast<int>(y));
            const float inverse_depth = of_mesh > 0 ? of_mesh : node[4];
            row[x] = {node[0] + inverse_depth * node[2], node[1] + inverse_depth * node[3]};
          }
        }
      },
      16);
}

}  // namespace sheen::pipeline
