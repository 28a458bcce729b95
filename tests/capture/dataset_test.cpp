// SPDX-License-Identifier: MIT
#include "capture/dataset/colmap_files.h"
#include "capture/dataset/dataset_formats.h"
#include "capture/dataset/import_session.h"
#include "capture/dataset/transforms_file.h"
#include "capture/pose/trajectory.h"
#include "capture/session/session.h"
#include "core/mesh/read_mesh.h"
#include "tests/capture/expect_bad_input.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>
#include <limits>

namespace sheen::capture::test {
namespace {

using core::CameraModel;
using core::LensKind;
using tests::TemporaryFolder;
using tests::write_file;

const CameraModel kWide({.width_px = 640,
                         .height_px = 480,
                         .focal_px = {520.5, 522.25},
                         .principal_px = {320.75, 241.125},
                         .distortion = {-0.21, 0.07, 0.001, -0.002, 0.01}});
const CameraModel kRational({.width_px = 640,
                             .height_px = 480,
                             .focal_px = {610.5, 612.25},
                             .principal_px = {317.1, 238.3},
                             .distortion = {0.1, 0.02, 0.001, -0.002, 0.003, 0.12, 0.01, 0.001}});
const CameraModel kRound({.width_px = 640,
                          .height_px = 480,
                          .focal_px = {320.5, 321.25},
                          .principal_px = {318.5, 241.75},
                          .distortion = {-0.02, 0.006, -0.003, 0.0004},
                          .lens = LensKind::fisheye});

Dataset walk_round(std::vector<CameraModel> cameras) {
  Dataset dataset{.cameras = std::move(cameras), .frames = {}, .points = {}};
  for (int i = 0; i < 7; ++i) {
    DatasetFrame frame{.image = "images/a view " + std::to_string(i) + ".png",
                       .camera = static_cast<std::size_t>(i) % dataset.cameras.size()};
    frame.world_from_camera.linear() =
        Eigen::AngleAxisd(0.9 * i + 0.1, Eigen::Vector3d(1, 0.3 * i, -2).normalized())
            .toRotationMatrix();
    frame.world_from_camera.translation() = Eigen::Vector3d(0.1 * i, -2.0 / 3, 0.5 - i);
    dataset.frames.push_back(frame);
  }
  dataset.points.push_back({.position = {1, 2, 3}, .colour = {255, 0, 7}});
  return dataset;
}

/// Numbers are written with all their digits; what is left is rounding of half pixels and of
/// rotations that went through a quaternion.
void expect_same_dataset(const Dataset& read, const Dataset& written) {
  ASSERT_EQ(read.cameras.size(), written.cameras.size());
  for (std::size_t i = 0; i < read.cameras.size(); ++i) {
    const auto& a = read.cameras[i].intrinsics();
    const auto& b = written.cameras[i].intrinsics();
    EXPECT_EQ(a.lens, b.lens);
    EXPECT_EQ(a.width_px, b.width_px);
    EXPECT_LT((a.focal_px - b.focal_px).norm(), 1e-12);
    EXPECT_LT((a.principal_px - b.principal_px).norm(), 1e-12);
    EXPECT_EQ(a.distortion, b.distortion);
  }
  ASSERT_EQ(read.frames.size(), written.frames.size());
  for (std::size_t i = 0; i < read.frames.size(); ++i) {
    EXPECT_EQ(read.frames[i].image, written.frames[i].image);
    EXPECT_EQ(read.frames[i].camera, written.frames[i].camera);
    EXPECT_LT(
        (read.frames[i].world_from_camera.matrix() - written.frames[i].world_from_camera.matrix())
            .cwiseAbs()
            .maxCoeff(),
        1e-13);
  }
}

TEST(Dataset, TransformsComeBack) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "transforms.json";
  for (const auto& cameras : {std::vector{kWide}, std::vector{kRound}}) {
    Dataset dataset = walk_round(cameras);
    dataset.frames[2].sharpness = 31.25;
    write_transforms(path, dataset);
    const Dataset read = read_transforms(path);
    expect_same_dataset(read, dataset);
    EXPECT_EQ(read.frames[2].sharpness, 31.25);
  }
}

TEST(Dataset, ColmapModelsComeBack) {
  for (const ColmapForm form : {ColmapForm::text, ColmapForm::binary}) {
    const TemporaryFolder folder;
    const Dataset dataset = walk_round({kRational, kRound, kWide});
    write_colmap_model(folder.path(), dataset, form);
    expect_same_dataset(read_colmap_model(folder.path()), dataset);
  }
}

// nerfstudio's cameras.py, by hand: the ray of the place (u, v), counted from the image's corner,
// is ((u - cx) / fl_x, -(v - cy) / fl_y, -1) in a camera with y up that looks along -z. The centre
// of the pixel (i, j) is the place (i + 1/2, j + 1/2).
TEST(Dataset, ARayOfTransformsIsThatOfTheCamera) {
  const TemporaryFolder folder;
  const auto path = write_file(folder.path() / "t.json", R"({"w": 64, "h": 48, "fl_x": 50,
    "fl_y": 40, "cx": 30, "cy": 20, "frames": [{"file_path": "./a.png", "transform_matrix":
    [[0, 0, 1, 5], [1, 0, 0, 6], [0, 1, 0, 7], [0, 0, 0, 1]]}]})");
  const Dataset dataset = read_transforms(path);
  ASSERT_EQ(dataset.frames.size(), 1U);
  EXPECT_EQ(dataset.frames[0].image, "a.png");
  const Eigen::Vector3d ray((40.5 - 30) / 50, -(10.5 - 20) / 40, -1);
  const Eigen::Vector3d in_world(ray.z() + 5, ray.x() + 6, ray.y() + 7);  // the matrix, by hand
  const auto pixel =
      dataset.cameras[0].project(dataset.frames[0].world_from_camera.inverse() * in_world);
  ASSERT_TRUE(pixel.has_value());
  EXPECT_LT((*pixel - Eigen::Vector2d(40, 10)).norm(), 1e-10);
}

// COLMAP's image centre of 64 x 48 pixels is (32, 24), between pixels 31 and 32: 31.5 from the
// first centre. Its pose goes from world to camera: with no turn the camera stands at -t.
TEST(Dataset, ColmapCountsFromTheCorner) {
  const TemporaryFolder folder;
  write_file(folder.path() / "cameras.txt", "# text\n7 SIMPLE_RADIAL 64 48 50 32 24 0.125\n");
  write_file(folder.path() / "images.txt",
             "3 1 0 0 0 1 2 3 7 my view.png\n1.5 2.5 -1 3 4 8\n4 1 0 0 0 1 2 3 7 b.png\n\n");
  const Dataset dataset = read_colmap_model(folder.path());
  ASSERT_EQ(dataset.frames.size(), 2U);
  EXPECT_EQ(dataset.frames[0].image, "my view.png");
  EXPECT_EQ(dataset.frames[0].world_from_camera.translation(), Eigen::Vector3d(-1, -2, -3));
  const auto& lens = dataset.cameras[0].intrinsics();
  EXPECT_EQ(lens.principal_px, Eigen::Vector2d(31.5, 23.5));
  EXPECT_EQ(lens.focal_px, Eigen::Vector2d(50, 50));
  EXPECT_EQ(lens.distortion[0], 0.125);
}

TEST(Dataset, LensesThatAFormCannotHoldAreRefusedByName) {
  const TemporaryFolder folder;
  expect_bad_input([&] { write_transforms(folder.path() / "t.json", walk_round({kRational})); },
                   "k4 to k6");
  expect_bad_input(
      [&] {
        write_transforms(folder.path() / "t.json", walk_round({kWide, kRound}));
      },
      "one kind");
  write_file(folder.path() / "cameras.txt", "1 FOV 64 48 50 50 32 24 0.1\n");
  expect_bad_input([&] { read_colmap_model(folder.path()); }, "cameras.txt", "FOV");
}

TEST(Dataset, HostileTransformsAreRefused) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "t.json";
  write_transforms(path, walk_round({kWide}));
  const auto good = nlohmann::json::parse(tests::read_file(path));
  const auto refused = [&](const auto& change, const char* word) {
    auto bad = good;
    change(bad);
    write_file(path, bad.dump());
    expect_bad_input([&] { read_transforms(path); }, "t.json", word);
  };
  auto first = [](auto& file) -> auto& {
    return file["frames"][0];
  };
  refused([&](auto& file) { first(file)["file_path"] = "../../etc/passwd"; }, "passwd");
  refused([&](auto& file) { first(file)["file_path"] = "/etc/passwd"; }, "passwd");
  refused([&](auto& file) { first(file)["file_path"] = "a\nb"; }, "inside");
  refused([&](auto& file) { first(file)["transform_matrix"][0][0] = 5; }, "rigid");
  refused([&](auto& file) { first(file)["transform_matrix"][0][3] = nullptr; }, "no number");
  refused([&](auto& file) { first(file)["transform_matrix"] = 3; }, "rows");
  refused([&](auto& file) { file["w"] = 1e12; }, "w is no image size");
  refused([&](auto& file) { file["h"] = -4; }, "h is no image size");
  refused([&](auto& file) { file["fl_x"] = "long"; }, "fl_x");
  refused([&](auto& file) { file["camera_model"] = "EQUIRECTANGULAR"; }, "EQUIRECTANGULAR");
  refused([&](auto& file) { file["frames"] = nlohmann::json::array(); }, "no frames");
  write_file(path, good.dump().substr(0, 300));
  expect_bad_input([&] { read_transforms(path); }, "t.json");
  write_file(path, std::string(100000, '['));
  expect_bad_input([&] { read_transforms(path); }, "deep");
}

/// Every length of a binary model but the whole is refused, and so are counts beyond the file.
TEST(Dataset, HostileColmapModelsAreRefused) {
  const TemporaryFolder folder;
  write_colmap_model(folder.path(), walk_round({kRational}), ColmapForm::binary);
  for (const char* name : {"cameras.bin", "images.bin"}) {
    const auto path = folder.path() / name;
    const std::string good = tests::read_file(path);
    for (std::size_t length = 0; length < good.size(); length += 7) {
      write_file(path, good.substr(0, length));
      expect_bad_input([&] { read_colmap_model(folder.path()); }, name);
    }
    for (const char byte : {'\x7f', '\xff'}) {
      std::string huge = good;
      std::fill_n(huge.begin() + 1, 7, byte);
      write_file(path, huge);
      expect_bad_input([&] { read_colmap_model(folder.path()); }, "shorter than it says");
    }
    std::string unknown = good;  // the focal length, or the first image's quaternion
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::memcpy(unknown.data() + (std::string(name) == "cameras.bin" ? 32 : 12), &nan, sizeof nan);
    write_file(path, unknown);
    expect_bad_input([&] { read_colmap_model(folder.path()); }, name);
    write_file(path, good);
  }
}

TEST(Dataset, RealTransformsOfInstantNgp) {
  const auto path = std::filesystem::path(SHEEN_SHARED_DATA) / "fox" / "transforms.json";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  const Dataset dataset = read_transforms(path);
  ASSERT_EQ(dataset.cameras.size(), 1U);
  EXPECT_NEAR(dataset.cameras[0].intrinsics().principal_px.x(), 277.279 - 0.5, 1e-9);
  ASSERT_FALSE(dataset.frames.empty());
  for (const DatasetFrame& frame : dataset.frames) {
    EXPECT_TRUE(std::filesystem::exists(path.parent_path() / frame.image)) << frame.image;
    EXPECT_TRUE(frame.sharpness.has_value());
  }
}

// Files may repeat the camera at every image, or have as many as images.
TEST(Dataset, CamerasAreKeptOnce) {
  const TemporaryFolder folder;
  std::string frames;
  for (int i = 0; i < 60; ++i) {
    frames += std::string(i == 0 ? "" : ",") + R"({"file_path": "a)" + std::to_string(i) +
              R"(.png", "fl_x": )" + std::to_string(50 + i % 20) +
              R"(, "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]})";
  }
  write_file(folder.path() / "transforms.json",
             R"({"w": 64, "h": 48, "frames": [)" + frames + "]}");
  const Dataset dataset = read_dataset(folder.path(), {});
  ASSERT_EQ(dataset.cameras.size(), 20U);
  for (std::size_t i = 0; i < 60; ++i) {
    EXPECT_EQ(dataset.cameras[dataset.frames[i].camera].intrinsics().focal_px.x(),
              50.0 + static_cast<double>(i % 20));
  }
}

/// A session of one frame per image; the mesh is only copied.
TEST(Dataset, ImportMakesASessionInTheOrderOfNames) {
  const TemporaryFolder folder;
  Dataset dataset = walk_round({kWide});
  std::reverse(dataset.frames.begin(), dataset.frames.end());
  std::filesystem::create_directories(folder.path() / "images");
  for (const DatasetFrame& frame : dataset.frames) {
    write_file(folder.path() / frame.image, frame.image);
  }
  core::Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals.assign(3, {0, 0, 1});
  mesh.triangles = {{0, 1, 2}};
  core::write_ply(folder.path() / "mesh.ply", mesh);
  write_transforms(folder.path() / "transforms.json", dataset);
  SessionImport import{.dataset = read_dataset(folder.path(), {}),
                       .images = folder.path(),
                       .mesh = folder.path() / "mesh.ply",
                       .metres_per_unit = 0.5};
  write_imported_session(import, folder.path() / "session");
  const Session session = open_session(folder.path() / "session");
  EXPECT_EQ(tests::read_file(session.folder / "images/000003.png"), "images/a view 3.png");
  const Trajectory trajectory = read_trajectory(*session.poses);
  ASSERT_EQ(trajectory.entries().size(), 7U);
  const auto& pose = trajectory.entries()[3].board_from_camera;
  // 3 of walk_round, which stands at index 3 of the reversed list too.
  const auto& written = dataset.frames[3].world_from_camera;
  EXPECT_LT((pose.translation() - 0.5 * written.translation()).norm(), 1e-6);
  EXPECT_LT((pose.linear() - written.linear()).norm(), 1e-6);
  EXPECT_LT((session.camera.intrinsics().principal_px - kWide.intrinsics().principal_px).norm(),
            1e-6);
  expect_bad_input([&] { write_imported_session(import, folder.path() / "session"); }, "exists");
  write_file(folder.path() / "mesh.ply", "no mesh");
  expect_bad_input([&] { write_imported_session(import, folder.path() / "other"); }, "mesh.ply");
  std::filesystem::remove(folder.path() / dataset.frames[2].image);
  expect_bad_input([&] { write_imported_session(import, folder.path() / "other"); }, "view 4.png");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "other"));
  import.dataset = walk_round({kWide, kRound});
  expect_bad_input([&] { write_imported_session(import, folder.path() / "other"); }, "2 cameras");
}

/// A real session -> COLMAP -> session: poses and camera to the digits of poses.txt.
TEST(Dataset, RealSessionComesBackFromColmap) {
  const auto temple = std::filesystem::path(SHEEN_SHARED_DATA) / "temple";
  if (!std::filesystem::exists(temple)) GTEST_SKIP() << "no " << temple;
  const TemporaryFolder folder;
  const Session session = open_session(temple);
  Dataset dataset{.cameras = {session.camera}, .frames = {}, .points = {}};
  const auto entries = read_trajectory(*session.poses).entries();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::string number = std::to_string(i);
    dataset.frames.push_back({.image = std::string(4 - number.size(), '0') + number + ".png",
                              .world_from_camera = entries[i].board_from_camera});
  }
  for (const ColmapForm form : {ColmapForm::text, ColmapForm::binary}) {
    write_colmap_model(folder.path(), dataset, form);
    const auto target = folder.path() / (form == ColmapForm::text ? "text" : "binary");
    write_imported_session({.dataset = read_dataset(folder.path(), {}),
                            .images = temple / "images",
                            .mesh = session.mesh},
                           target);
    const Session read = open_session(target);
    EXPECT_EQ(read.camera.intrinsics().distortion, session.camera.intrinsics().distortion);
    EXPECT_LT(
        (read.camera.intrinsics().principal_px - session.camera.intrinsics().principal_px).norm(),
        1e-9);
    const auto back = read_trajectory(*read.poses).entries();
    ASSERT_EQ(back.size(), entries.size());
    for (std::size_t i = 0; i < back.size(); ++i) {
      EXPECT_LT((back[i].board_from_camera.matrix() - entries[i].board_from_camera.matrix())
                    .cwiseAbs()
                    .maxCoeff(),
                1e-6);
    }
  }
}

}  // namespace
}  // namespace sheen::capture::test
