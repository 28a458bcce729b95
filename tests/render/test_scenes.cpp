// SPDX-License-Identifier: MIT
#include "tests/render/test_scenes.h"

#include "fitting/iwls/center_layout.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>
#include <vector>

namespace sheen::render::testing {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

Eigen::Matrix<std::uint32_t, 3, 1> triangle(int a, int b, int c) {
  return Eigen::Vector3i(a, b, c).cast<std::uint32_t>();
}

core::CameraModel::Intrinsics intrinsics(int width_px, int height_px) {
  core::CameraModel::Intrinsics in;
  in.width_px = width_px;
  in.height_px = height_px;
  in.focal_px = {1.25 * width_px, 1.25 * width_px};
  in.principal_px = {(width_px - 1) / 2.0, (height_px - 1) / 2.0};
  return in;
}

Eigen::Vector3d knot_point(double t) {
  const double r = 2 + std::cos(3 * t);
  return {r * std::cos(2 * t), r * std::sin(2 * t), std::sin(3 * t)};
}

}  // namespace

core::Mesh tetrahedron(float radius_m) {
  core::Mesh mesh;
  for (const Eigen::Vector3f& corner : {Eigen::Vector3f(1, 1, 1), Eigen::Vector3f(1, -1, -1),
                                        Eigen::Vector3f(-1, 1, -1), Eigen::Vector3f(-1, -1, 1)}) {
    mesh.normals.push_back(corner.normalized());
    mesh.positions.push_back(radius_m * corner.normalized());
  }
  mesh.triangles = {triangle(0, 1, 2), triangle(0, 2, 3), triangle(0, 3, 1), triangle(1, 3, 2)};
  return mesh;
}

core::Mesh sphere(float radius_m, int rings) {
  core::Mesh mesh;
  const int sectors = 2 * rings;
  const auto add = [&](double polar, double azimuth) {
    mesh.normals.push_back(Eigen::Vector3d(std::sin(polar) * std::cos(azimuth),
                                           std::sin(polar) * std::sin(azimuth), std::cos(polar))
                               .cast<float>()
                               .normalized());
    mesh.positions.push_back(radius_m * mesh.normals.back());
  };
  // North pole, rings from north to south, south pole.
  add(0, 0);
  for (int ring = 1; ring < rings; ++ring) {
    for (int sector = 0; sector < sectors; ++sector) {
      add(std::numbers::pi * ring / rings, kTwoPi * sector / sectors);
    }
  }
  add(std::numbers::pi, 0);
  const auto at = [&](int ring, int sector) { return 1 + (ring - 1) * sectors + sector % sectors; };
  const int south = static_cast<int>(mesh.positions.size()) - 1;
  for (int sector = 0; sector < sectors; ++sector) {
    mesh.triangles.push_back(triangle(0, at(1, sector), at(1, sector + 1)));
    for (int ring = 1; ring < rings - 1; ++ring) {
      mesh.triangles.push_back(
          triangle(at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1)));
      mesh.triangles.push_back(
          triangle(at(ring, sector), at(ring + 1, sector + 1), at(ring, sector + 1)));
    }
    mesh.triangles.push_back(triangle(south, at(rings - 1, sector + 1), at(rings - 1, sector)));
  }
  return mesh;
}

core::Mesh torus_knot(float size_m, int along, int around) {
  core::Mesh mesh;
  const double scale = static_cast<double>(size_m) / 6;  // the knot spans [-3, 3]
  for (int i = 0; i < along; ++i) {
    // A frame across the curve; `side` cannot vanish, since the curve never runs along z.
    const double t = kTwoPi * i / along;
    const Eigen::Vector3d forward = (knot_point(t + 1e-4) - knot_point(t - 1e-4)).normalized();
    const Eigen::Vector3d side = Eigen::Vector3d::UnitZ().cross(forward).normalized();
    const Eigen::Vector3d up = forward.cross(side);
    for (int j = 0; j < around; ++j) {
      const double angle = kTwoPi * j / around;
      const Eigen::Vector3d offset = 0.45 * (std::cos(angle) * side + std::sin(angle) * up);
      mesh.positions.push_back((scale * (knot_point(t) + offset)).cast<float>());
    }
  }
  const auto at = [&](int i, int j) { return (i % along) * around + j % around; };
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < around; ++j) {
      mesh.triangles.push_back(triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1)));
      mesh.triangles.push_back(triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1)));
    }
  }
  // (side, up, forward) is right-handed: seen along `forward` the angle runs clockwise, so the
  // triangles above face inwards; turn them.
  for (auto& corners : mesh.triangles) std::swap(corners[1], corners[2]);
  compute_normals(mesh);
  return mesh;
}

void compute_normals(core::Mesh& mesh) {
  mesh.normals.assign(mesh.positions.size(), Eigen::Vector3f::Zero());
  for (const auto& corners : mesh.triangles) {
    const Eigen::Vector3f a = mesh.positions[corners[0]];
    const Eigen::Vector3f area =
        (mesh.positions[corners[1]] - a).cross(mesh.positions[corners[2]] - a);
    for (const std::uint32_t corner : corners) mesh.normals[corner] += area;
  }
  for (Eigen::Vector3f& normal : mesh.normals) {
    normal = normal.squaredNorm() > 0 ? Eigen::Vector3f(normal.normalized())
                                      : Eigen::Vector3f(Eigen::Vector3f::UnitZ());
  }
}

Eigen::Isometry3d looking_at_origin(const Eigen::Vector3d& from_direction, double distance_m) {
  const Eigen::Vector3d forward = -from_direction.normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d camera_from_object = Eigen::Isometry3d::Identity();
  camera_from_object.linear().row(0) = right;
  camera_from_object.linear().row(1) = forward.cross(right);
  camera_from_object.linear().row(2) = forward;
  camera_from_object.translation() = Eigen::Vector3d(0, 0, distance_m);
  return camera_from_object;
}

core::CameraModel plain_camera(int width_px, int height_px) {
  return core::CameraModel(intrinsics(width_px, height_px));
}

core::CameraModel distorted_camera(int width_px, int height_px) {
  core::CameraModel::Intrinsics in = intrinsics(width_px, height_px);
  in.principal_px += Eigen::Vector2d(0.02 * width_px, -0.03 * height_px);
  in.distortion = {-0.30, 0.12, 0.002, -0.0015, 0.01, 0.02, -0.01, 0.003};
  return core::CameraModel(in);
}

fitting::iwls::LightFieldModel random_iwls(fitting::iwls::Layout layout, int centers, int terms,
                                           std::size_t patch_count, int unseen_every) {
  const fitting::iwls::CenterLayout made = fitting::iwls::make_center_layout(layout, centers);
  const auto h = static_cast<float>(fitting::iwls::level_radius(made.side));
  const std::size_t per_patch = made.centers.size() * static_cast<std::size_t>(3 * terms);
  std::vector<Eigen::half> coefficients(patch_count * per_patch);
  std::vector<std::uint8_t> observed(patch_count, 1);
  std::mt19937 random(20240607);
  std::uniform_real_distribution<float> constant(0.1f, 0.9f);
  std::uniform_real_distribution<float> other(-0.3f, 0.3f);
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    const bool is_constant = i % static_cast<std::size_t>(3 * terms) < 3;
    coefficients[i] = Eigen::half(is_constant ? constant(random) : other(random));
  }
  for (std::size_t i = 0; i < patch_count && unseen_every > 0;
       i += static_cast<std::size_t>(unseen_every)) {
    observed[i] = 0;
  }
  return {{layout, made.centers, terms, h}, coefficients, std::move(observed)};
}

fitting::mean::MeanLightField random_mean(std::size_t patch_count, int unseen_every) {
  std::mt19937 random(20240608);
  std::uniform_real_distribution<float> constant(0.0f, 1.0f);
  fitting::mean::MeanLightField model(patch_count);
  for (std::size_t i = 0; i < patch_count; ++i) {
    const bool unseen = unseen_every > 0 && i % static_cast<std::size_t>(unseen_every) == 0;
    const float r = constant(random);
    const float g = constant(random);
    model.store(i, {r, g, constant(random)}, !unseen);
  }
  return model;
}

fitting::iwls::LightFieldModel smooth_iwls(const core::Mesh& mesh, int centers, int terms) {
  using fitting::iwls::Layout;
  const auto made = fitting::iwls::make_center_layout(Layout::disk, centers);
  const double h = fitting::iwls::level_radius(made.side);
  fitting::iwls::LightFieldModel model({Layout::disk, made.centers, terms, static_cast<float>(h)},
                                       mesh.positions.size());
  std::vector<double> values(static_cast<std::size_t>(3 * terms));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Eigen::Vector3d n = mesh.normals[i].cast<double>();
    for (std::size_t j = 0; j < made.centers.size(); ++j) {
      const double gloss =
          std::exp(-4 * (made.centers[j].cast<double>() - Eigen::Vector2d(0.3, 0.2)).squaredNorm());
      std::ranges::fill(values, 0.0);
      for (std::size_t channel = 0; channel < 3; ++channel) {
        values[channel] = 0.35 + 0.25 * n[static_cast<Eigen::Index>(channel)] + 0.35 * gloss;
        if (terms >= 3) values[3 + channel] = 0.05 * h;
      }
      model.store(i, j, values);
    }
    model.store_observed(i, true);
  }
  return model;
}

Difference difference(const cv::Mat& a, const cv::Mat& b, const cv::Mat& mask) {
  std::array<std::size_t, 256> histogram{};
  Difference result;
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      if (mask.at<std::uint8_t>(y, x) == 0) continue;
      ++result.pixels;
      for (int channel = 0; channel < 3; ++channel) {
        const int step = std::abs(a.at<cv::Vec3b>(y, x)[channel] - b.at<cv::Vec3b>(y, x)[channel]);
        ++histogram[static_cast<std::size_t>(step)];
        result.mean += step;
        result.largest = std::max(result.largest, step);
      }
    }
  }
  const std::size_t values = 3 * result.pixels;
  if (values == 0) return result;
  result.mean /= static_cast<double>(values);
  std::size_t below = 0;
  for (std::size_t step = 0; step < histogram.size(); ++step) {
    below += histogram[step];
    if (static_cast<double>(below) >= 0.999 * static_cast<double>(values)) {
      result.quantile_999 = static_cast<double>(step);
      break;
    }
  }
  return result;
}

cv::Mat common_interior(const cv::Mat& a, const cv::Mat& b, int pixels) {
  cv::Mat both = a & b;
  const cv::Mat element =
      cv::getStructuringElement(cv::MORPH_RECT, cv::Size(2 * pixels + 1, 2 * pixels + 1));
  cv::Mat inner;
  cv::erode(both, inner, element, cv::Point(-1, -1), 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  return inner;
}

}  // namespace sheen::render::testing
