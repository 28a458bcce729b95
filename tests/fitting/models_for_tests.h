// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/neighbours.h"
#include "fitting/model_file/model_file.h"
#include "tests/fitting/samples_for_tests.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace sheen::fitting::testing {

/// A folder that goes with the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            ("sheen_" + std::string(test->name()) + "_" + std::to_string(::getpid()));
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

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
inline std::unique_ptr<Fitter> fitted(const std::string& name, const core::Mesh& mesh,
                                      const iwls::Options& options = {}) {
  auto fitter = make_fitter(name, core::vertex_neighbours(mesh), {options, 1});
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

inline std::string file_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

inline void put_bytes(const std::filesystem::path& path, const std::string& bytes) {
  // Overwriting in place makes some file systems flush every time.
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace sheen::fitting::testing
