// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"
#include "core/mesh/read_mesh.h"
#include "core/mesh/triangulate.h"
#include "tests/core/shapes.h"
#include "tests/support/temporary_folder.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <sstream>

namespace sheen::core {
namespace {

using testing::area_of;

using tests::TemporaryFolder;
using tests::write_file;

using Triangles = std::vector<Triangulator::Triangle>;

std::vector<std::uint32_t> all_corners(std::size_t count) {
  std::vector<std::uint32_t> corners(count);
  std::iota(corners.begin(), corners.end(), 0U);
  return corners;
}

/// Twice the area along the normal: the outline's own, and that of every triangle.
Eigen::Vector3d doubled_area(const std::vector<Eigen::Vector3d>& outline) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    sum += outline[i].cross(outline[(i + 1) % outline.size()]);
  }
  return sum;
}

/// The law of any cut: n - 2 triangles, none turned against the polygon (so that none overlap where
/// their areas add up to the polygon's), together its area.
void expect_exact_cut(const std::vector<Eigen::Vector3d>& outline) {
  Triangulator cutter;
  Triangles triangles;
  ASSERT_TRUE(cutter.cut(all_corners(outline.size()), outline, triangles));
  EXPECT_EQ(cutter.crossing(), 0u);
  EXPECT_EQ(triangles.size(), outline.size() - 2);
  const Eigen::Vector3d whole = doubled_area(outline);
  double sum = 0;
  for (const auto& t : triangles) {
    const double along =
        doubled_area({outline[t[0]], outline[t[1]], outline[t[2]]}).dot(whole.normalized());
    EXPECT_GE(along, -1e-12 * whole.norm());
    sum += along;
  }
  EXPECT_NEAR(sum, whole.norm(), 1e-9 * whole.norm());
}

/// A star: `points` corners at alternating radii, or random ones.
std::vector<Eigen::Vector3d> star(int points, std::mt19937& random) {
  std::uniform_real_distribution<double> radius(0.1, 1);
  std::vector<Eigen::Vector3d> outline;
  for (int i = 0; i < points; ++i) {
    const double angle = 2 * std::numbers::pi * i / points;
    const double r = radius(random);
    outline.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
  }
  return outline;
}

TEST(Triangulator, CutsStarsInAnyPlaneAndFromAnyCorner) {
  std::mt19937 random(7);
  for (int run = 0; run < 40; ++run) {
    std::vector<Eigen::Vector3d> outline = star(5 + run, random);
    const Eigen::Affine3d place = Eigen::Translation3d(3, -2, 1) *
                                  Eigen::AngleAxisd(run, Eigen::Vector3d(1, run, -2).normalized());
    for (Eigen::Vector3d& corner : outline) corner = place * corner;
    std::rotate(outline.begin(), outline.begin() + run % 5, outline.end());
    SCOPED_TRACE(run);
    expect_exact_cut(outline);
  }
}

TEST(Triangulator, CutsASpiralAndACombAndAnOutlineWithAHole) {
  // Two turns of a spiral, there and back.
  std::vector<Eigen::Vector3d> spiral;
  for (const double gap : {0.0, 0.4}) {
    std::vector<Eigen::Vector3d> side;
    for (int i = 0; i <= 40; ++i) {
      const double angle = 0.1 * std::numbers::pi * i;
      const double r = 1 + gap + angle / (2 * std::numbers::pi);
      side.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
    }
    if (gap > 0) std::reverse(side.begin(), side.end());
    spiral.insert(spiral.end(), side.begin(), side.end());
  }
  expect_exact_cut(spiral);

  // A comb, whose first corner sees little of it.
  std::vector<Eigen::Vector3d> comb = {{0, 0, 0}, {20, 0, 0}};
  for (int tooth = 9; tooth >= 0; --tooth) {
    comb.emplace_back(2.0 * tooth + 1.5, 5, 0);
    comb.emplace_back(2.0 * tooth + 0.5, 1, 0);
  }
  expect_exact_cut(comb);

  // A square with a square hole, joined by a bridge that is walked both ways: area 16 - 4.
  const std::vector<Eigen::Vector3d> frame = {{-2, -2, 0}, {2, -2, 0},  {2, 2, 0},  {-2, 2, 0},
                                              {-2, -2, 0}, {-1, -1, 0}, {-1, 1, 0}, {1, 1, 0},
                                              {1, -1, 0},  {-1, -1, 0}};
  EXPECT_DOUBLE_EQ(doubled_area(frame).norm(), 24);
  expect_exact_cut(frame);
}

TEST(Triangulator, ConvexPolygonsAreFansRoundTheirFirstCorner) {
  std::vector<Eigen::Vector3d> outline;
  for (int i = 0; i < 9; ++i) outline.emplace_back(std::cos(0.7 * i), std::sin(0.7 * i), 1);
  Triangulator cutter;
  Triangles triangles;
  ASSERT_TRUE(cutter.cut(all_corners(9), outline, triangles));
  for (const auto& triangle : triangles) EXPECT_EQ(triangle[0], 0u);
}

TEST(Triangulator, OutlinesThatCrossThemselvesAreCounted) {
  // Two overlapping triangles walked as one: a star of five points by its diagonals.
  std::vector<Eigen::Vector3d> outline;
  for (int i = 0; i < 5; ++i) {
    const double angle = 4 * std::numbers::pi * i / 5;
    outline.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  Triangulator cutter;
  Triangles triangles;
  ASSERT_TRUE(cutter.cut(all_corners(5), outline, triangles));
  EXPECT_LE(triangles.size(), 3u);
}

TEST(Triangulator, TooMuchWorkIsRefusedWithoutTriangles) {
  // A circle of n corners, pushed in at every second one, needs about n^2 comparisons: 9e8 for one,
  // so that the third passes the limit of 2e9.
  constexpr int n = 30'000;
  std::vector<Eigen::Vector3d> outline;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    const double r = i % 2 == 0 ? 1 : 0.9999;
    outline.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
  }
  Triangulator cutter;
  Triangles triangles;
  const auto corners = all_corners(outline.size());
  bool is_refused = false;
  for (int run = 0; run < 6 && !is_refused; ++run) {
    const std::size_t before = triangles.size();
    is_refused = !cutter.cut(corners, outline, triangles);
    if (is_refused) {
      EXPECT_EQ(triangles.size(), before);
    }
  }
  EXPECT_TRUE(is_refused);
}

/// A prism over an arrow head, whose caps are concave polygons: area of the walls + 2 caps.
struct Arrow {
  std::vector<Eigen::Vector2d> outline = {{0, 0}, {3, 0}, {1, 1}, {0, 3}};
  double height = 2;

  [[nodiscard]] double area() const {
    double walls = 0, cap = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Eigen::Vector2d& a = outline[i];
      const Eigen::Vector2d& b = outline[(i + 1) % outline.size()];
      walls += height * (b - a).norm();
      cap += 0.5 * (a.x() * b.y() - a.y() * b.x());
    }
    return walls + 2 * cap;
  }

  /// Faces as lists of vertex numbers, the caps from corner `start`.
  [[nodiscard]] std::vector<std::vector<int>> faces(int start) const {
    const int n = static_cast<int>(outline.size());
    std::vector<std::vector<int>> all(2);
    for (int i = 0; i < n; ++i) {
      all[0].push_back((start + n - i) % n);
      all[1].push_back(n + (start + i) % n);
      all.push_back({i, (i + 1) % n, n + (i + 1) % n, n + i});
    }
    return all;
  }

  [[nodiscard]] std::string file(bool is_ply, int start) const {
    std::ostringstream text;
    const int n = static_cast<int>(outline.size());
    if (is_ply) {
      text << "ply\nformat ascii 1.0\nelement vertex " << 2 * n
           << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << n + 2
           << "\nproperty list uchar int vertex_indices\nend_header\n";
    }
    for (const double z : {0.0, height}) {
      for (const auto& p : outline) {
        text << (is_ply ? "" : "v ") << p.x() << ' ' << p.y() << ' ' << z << '\n';
      }
    }
    for (const auto& face : faces(start)) {
      text << (is_ply ? std::to_string(face.size()) : "f");
      for (const int corner : face) text << ' ' << corner + (is_ply ? 0 : 1);
      text << '\n';
    }
    return text.str();
  }
};

TEST(ReadMesh, ConcaveFacesHaveTheirOutlinesAreaInPlyAndObj) {
  const TemporaryFolder folder;
  const Arrow arrow;
  for (int start = 0; start < 4; ++start) {
    const auto ply = read_mesh(write_file(folder / "arrow.ply", arrow.file(true, start)));
    const auto obj = read_mesh(write_file(folder / "arrow.obj", arrow.file(false, start)));
    EXPECT_NEAR(area_of(ply), arrow.area(), 1e-5) << start;
    EXPECT_NEAR(area_of(obj), arrow.area(), 1e-5) << start;
  }
}

TEST(ReadMesh, TriangleStripsOfPlyAreTheSurface) {
  const TemporaryFolder folder;
  // Three quads side by side as one strip, one more quad as a second: area 4.
  std::string vertices;
  for (int i = 0; i <= 4; ++i) {
    vertices += std::to_string(i) + " 1 0\n" + std::to_string(i) + " 0 0\n";
  }
  const auto path = write_file(
      folder / "strips.ply",
      "ply\nformat ascii 1.0\nelement vertex 10\nproperty float x\nproperty float y\nproperty "
      "float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
          vertices + "13 0 1 2 3 4 5 6 7 -1 6 7 8 9\n");
  const Mesh mesh = read_mesh(path);
  EXPECT_EQ(mesh.triangles.size(), 8u);
  EXPECT_NEAR(area_of(mesh), 4, 1e-6);
  for (const auto& normal : mesh.normals) EXPECT_EQ(normal, Eigen::Vector3f(0, 0, 1));
}

TEST(ReadMesh, VerticesWithoutCoordinatesAreRefusedByTheNamesTheyHave) {
  const TemporaryFolder folder;
  const auto path =
      write_file(folder / "columns.ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float east\nproperty float "
                 "north\nproperty "
                 "float up\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                 "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  try {
    read_mesh(path);
    ADD_FAILURE() << "was accepted";
  } catch (const Error& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("no x"), std::string::npos) << what;
    EXPECT_NE(what.find("east, north, up"), std::string::npos) << what;
  }
}

TEST(ReadMesh, AMeshFarFromItsOriginKeepsItsShapeAndItsPlace) {
  const TemporaryFolder folder;
  // Survey coordinates: single precision there has steps of 0.5 m and 0.03 m.
  const Eigen::Vector3d place(5'412'345.5, 498'765.25, 102.125);
  const Arrow arrow;
  std::ostringstream far;
  far.precision(12);
  std::istringstream near(arrow.file(false, 0));
  std::vector<Eigen::Vector3d> expected;
  for (std::string line; std::getline(near, line);) {
    std::istringstream words(line);
    std::string keyword;
    Eigen::Vector3d p;
    if (line.starts_with("v ") && words >> keyword >> p.x() >> p.y() >> p.z()) {
      p = 0.01 * p + place;
      expected.push_back(p);
      far << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
    } else {
      far << line << '\n';
    }
  }
  const Mesh mesh = read_mesh(write_file(folder / "far.obj", far.str()));
  EXPECT_FALSE(mesh.offset.isZero());
  // Centimetres: the file has six decimals of a metre (5e-7), single precision at 0.5 m from the
  // offset rounds to 3e-8.
  ASSERT_EQ(mesh.positions.size(), expected.size());
  for (const Eigen::Vector3d& p : expected) {
    double nearest = 1e9;
    for (const auto& position : mesh.positions) {
      nearest = std::min(nearest, (position.cast<double>() + mesh.offset - p).norm());
    }
    EXPECT_LT(nearest, 1e-6);
  }
  EXPECT_NEAR(area_of(mesh), 1e-4 * (arrow.area() + 0), 2e-4 * 1e-4 * arrow.area() + 1e-7);
}

TEST(ReadMesh, CoordinatesRoundedFarAwayAreRefused) {
  const TemporaryFolder folder;
  // The same prism stored by another program in single precision: all on a grid of 0.5 m.
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  text += "5412345.5 0.5 0\n5412346 0.5 0\n5412345.5 1 0\n3 0 1 2\n";
  try {
    read_mesh(write_file(folder / "grid.ply", text));
    ADD_FAILURE() << "was accepted";
  } catch (const Error& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("single precision"), std::string::npos) << what;
    EXPECT_NE(what.find("double precision"), std::string::npos) << what;
  }
}

}  // namespace
}  // namespace sheen::core
