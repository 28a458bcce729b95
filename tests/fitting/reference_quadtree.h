// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/iwls/center_layout.h"
#include "fitting/iwls/fit_rule.h"
#include "fitting/iwls/wendland.h"

#include <Eigen/Dense>

#include <algorithm>
#include <vector>

namespace sheen::fitting::testing {

/// The paper's hierarchical construction as it is told: one patch, lists of samples, every fit from
/// scratch, recursion over cells. Written against docs/algorithm.md, sections 5 and 6.
class ReferenceQuadtree {
 public:
  explicit ReferenceQuadtree(const iwls::Options& options)
      : options_(options), layout_(iwls::make_center_layout(options.layout, options.centers)) {}

  void add(const Eigen::Vector2f& x, const Eigen::Vector3f& rgb) {
    samples_.push_back({x.cast<double>(), rgb.cast<double>()});
  }

  void fit() {
    Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
    for (const One& one : samples_) mean += one.rgb.transpose();
    planes_.assign(layout_.centers.size(), {});
    visit({1, 0, 0}, mean / static_cast<double>(samples_.size()), nullptr);
  }

  [[nodiscard]] Eigen::Vector3d colour(const Eigen::Vector2d& x) const {
    const double h = iwls::level_radius(layout_.side);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weight = 0;
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      const double theta = iwls::wendland((x - layout_.centers[i].cast<double>()).norm() / h);
      sum += theta * planes_[i].at(x);
      weight += theta;
    }
    return sum / weight;
  }

  [[nodiscard]] double largest_coefficient() const {
    double largest = 0;
    for (const Plane& plane : planes_) largest = std::max(largest, plane.c.cwiseAbs().maxCoeff());
    return largest;
  }

 private:
  struct One {
    Eigen::Vector2d x;
    Eigen::Vector3d rgb;
  };
  struct Cell {
    int side, x, y;
  };
  // A node's polynomial where it belongs.
  struct Plane {
    Eigen::Vector2d center = Eigen::Vector2d::Zero();
    double radius = 1;
    Eigen::MatrixXd c = Eigen::MatrixXd::Zero(1, 3);

    [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector2d& x) const {
      return (basis((x - center) / radius, c.rows()).transpose() * c).transpose();
    }
  };

  static Eigen::VectorXd basis(const Eigen::Vector2d& e, Eigen::Index terms) {
    Eigen::VectorXd b(6);
    b << 1, e.x(), e.y(), e.x() * e.x(), e.x() * e.y(), e.y() * e.y();
    return b.head(terms);
  }

  void visit(const Cell& cell, const Eigen::RowVector3d& prior, const Plane* parent) {
    Plane plane;
    plane.center = center_of(cell);
    plane.radius = iwls::level_radius(cell.side);
    std::vector<One> list;
    for (const One& one : samples_) {
      if ((one.x - plane.center).norm() < plane.radius) list.push_back(one);
    }
    const double limit = options_.faithful ? 4.0 * options_.terms : 3.0;
    plane.c = fitted(plane, list, prior);
    if (cell.side<layout_.side&& static_cast<double>(list.size())> limit) {
      const Eigen::RowVector3d told = leaning_mean(plane, list, prior);
      for (const int y : {0, 1}) {
        for (const int x : {0, 1}) {
          visit({2 * cell.side, 2 * cell.x + x, 2 * cell.y + y}, told, &plane);
        }
      }
      return;
    }
    const bool inherits = options_.faithful && list.empty() && parent != nullptr;
    spread(cell, inherits ? *parent : plane);
  }

  [[nodiscard]] Eigen::Vector2d center_of(const Cell& cell) const {
    if (cell.side < layout_.side) {
      return iwls::coarse_node_position(layout_.layout, cell.side, cell.x, cell.y).cast<double>();
    }
    return layout_.centers[static_cast<std::size_t>(cell.y * cell.side + cell.x)].cast<double>();
  }

  // Gives the plane to all centres in the cell.
  void spread(const Cell& cell, const Plane& plane) {
    const int width = layout_.side / cell.side;
    for (int y = cell.y * width; y < (cell.y + 1) * width; ++y) {
      for (int x = cell.x * width; x < (cell.x + 1) * width; ++x) {
        planes_[static_cast<std::size_t>(y * layout_.side + x)] = plane;
      }
    }
  }

  [[nodiscard]] Eigen::MatrixXd fitted(const Plane& plane, const std::vector<One>& list,
                                       const Eigen::RowVector3d& prior) const {
    const iwls::Ridge ridge;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(options_.terms, options_.terms);
    Eigen::MatrixXd g = Eigen::MatrixXd::Zero(options_.terms, 3);
    for (const One& one : list) {
      const Eigen::Vector2d e = (one.x - plane.center) / plane.radius;
      const double theta = iwls::wendland(e.norm());
      const Eigen::VectorXd b = basis(e, options_.terms);
      A += theta * b * b.transpose();
      g += theta * b * one.rgb.transpose();
    }
    if (options_.faithful) return faithful_solution(A, g, list);
    const double weight = A(0, 0);
    A.diagonal().array() += ridge.relative * weight + ridge.absolute;
    A(0, 0) = weight + ridge.value;
    g.row(0) += ridge.value * prior;
    return A.fullPivLu().solve(g);
  }

  // A system without a unique solution becomes its weighted mean. The test directions are
  // scattered: only fewer samples than terms make one.
  [[nodiscard]] Eigen::MatrixXd faithful_solution(const Eigen::MatrixXd& A,
                                                  const Eigen::MatrixXd& g,
                                                  const std::vector<One>& list) const {
    Eigen::MatrixXd c = Eigen::MatrixXd::Zero(options_.terms, 3);
    if (static_cast<int>(list.size()) >= options_.terms) return A.fullPivLu().solve(g);
    if (!list.empty()) c.row(0) = g.row(0) / A(0, 0);
    return c;
  }

  [[nodiscard]] static Eigen::RowVector3d leaning_mean(const Plane& plane,
                                                       const std::vector<One>& list,
                                                       const Eigen::RowVector3d& prior) {
    double weight = iwls::Ridge{}.value;
    Eigen::RowVector3d sum = weight * prior;
    for (const One& one : list) {
      const double theta = iwls::wendland((one.x - plane.center).norm() / plane.radius);
      weight += theta;
      sum += theta * one.rgb.transpose();
    }
    return sum / weight;
  }

  iwls::Options options_;
  iwls::CenterLayout layout_;
  std::vector<One> samples_;
  std::vector<Plane> planes_;
};

}  // namespace sheen::fitting::testing
