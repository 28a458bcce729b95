// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"
#include "core/mesh/read_mesh.h"
#include "tests/core/glb_builder.h"
#include "tests/core/shapes.h"
#include "tests/support/temporary_folder.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace sheen::core {
namespace {

using testing::area_of;

using tests::GlbBuilder;
using tests::TemporaryFolder;
using tests::write_file;

std::vector<std::uint32_t> corners_of(const Mesh& mesh) {
  std::vector<std::uint32_t> corners;
  for (const auto& triangle : mesh.triangles) {
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  return corners;
}

std::string floats_of(const std::vector<Eigen::Vector3f>& vectors) {
  std::string bytes;
  for (const auto& vector : vectors) {
    for (const float value : vector) GlbBuilder::append(bytes, value);
  }
  return bytes;
}

/// `vectors` times `top`, rounded to whole numbers of `T`, every one padded to four bytes.
template <typename T>
std::string integers_of(const std::vector<Eigen::Vector3f>& vectors, double top, double shift) {
  std::string bytes;
  for (const auto& vector : vectors) {
    for (const float value : vector) {
      GlbBuilder::append(bytes,
                         static_cast<T>(std::lround(top * (static_cast<double>(value) + shift))));
    }
    bytes.append(sizeof(T), '\0');
  }
  return bytes;
}

/// The sphere in floats; what the other encodings are compared with.
GlbBuilder plain(const Mesh& mesh) {
  GlbBuilder glb;
  auto& attributes = glb.primitive()["attributes"];
  attributes["POSITION"] = glb.add_vectors(glb.add_view(floats_of(mesh.positions)),
                                           GlbBuilder::float32, mesh.positions.size());
  attributes["NORMAL"] = glb.add_vectors(glb.add_view(floats_of(mesh.normals)), GlbBuilder::float32,
                                         mesh.normals.size());
  glb.primitive()["indices"] = glb.add_indices(corners_of(mesh));
  return glb;
}

std::string fault_of_glb(const std::filesystem::path& path) {
  try {
    read_mesh(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::bad_input);
    return error.what();
  }
  ADD_FAILURE() << path << " was accepted";
  return {};
}

class GltfTest : public ::testing::Test {
 protected:
  Mesh read(const GlbBuilder& glb, const std::string& name = "mesh.glb") {
    return read_mesh(write_file(folder_ / name, glb.bytes()), &notes_);
  }

  TemporaryFolder folder_;
  std::vector<std::string> notes_;
  const Mesh sphere_ = testing::sphere(10, 14);
};

template <typename T>
void expect_quantised(const Mesh& sphere, GlbBuilder::Component component, bool is_normalised,
                      const std::filesystem::path& file) {
  SCOPED_TRACE("component " + std::to_string(component) + (is_normalised ? " normalised" : ""));
  // Numbers of T over [0, top] or [-top, top]; the node brings them back to the unit sphere.
  constexpr bool is_signed = std::numeric_limits<T>::is_signed;
  const double top = std::numeric_limits<T>::max();
  const double shift = is_signed ? 0 : 1;
  const double steps = is_signed ? top : top / 2;  // for one unit
  GlbBuilder glb;
  glb.require("KHR_mesh_quantization");
  const auto view = glb.add_view(integers_of<T>(sphere.positions, steps, shift), 4 * sizeof(T));
  glb.primitive()["attributes"]["POSITION"] =
      glb.add_vectors(view, component, sphere.positions.size(), is_normalised);
  glb.primitive()["indices"] = glb.add_indices(corners_of(sphere));
  const double scale = is_normalised ? top / steps : 1 / steps;
  glb.node()["scale"] = {scale, scale, scale};
  glb.node()["translation"] = {-shift, -shift, -shift};
  const Mesh mesh = read_mesh(write_file(file, glb.bytes()));
  ASSERT_EQ(mesh.positions.size(), sphere.positions.size());
  EXPECT_EQ(mesh.triangles, sphere.triangles);
  // Half a step and the rounding of single precision.
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_LT((mesh.positions[i] - sphere.positions[i]).cwiseAbs().maxCoeff(), 0.5 / steps + 1e-6);
  }
}

TEST_F(GltfTest, QuantisedPositionsAreThoseOfFloatsToHalfAStep) {
  for (const bool is_normalised : {false, true}) {
    expect_quantised<std::int8_t>(sphere_, GlbBuilder::int8, is_normalised, folder_ / "b.glb");
    expect_quantised<std::uint8_t>(sphere_, GlbBuilder::uint8, is_normalised, folder_ / "ub.glb");
    expect_quantised<std::int16_t>(sphere_, GlbBuilder::int16, is_normalised, folder_ / "s.glb");
    expect_quantised<std::uint16_t>(sphere_, GlbBuilder::uint16, is_normalised, folder_ / "us.glb");
  }
}

TEST_F(GltfTest, QuantisedNormalsPointWhereFloatsDo) {
  GlbBuilder glb = plain(sphere_);
  glb.require("KHR_mesh_quantization");
  const auto view = glb.add_view(integers_of<std::int8_t>(sphere_.normals, 127, 0), 4);
  glb.primitive()["attributes"]["NORMAL"] =
      glb.add_vectors(view, GlbBuilder::int8, sphere_.normals.size(), true);
  const Mesh mesh = read(glb);
  // Each of three components is off by half of 1/127: sqrt(3)/254 = 0.0068 rad.
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    EXPECT_LT((mesh.normals[i] - sphere_.normals[i]).norm(), std::sqrt(3.0) / 254 + 1e-6);
  }
}

GlbBuilder packed_by_meshopt(const Mesh& mesh, std::string* damaged = nullptr) {
  GlbBuilder glb;
  glb.require("EXT_meshopt_compression");
  const std::size_t vertices = mesh.positions.size();
  const std::vector<std::uint32_t> corners = corners_of(mesh);
  std::string packed(meshopt_encodeVertexBufferBound(vertices, 12), '\0');
  packed.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(packed.data()),
                                           packed.size(), mesh.positions.data(), vertices, 12));
  if (damaged != nullptr) packed = *damaged;
  std::string indices(meshopt_encodeIndexBufferBound(corners.size(), vertices), '\0');
  indices.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(indices.data()),
                                           indices.size(), corners.data(), corners.size()));
  const auto add = [&glb](const std::string& bytes, std::size_t stride, std::size_t count,
                          const char* mode) {
    const std::size_t view = glb.add_view(bytes);
    auto& object = glb.document["bufferViews"][view];
    object["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                       {"byteOffset", object["byteOffset"]},
                                                       {"byteLength", bytes.size()},
                                                       {"byteStride", stride},
                                                       {"count", count},
                                                       {"mode", mode}};
    object["byteLength"] = stride * count;
    return view;
  };
  const auto positions = add(packed, 12, vertices, "ATTRIBUTES");
  glb.primitive()["attributes"]["POSITION"] =
      glb.add_vectors(positions, GlbBuilder::float32, vertices);
  glb.primitive()["indices"] =
      glb.add_accessor({{"bufferView", add(indices, 4, corners.size(), "TRIANGLES")},
                        {"componentType", GlbBuilder::uint32},
                        {"count", corners.size()},
                        {"type", "SCALAR"}});
  return glb;
}

TEST_F(GltfTest, PackedByMeshoptIsTheSameSurface) {
  const Mesh mesh = read(packed_by_meshopt(sphere_));
  EXPECT_EQ(mesh.positions, sphere_.positions);
  // The codec may turn the corners of a triangle round, not their order.
  ASSERT_EQ(mesh.triangles.size(), sphere_.triangles.size());
  EXPECT_NEAR(area_of(mesh), area_of(sphere_), 1e-5);
}

TEST_F(GltfTest, MeshoptDataCutShortIsRefused) {
  for (const std::size_t size : {0U, 1U, 7U, 40U}) {
    std::string damaged(size, '\xa0');
    EXPECT_NE(
        fault_of_glb(write_file(folder_ / "cut.glb", packed_by_meshopt(sphere_, &damaged).bytes())),
        "");
  }
}

/// The sphere through Draco, with positions of `bits` bits.
std::string packed_by_draco(const Mesh& mesh, int bits) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(mesh.triangles.size()));
  const int position =
      builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& triangle = mesh.triangles[t];
    builder.SetAttributeValuesForFace(position, draco::FaceIndex(static_cast<std::uint32_t>(t)),
                                      mesh.positions[triangle[0]].data(),
                                      mesh.positions[triangle[1]].data(),
                                      mesh.positions[triangle[2]].data());
  }
  const auto built = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*built, &buffer).ok());
  return {buffer.data(), buffer.size()};
}

GlbBuilder with_draco(const Mesh& mesh, const std::string& packed) {
  GlbBuilder glb;
  glb.require("KHR_draco_mesh_compression");
  auto& primitive = glb.primitive();
  primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", glb.add_view(packed)},
                                                           {"attributes", {{"POSITION", 0}}}};
  primitive["attributes"]["POSITION"] = glb.add_accessor(
      {{"componentType", GlbBuilder::float32}, {"count", mesh.positions.size()}, {"type", "VEC3"}});
  primitive["indices"] = glb.add_accessor({{"componentType", GlbBuilder::uint32},
                                           {"count", 3 * mesh.triangles.size()},
                                           {"type", "SCALAR"}});
  return glb;
}

TEST_F(GltfTest, PackedByDracoIsTheSameSurfaceToItsSteps) {
  constexpr int bits = 12;
  const Mesh mesh = read(with_draco(sphere_, packed_by_draco(sphere_, bits)));
  ASSERT_EQ(mesh.positions.size(), sphere_.positions.size());
  ASSERT_EQ(mesh.triangles.size(), sphere_.triangles.size());
  // The sphere is 2 across: every position moves by at most half a step along each axis, so each
  // lies as far from the middle as before to sqrt(3) halves of a step.
  const float step = 2.0f / ((1 << bits) - 1);
  for (const auto& position : mesh.positions) EXPECT_NEAR(position.norm(), 1, 0.87f * step + 1e-6f);
  // Edges are about 0.45 long; each end moves by 0.87 of a step.
  EXPECT_NEAR(area_of(mesh), area_of(sphere_),
              area_of(sphere_) * 4 * 0.87 * static_cast<double>(step) / 0.45);
}

TEST_F(GltfTest, AlteredDracoDataIsRefusedOrReadNeverMore) {
  const std::string packed = packed_by_draco(sphere_, 10);
  for (std::size_t i = 0; i < packed.size(); i += 3) {
    std::string altered = packed;
    altered[i] = static_cast<char>(altered[i] ^ 0x55);
    const auto path = write_file(folder_ / "altered.glb", with_draco(sphere_, altered).bytes());
    try {
      EXPECT_LE(read_mesh(path).positions.size(), sphere_.positions.size());
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::bad_input);
    }
  }
  for (std::size_t size = 0; size < packed.size(); size += 11) {
    fault_of_glb(
        write_file(folder_ / "cut.glb", with_draco(sphere_, packed.substr(0, size)).bytes()));
  }
}

TEST_F(GltfTest, RequiredExtensionsThatAreNotReadAreNamed) {
  GlbBuilder glb = plain(sphere_);
  glb.require("EXT_another_geometry");
  const std::string what = fault_of_glb(write_file(folder_ / "other.glb", glb.bytes()));
  EXPECT_NE(what.find("EXT_another_geometry"), std::string::npos) << what;
  // About colours only: passed over.
  GlbBuilder shiny = plain(sphere_);
  shiny.require("KHR_materials_clearcoat");
  EXPECT_EQ(read(shiny).positions, sphere_.positions);
}

TEST_F(GltfTest, UnalignedChunksAreRead) {
  const Mesh mesh = read_mesh(write_file(folder_ / "odd.glb", plain(sphere_).bytes(false)));
  EXPECT_EQ(mesh.positions, sphere_.positions);
}

TEST_F(GltfTest, StripsAndFansAreTheSameSurfaceAsTriangles) {
  // A strip of n quads in the plane z = 0 from 0 to n: area n, all normals +z.
  constexpr int quads = 5;
  GlbBuilder strip;
  std::vector<Eigen::Vector3f> positions;
  for (int i = 0; i <= quads; ++i) {
    positions.emplace_back(static_cast<float>(i), 1.0f, 0.0f);
    positions.emplace_back(static_cast<float>(i), 0.0f, 0.0f);
  }
  strip.primitive()["attributes"]["POSITION"] = strip.add_vectors(
      strip.add_view(floats_of(positions)), GlbBuilder::float32, positions.size());
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0U);
  strip.primitive()["indices"] = strip.add_indices(order);
  strip.primitive()["mode"] = 5;
  const Mesh mesh = read(strip, "strip.glb");
  EXPECT_EQ(mesh.triangles.size(), 2U * quads);
  EXPECT_NEAR(area_of(mesh), quads, 1e-5);
  for (const auto& normal : mesh.normals) EXPECT_EQ(normal, Eigen::Vector3f(0, 0, 1));

  // A fan round the middle of a regular polygon of n corners: area n / 2 sin(2 pi / n).
  constexpr int n = 7;
  GlbBuilder fan;
  positions = {{0, 0, 0}};
  for (int i = 0; i <= n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    positions.emplace_back(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)),
                           0.0f);
  }
  fan.primitive()["attributes"]["POSITION"] =
      fan.add_vectors(fan.add_view(floats_of(positions)), GlbBuilder::float32, positions.size());
  fan.primitive()["mode"] = 6;  // without indices: every vertex in turn
  const Mesh disc = read(fan, "fan.glb");
  EXPECT_EQ(disc.triangles.size(), static_cast<std::size_t>(n));
  EXPECT_NEAR(area_of(disc), n / 2.0 * std::sin(2 * std::numbers::pi / n), 1e-5);
}

TEST_F(GltfTest, SparsePartsReplaceTheBase) {
  GlbBuilder glb = plain(sphere_);
  std::vector<Eigen::Vector3f> wrong = sphere_.positions;
  wrong[3] = {9, 9, 9};
  wrong[8] = {9, 9, 9};
  const auto base =
      glb.add_vectors(glb.add_view(floats_of(wrong)), GlbBuilder::float32, wrong.size());
  std::string indices;
  for (const std::uint16_t index : {std::uint16_t{3}, std::uint16_t{8}}) {
    GlbBuilder::append(indices, index);
  }
  const auto index_view = glb.add_view(indices);
  const auto value_view = glb.add_view(floats_of({sphere_.positions[3], sphere_.positions[8]}));
  glb.document["accessors"][base]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", index_view}, {"componentType", GlbBuilder::uint16}}},
      {"values", {{"bufferView", value_view}}}};
  glb.primitive()["attributes"]["POSITION"] = base;
  EXPECT_EQ(read(glb).positions, sphere_.positions);
}

TEST_F(GltfTest, SkinsAndMorphsAreSaidToBePassedOver) {
  GlbBuilder glb = plain(sphere_);
  glb.node()["skin"] = 0;
  glb.primitive()["targets"] = {{{"POSITION", 0}}};
  EXPECT_EQ(read(glb).positions, sphere_.positions);
  const auto says = [this](const std::string& word) {
    return std::any_of(notes_.begin(), notes_.end(), [&word](const std::string& note) {
      return note.find(word) != std::string::npos;
    });
  };
  EXPECT_TRUE(says("skin"));
  EXPECT_TRUE(says("morph"));
}

}  // namespace
}  // namespace sheen::core
