// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/neighbours.h"
#include "core/samples/sample_batch.h"
#include "fitting/descriptor.h"
#include "fitting/iwls/iwls_fitter.h"
#include "fitting/iwls/light_field_model.h"
#include "fitting/model_file/model_part.h"
#include "fitting/patch_fitter.h"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace sheen::fitting::testing {

/// Patches without neighbours.
inline core::VertexNeighbours isolated(std::size_t count) {
  return {std::vector<std::uint32_t>(count + 1, 0), {}};
}

/// A radiance of direction.
using Lumisphere = std::function<Eigen::Vector3d(double u, double v)>;

/// Directions on a grid that fills the closed disc, rim included.
inline std::vector<Eigen::Vector2f> disc_grid(int rings = 24, int spokes = 48) {
  std::vector<Eigen::Vector2f> directions{{0.0f, 0.0f}};
  for (int ring = 1; ring <= rings; ++ring) {
    for (int spoke = 0; spoke < spokes; ++spoke) {
      const double radius = static_cast<double>(ring) / rings;
      const double angle = 2.0 * 3.14159265358979 * spoke / spokes;
      directions.emplace_back(static_cast<float>(radius * std::cos(angle)),
                              static_cast<float>(radius * std::sin(angle)));
    }
  }
  return directions;
}

/// Directions spread evenly over the disc by area, in random order.
inline std::vector<Eigen::Vector2d> scattered(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  const auto unit = [&] { return static_cast<double>(random()) / 4294967296.0; };
  std::vector<Eigen::Vector2d> directions;
  while (directions.size() < count) {
    const Eigen::Vector2d x(2.0 * unit() - 1.0, 2.0 * unit() - 1.0);
    if (x.squaredNorm() < 1.0) directions.push_back(x);
  }
  return directions;
}

inline void add_sample(core::SampleBatch& batch, std::uint32_t patch, const Eigen::Vector2d& x,
                       const Eigen::Vector3d& colour) {
  batch.patch.push_back(patch);
  batch.u.push_back(static_cast<float>(x.x()));
  batch.v.push_back(static_cast<float>(x.y()));
  batch.r.push_back(static_cast<float>(colour.x()));
  batch.g.push_back(static_cast<float>(colour.y()));
  batch.b.push_back(static_cast<float>(colour.z()));
}

/// A view that gives one sample of one patch.
inline core::SampleBatch one_sample(std::uint32_t patch, const Eigen::Vector2d& x,
                                    const Eigen::Vector3d& colour) {
  core::SampleBatch batch;
  add_sample(batch, patch, x, colour);
  return batch;
}

/// Every representation that is fitted to samples alone, by name, in the registry's order.
inline std::vector<std::string> representation_names() {
  core::Mesh point;
  point.positions.emplace_back(0.0f, 0.0f, 0.0f);
  point.normals.emplace_back(0.0f, 0.0f, 1.0f);
  std::vector<std::string> names;
  for (const Descriptor* descriptor : representations()) {
    const std::string name(descriptor->name);
    const auto fitter = make_fitter(name, point);
    if (dynamic_cast<const PatchFitter*>(fitter.get()) != nullptr) names.push_back(name);
  }
  return names;
}

/// A representation of patches over a mesh; neighbours as the mesh has them.
inline std::unique_ptr<PatchFitter> make_patches(const std::string& name, const core::Mesh& mesh,
                                                 const OptionValues& values = {}) {
  auto fitter = make_fitter(name, mesh, values);
  auto& patches = dynamic_cast<PatchFitter&>(*fitter);
  static_cast<void>(fitter.release());
  return std::unique_ptr<PatchFitter>(&patches);
}

inline std::unique_ptr<PatchFitter> make_iwls(const iwls::Options& options, std::size_t patches = 1,
                                              int threads = 1) {
  return iwls::make_iwls_fitter(isolated(patches), options, threads);
}

/// The options as whoever knows only names would give them.
inline OptionValues values_of(iwls::Options options) {
  OptionValues values;
  for (const FitOption& option : option_table(options)) values[option.name] = option.get();
  return values;
}

/// A view of which only the samples are known; `batch` must outlive it.
inline core::Observation observation_of(const core::SampleBatch& batch) {
  static const cv::Mat no_image;
  static const core::CameraModel no_camera;
  static const core::VertexView no_view;
  return {0, no_image, no_camera, Eigen::Isometry3d::Identity(), no_view, batch};
}

/// Feeds patch 0 one view per direction, then finishes.
inline void teach(PatchFitter& fitter, const std::vector<Eigen::Vector2d>& directions,
                  const Lumisphere& truth) {
  for (const Eigen::Vector2d& x : directions) {
    fitter.integrate(one_sample(0, x, truth(x.x(), x.y())));
  }
  fitter.finish();
}

inline Eigen::Vector3f colour_of(const PatchLightField& light_field, std::size_t patch,
                                 const Eigen::Vector2f& uv) {
  const WeightedColour sum = light_field.evaluate(patch, uv);
  return sum.colour_sum / sum.weight_sum;
}

/// Largest difference to the truth over the closed disc.
inline double worst_error(const PatchLightField& light_field, const Lumisphere& truth) {
  double worst = 0;
  for (const Eigen::Vector2f& x : disc_grid()) {
    const Eigen::Vector3d value = colour_of(light_field, 0, x).cast<double>();
    const double error = (value - truth(static_cast<double>(x.x()), static_cast<double>(x.y())))
                             .cwiseAbs()
                             .maxCoeff();
    if (!(error <= worst)) worst = error;
  }
  return worst;
}

inline const std::vector<iwls::Construction> kConstructions{
    iwls::Construction::quadtree, iwls::Construction::adaptive, iwls::Construction::batch};
inline const std::vector<iwls::Layout> kLayouts{iwls::Layout::grid, iwls::Layout::jittered_grid,
                                                iwls::Layout::disk, iwls::Layout::jittered_disk};

/// A view of a random third of the patches from about one side.
inline core::SampleBatch random_view(std::size_t patches, std::mt19937& random) {
  const auto unit = [&] { return static_cast<double>(random()) / 4294967296.0; };
  core::SampleBatch batch;
  const Eigen::Vector2d side(1.4 * unit() - 0.7, 1.4 * unit() - 0.7);
  for (std::uint32_t patch = 0; patch < patches; ++patch) {
    if (unit() > 0.33) continue;
    const Eigen::Vector2d x = side + 0.1 * Eigen::Vector2d(unit(), unit());
    add_sample(batch, patch, x, {unit(), 0.5 * x.x() + 0.5, 0.3});
  }
  return batch;
}

inline std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Every bit of a model, as it lies in the model file: the arrays, then the observed flags. Two
/// models of which nothing is encoded must not pass for the same, so that fails the test.
inline std::string bytes_of(const LightField& light_field) {
  const ModelPart part = representation_named(light_field.representation()).encode(light_field);
  std::string all;
  for (const auto& [name, bytes] : part.arrays) all += text_of(bytes);
  EXPECT_FALSE(all.empty()) << light_field.representation() << " encodes nothing";
  return all + text_of(part.observed);
}

/// Options as a message for failing assertions.
inline std::string text_of(const iwls::Options& options) {
  return std::string(iwls::name_of(options.construction)) + " " +
         std::string(iwls::name_of(options.layout)) + " " + std::to_string(options.centers) +
         " centres " + std::to_string(options.terms) + " terms" +
         (options.faithful ? " faithful" : "");
}

/// Calls `body` for every construction, layout and number of centres, with the given terms.
template <typename Body>
void for_all_options(int terms, bool faithful, const Body& body) {
  for (const auto construction : kConstructions) {
    for (const auto layout : kLayouts) {
      for (const int centers : {16, 64})
        body(iwls::Options{construction, layout, centers, terms, faithful});
    }
  }
}

}  // namespace sheen::fitting::testing
