// SPDX-License-Identifier: MIT
// Data sets that are only read: Bundler's and Metashape's.
#include "capture/dataset/bundler_file.h"
#include "capture/dataset/import_session.h"
#include "capture/dataset/metashape_file.h"
#include "capture/session/session.h"
#include "core/image/write_image.h"
#include "core/mesh/read_mesh.h"
#include "tests/capture/expect_bad_input.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace sheen::capture::test {
namespace {

using tests::TemporaryFolder;
using tests::write_file;

constexpr int kBundleWidth_px = 64, kBundleHeight_px = 48;

/// An image of a size, black.
void write_black(const std::filesystem::path& path) {
  core::write_image(path, cv::Mat::zeros(kBundleHeight_px, kBundleWidth_px, CV_8UC3));
}

// Bundler's manual: P = R X + t; p = -P / P.z; p' = f (1 + k1 |p|^2 + k2 |p|^4) p, counted from the
// image's centre, x to the right and y up.
TEST(Bundler, ProjectsAsItsManualSays) {
  const TemporaryFolder folder;
  write_black(folder / "a.png");
  write_file(folder / "list.txt", "b.png 0 51\na.png 0 50\n");
  const auto path = write_file(folder / "bundle.out",
                               "# Bundle file v0.3\n2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 0\n"
                               "50 0.1 -0.02\n0 1 0\n0 0 1\n1 0 0\n0.1 -0.2 -3\n");
  const Dataset dataset = read_bundle(path, folder.path());
  ASSERT_EQ(dataset.frames.size(), 1U);  // b.png has no focal length: not posed
  EXPECT_EQ(dataset.frames[0].image, "a.png");
  const Eigen::Vector3d point(0.3, 0.2, 0.4);
  const Eigen::Vector3d P(point.y() + 0.1, point.z() - 0.2, point.x() - 3);
  const Eigen::Vector2d p(-P.x() / P.z(), -P.y() / P.z());
  const double r = 1 + 0.1 * p.squaredNorm() - 0.02 * p.squaredNorm() * p.squaredNorm();
  const Eigen::Vector2d expected((kBundleWidth_px - 1) / 2.0 + 50 * r * p.x(),
                                 (kBundleHeight_px - 1) / 2.0 - 50 * r * p.y());
  const auto pixel =
      dataset.cameras[0].project(dataset.frames[0].world_from_camera.inverse() * point);
  ASSERT_TRUE(pixel.has_value());
  EXPECT_LT((*pixel - expected).norm(), 1e-9);
}

TEST(Bundler, HostileFilesAreRefused) {
  const TemporaryFolder folder;
  write_black(folder / "a.png");
  write_file(folder / "list.txt", "a.png\n");
  const std::string good = "# Bundle file v0.3\n1 0\n50 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 0\n";
  const auto path = folder / "bundle.out";
  const auto refused = [&](const std::string& text, const char* word) {
    write_file(path, text);
    expect_bad_input([&] { read_bundle(path, folder.path()); }, "bundle.out", word);
  };
  for (std::size_t length = 0; length + 2 < good.size(); ++length) {
    write_file(path, good.substr(0, length));
    expect_bad_input([&] { read_bundle(path, folder.path()); }, "bundle.out");
  }
  refused("# Bundle file v0.3\n1000000000 0\n50 0 0\n", "cameras");
  refused("# Bundle file v0.3\n-1 0\n50 0 0\n", "cameras");
  refused("# Bundle file v0.3\n1 0\n50 nan 0\n1 0 0\n0 1 0\n0 0 1\n0 0 0\n", "nan");
  refused("# Bundle file v0.3\n1 0\n50 0 0\n2 0 0\n0 1 0\n0 0 1\n0 0 0\n", "rigid");
  write_file(path, good);
  write_file(folder / "list.txt", "../a.png\n");
  expect_bad_input([&] { read_bundle(path, folder.path()); }, "list.txt", "inside");
  write_file(folder / "list.txt", "a.png\nb.png\n");
  expect_bad_input([&] { read_bundle(path, folder.path()); }, "2 images");
}

std::string metashape(const std::string& camera, const std::string& place) {
  return R"(<document version="1.5.0"><chunk label="c" enabled="1"><sensors><sensor id="0" type="frame">
<calibration type="frame" class="adjusted"><resolution width="64" height="48"/><f>50</f><cx>2</cx><cy>-1</cy>
</calibration></sensor></sensors><cameras>)" +
         camera + "</cameras>" + place + "</chunk></document>";
}

// A camera's transform goes from a camera that looks along z with y down to the chunk; the chunk's
// to the world: X = s R x + t.
TEST(Metashape, AppliesThePlaceOfTheChunk) {
  const TemporaryFolder folder;
  write_black(folder / "view 1.png");
  const std::string camera =
      R"(<group id="1"><camera id="0" label="view 1"><transform>0 -1 0 1 1 0 0 2 0 0 1 3 0 0 0 1</transform></camera></group>
<camera id="1" label="off" enabled="0"><transform>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</transform></camera>
<camera id="2" label="not aligned"/>)";
  const std::string place =
      R"(<transform><rotation>1 0 0 0 0 -1 0 1 0</rotation><translation>10 20 30</translation><scale>0.5</scale></transform>)";
  const auto path = write_file(folder / "cameras.xml", metashape(camera, place));
  const Dataset dataset = read_metashape(path, folder.path());
  ASSERT_EQ(dataset.frames.size(), 1U);
  EXPECT_EQ(dataset.frames[0].image, "view 1.png");
  // (1, 2, 3), turned (x, -z, y), halved and moved.
  const Eigen::Isometry3d& pose = dataset.frames[0].world_from_camera;
  EXPECT_LT((pose.translation() - Eigen::Vector3d(10.5, 18.5, 31)).norm(), 1e-12);
  // The camera's x is the chunk's y, which is the world's z.
  EXPECT_LT((pose.linear().col(0) - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  // Principal points are from the middle of the image: 32 + 2 from the corner.
  EXPECT_EQ(dataset.cameras[0].intrinsics().principal_px, Eigen::Vector2d(33.5, 22.5));
}

TEST(Metashape, HostileFilesAreRefused) {
  const TemporaryFolder folder;
  const auto path = folder / "cameras.xml";
  const auto refused = [&](const std::string& text, const char* word) {
    write_file(path, text);
    expect_bad_input([&] { read_metashape(path, folder.path()); }, "cameras.xml", word);
  };
  const std::string pose = "<transform>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</transform></camera>";
  const std::string good = metashape("<camera label=\"a\">" + pose, "");
  write_file(path, good);
  EXPECT_EQ(read_metashape(path, folder.path()).frames.size(), 1U);
  for (std::size_t length = 0; length < good.size(); length += 11) {
    refused(good.substr(0, length), "");
  }
  refused(metashape("<camera label=\"../a\">" + pose, ""), "inside");
  // Longer than names of files can be, which once ended the program (found by fuzz/metashape).
  refused(metashape("<camera label=\"" + std::string(256, 'a') + "\">" + pose, ""), "255 bytes");
  refused(metashape("<camera label=\"a\"><transform>1 0 0</transform></camera>", ""), "16 numbers");
  refused(metashape("<camera label=\"a\"><transform>1 0 0 0 0 1 0 0 0 0 1 inf 0 0 0 1</transform>"
                    "</camera>",
                    ""),
          "16 numbers");
  refused(metashape("<camera label=\"a\">" + pose, "<transform><scale>0</scale></transform>"),
          "scale");
  refused(metashape("<camera label=\"a\">" + pose,
                    "<transform><translation>4e6 1e6 5e6</translation></transform>"),
          "globe");
  refused(metashape("", ""), "no aligned");
}

// A mesh in the unit of the poses is scaled with them.
TEST(Import, ScalesAMeshThatHasTheUnitOfThePoses) {
  const TemporaryFolder folder;
  write_black(folder / "a.png");
  core::Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
  mesh.normals.assign(3, Eigen::Vector3f::UnitZ());
  mesh.triangles = {{0, 1, 2}};
  core::write_ply(folder / "mesh.ply", mesh);
  write_file(folder / "list.txt", "a.png\n");
  const auto path = write_file(folder / "bundle.out",
                               "# Bundle file v0.3\n1 0\n50 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 -4\n");
  write_imported_session({.dataset = read_bundle(path, folder.path()),
                          .images = folder.path(),
                          .mesh = folder / "mesh.ply",
                          .metres_per_unit = 0.25,
                          .mesh_has_unit = true},
                         folder / "session");
  const Session session = open_session(folder / "session");
  const core::Mesh scaled = core::read_mesh(session.mesh);
  EXPECT_EQ(scaled.positions[2], Eigen::Vector3f(0, 0.5f, 0));
}

}  // namespace
}  // namespace sheen::capture::test
