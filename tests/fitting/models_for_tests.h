// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/model_file/model_file.h"
#include "tests/fitting/samples_for_tests.h"
#include "tests/support/temporary_folder.h"

namespace sheen::fitting::testing {

/// An octahedron: 6 vertices, 8 triangles.
inline core::Mesh octahedron() {
  core::Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {1.0f, -1.0f}) {
      mesh.normals.push_back(sign * Eigen::Vector3f::Unit(axis));
      mesh.positions.push_back(0.1f * mesh.normals.back() + Eigen::Vector3f(0.3f, 0.7f, 1.1f));
    }
  }
  for (const std::uint32_t x : {0u, 1u}) {
    for (const std::uint32_t y : {2u, 3u}) {
      for (const std::uint32_t z : {4u, 5u}) {
        if ((x + y + z) % 2 == 0) {
          mesh.triangles.emplace_back(x, y, z);
        } else {
          mesh.triangles.emplace_back(x, z, y);
        }
      }
    }
  }
  return mesh;
}

/// A fitted light field on the mesh; its last patch was never seen.
inline std::unique_ptr<PatchFitter> fitted(const std::string& name, const core::Mesh& mesh,
                                           const OptionValues& values = {}) {
  auto fitter = make_patches(name, mesh, values);
  for (const auto& x : scattered(30, 71)) {
    core::SampleBatch batch;
    for (std::uint32_t patch = 0; patch + 1 < mesh.positions.size(); ++patch) {
      add_sample(batch, patch, x, {0.1 * patch, 0.5 + 0.4 * x.x(), 0.5 + 0.3 * x.x() * x.y()});
    }
    fitter->integrate(batch);
  }
  fitter->finish();
  return fitter;
}

/// A mesh of so many vertices that has no triangles.
inline core::Mesh points(std::size_t count) {
  return {std::vector<Eigen::Vector3f>(count, Eigen::Vector3f::Zero()),
          std::vector<Eigen::Vector3f>(count, Eigen::Vector3f::UnitZ()),
          {}};
}

}  // namespace sheen::fitting::testing
