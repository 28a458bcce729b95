// SPDX-License-Identifier: MIT
// Colours of vertices: a cube whose faces have one colour each, in every format.
#include "core/diagnostics/error.h"
#include "core/image/png.h"
#include "core/image/srgb_curve.h"
#include "core/mesh/read_mesh.h"
#include "tests/core/glb_builder.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <array>
#include <sstream>
#include <string>
#include <vector>

namespace sheen::core {
namespace {

using tests::GlbBuilder;
using tests::TemporaryFolder;
using tests::write_file;

/// Side 2 around the origin; face i looks along axis i / 2.
struct ColouredCube {
  std::vector<Eigen::Vector3f> corners;  ///< four for every face
  std::vector<std::uint32_t> indices;
};

ColouredCube coloured_cube() {
  ColouredCube cube;
  for (int face = 0; face < 6; ++face) {
    const float side = face % 2 == 0 ? 1.0f : -1.0f;
    const int axis = face / 2;
    for (const auto& [u, v] : {std::array{-1.0f, -1.0f}, {1, -1}, {1, 1}, {-1, 1}}) {
      Eigen::Vector3f corner;
      corner[axis] = side;
      corner[(axis + 1) % 3] = side * u;
      corner[(axis + 2) % 3] = v;
      cube.corners.push_back(corner);
    }
    const auto base = static_cast<std::uint32_t>(4 * face);
    for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) {
      cube.indices.push_back(base + corner);
    }
  }
  return cube;
}

/// Bytes of the colour of a face.
std::array<int, 3> face_colour(int face) {
  return {255 - 40 * face, 30 * face, face % 2 == 0 ? 255 : 51};
}

Eigen::Vector3f shown(int face) {
  const auto [r, g, b] = face_colour(face);
  return Eigen::Vector3f(static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)) /
         255.0f;
}

float light_of(int byte) {
  return linear_from_srgb(static_cast<float>(byte) / 255.0f);
}

/// Its colours: sRGB, one for every corner.
std::vector<Eigen::Vector3f> colours_of(const std::filesystem::path& path, Mesh& mesh,
                                        std::vector<std::string>* notes = nullptr) {
  std::vector<Eigen::Vector3f> colours;
  mesh = read_mesh(path, notes, &colours);
  return colours;
}

/// The corners of every triangle have the colour of the face in which it lies.
void expect_faces(const Mesh& mesh, const std::vector<Eigen::Vector3f>& colours) {
  ASSERT_EQ(colours.size(), mesh.positions.size());
  ASSERT_EQ(mesh.triangles.size(), 12u);
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3f middle =
        (mesh.positions[triangle[0]] + mesh.positions[triangle[1]] + mesh.positions[triangle[2]]) /
        3.0f;
    Eigen::Index axis = 0;
    middle.cwiseAbs().maxCoeff(&axis);
    const Eigen::Vector3f expected = shown(2 * static_cast<int>(axis) + (middle[axis] < 0 ? 1 : 0));
    for (const std::uint32_t corner : triangle) {
      EXPECT_LT((colours[corner] - expected).cwiseAbs().maxCoeff(), 1e-5f);
    }
  }
}

std::string obj_of(const ColouredCube& cube, bool all_coloured) {
  std::ostringstream text;
  for (std::size_t i = 0; i < cube.corners.size(); ++i) {
    text << "v " << cube.corners[i].transpose();
    if (all_coloured || i % 2 == 0) text << " " << shown(static_cast<int>(i / 4)).transpose();
    text << "\n";
  }
  for (std::size_t i = 0; i < cube.indices.size(); i += 3) {
    text << "f " << cube.indices[i] + 1 << " " << cube.indices[i + 1] + 1 << " "
         << cube.indices[i + 2] + 1 << "\n";
  }
  return text.str();
}

// Corners of different faces share positions and have no normals: colours alone keep them apart,
// and only where they are asked for.
TEST(MeshColours, OfAnObjStandBehindPositions) {
  const TemporaryFolder folder;
  const auto path = write_file(folder / "cube.obj", obj_of(coloured_cube(), true));
  Mesh mesh;
  const auto colours = colours_of(path, mesh);
  EXPECT_EQ(mesh.positions.size(), 24u);
  expect_faces(mesh, colours);
  EXPECT_EQ(read_mesh(path).positions.size(), 8u);
}

// A fourth number alone is a weight; colours at some vertices are none.
TEST(MeshColours, OfAnObjAreThoseOfAllVertices) {
  const TemporaryFolder folder;
  Mesh mesh;
  std::vector<std::string> notes;
  EXPECT_TRUE(colours_of(write_file(folder / "w.obj", "v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n"),
                         mesh, &notes)
                  .empty());
  EXPECT_TRUE(notes.empty());
  EXPECT_TRUE(
      colours_of(write_file(folder / "some.obj", obj_of(coloured_cube(), false)), mesh, &notes)
          .empty());
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("some of its vertices only"), std::string::npos);
}

/// The cube without colours.
GlbBuilder plain_cube(const ColouredCube& cube) {
  GlbBuilder glb;
  std::string bytes;
  for (const auto& corner : cube.corners) {
    for (const float value : corner) GlbBuilder::append(bytes, value);
  }
  glb.primitive()["attributes"]["POSITION"] =
      glb.add_vectors(glb.add_view(bytes), GlbBuilder::float32, cube.corners.size());
  glb.primitive()["indices"] = glb.add_indices(cube.indices);
  return glb;
}

// COLOR_0 is light; half of it by COLOR_0 and twice by the material are the same colour.
TEST(MeshColours, OfAGlbAreLight) {
  const TemporaryFolder folder;
  const ColouredCube cube = coloured_cube();
  for (const double factor : {1.0, 0.5}) {
    GlbBuilder glb = plain_cube(cube);
    std::string bytes;
    for (std::size_t i = 0; i < cube.corners.size(); ++i) {
      for (const int byte : face_colour(static_cast<int>(i / 4))) {
        GlbBuilder::append(bytes, light_of(byte) / static_cast<float>(factor));
      }
    }
    glb.primitive()["attributes"]["COLOR_0"] =
        glb.add_vectors(glb.add_view(bytes), GlbBuilder::float32, cube.corners.size());
    glb.document["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorFactor", {factor, factor, factor, 1}}}}}};
    glb.primitive()["material"] = 0;
    Mesh mesh;
    const auto colours = colours_of(write_file(folder / "cube.glb", glb.bytes()), mesh);
    expect_faces(mesh, colours);
  }
}

// Four normalised bytes a colour.
TEST(MeshColours, OfAGlbMayBeBytes) {
  const TemporaryFolder folder;
  const ColouredCube cube = coloured_cube();
  GlbBuilder glb = plain_cube(cube);
  const std::string bytes(4 * cube.corners.size(), '\x33');
  glb.primitive()["attributes"]["COLOR_0"] = glb.add_accessor({{"bufferView", glb.add_view(bytes)},
                                                               {"componentType", GlbBuilder::uint8},
                                                               {"normalized", true},
                                                               {"count", cube.corners.size()},
                                                               {"type", "VEC4"}});
  Mesh mesh;
  const auto colours = colours_of(write_file(folder / "cube.glb", glb.bytes()), mesh);
  ASSERT_EQ(colours.size(), 24u);
  for (const auto& colour : colours) {
    EXPECT_LT((colour.array() - srgb_from_linear(0.2f)).abs().maxCoeff(), 1e-5f);
  }
}

/// A picture of one pixel for every face; each corner is at `pixel` pixels of its face's middle.
GlbBuilder cube_with_picture(const ColouredCube& cube, float pixel) {
  GlbBuilder glb = plain_cube(cube);
  cv::Mat picture(1, 6, CV_8UC3);
  for (int face = 0; face < 6; ++face) {
    const auto [r, g, b] = face_colour(face);
    picture.at<cv::Vec3b>(0, face) = {static_cast<std::uint8_t>(b), static_cast<std::uint8_t>(g),
                                      static_cast<std::uint8_t>(r)};
  }
  const auto png = encode_png(picture);
  std::string places;
  for (std::size_t i = 0; i < cube.corners.size(); ++i) {
    GlbBuilder::append(places, (static_cast<float>(i / 4) + 0.5f + pixel) / 6);
    GlbBuilder::append(places, 0.5f);
  }
  const std::size_t view = glb.add_view(std::string(png.begin(), png.end()));
  glb.document["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
  glb.document["textures"] = {{{"source", 0}}};
  glb.document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  glb.primitive()["material"] = 0;
  glb.primitive()["attributes"]["TEXCOORD_0"] =
      glb.add_accessor({{"bufferView", glb.add_view(places)},
                        {"componentType", GlbBuilder::float32},
                        {"count", cube.corners.size()},
                        {"type", "VEC2"}});
  return glb;
}

// In the middle of a pixel it is that pixel, also whole pictures further on; half way to the next
// one it is the mean of both as light.
TEST(MeshColours, OfAGlbMayBeAPicture) {
  const TemporaryFolder folder;
  const ColouredCube cube = coloured_cube();
  Mesh mesh;
  for (const float turns : {0.0f, 1.0f, -3.0f}) {
    const auto path = write_file(folder / "cube.glb", cube_with_picture(cube, 6 * turns).bytes());
    const auto colours = colours_of(path, mesh);
    ASSERT_EQ(colours.size(), 24u);
    for (std::size_t i = 0; i < colours.size(); ++i) {
      // Places of single precision are off by 3 * 2^-24 * 6 pixels, whose light differs by up to
      // 1: 1e-6 of light, 12.92 times that where it is dark.
      EXPECT_LT((colours[i] - shown(static_cast<int>(i / 4))).cwiseAbs().maxCoeff(), 2e-5f);
    }
  }
  const auto path = write_file(folder / "cube.glb", cube_with_picture(cube, 0.5f).bytes());
  const auto colours = colours_of(path, mesh);
  ASSERT_EQ(colours.size(), 24u);
  for (int face = 0; face < 6; ++face) {
    const auto here = face_colour(face);
    const auto next = face_colour((face + 1) % 6);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(colours[static_cast<std::size_t>(4 * face)][static_cast<Eigen::Index>(c)],
                  srgb_from_linear((light_of(here[c]) + light_of(next[c])) / 2), 2e-5f);
    }
  }
}

// What cannot be read is told, and broken colours do not spoil the shape.
TEST(MeshColours, BrokenOnesAreRefusedOnlyWhereAsked) {
  const TemporaryFolder folder;
  const ColouredCube cube = coloured_cube();
  Mesh mesh;
  std::vector<std::string> notes;

  GlbBuilder short_of_colours = plain_cube(cube);
  short_of_colours.primitive()["attributes"]["COLOR_0"] = short_of_colours.add_vectors(
      short_of_colours.add_view(std::string(12, '\0')), GlbBuilder::float32, 1);
  const auto path = write_file(folder / "short.glb", short_of_colours.bytes());
  EXPECT_THROW(colours_of(path, mesh), Error);
  EXPECT_EQ(read_mesh(path).triangles.size(), 12u);

  GlbBuilder no_picture = cube_with_picture(cube, 0);
  no_picture.document["images"] = {{{"uri", "elsewhere.png"}}};
  const auto white = colours_of(write_file(folder / "uri.glb", no_picture.bytes()), mesh, &notes);
  ASSERT_EQ(white.size(), 24u);
  EXPECT_LT((white[0].array() - 1).abs().maxCoeff(), 1e-6f);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("picture"), std::string::npos);

  GlbBuilder lost = cube_with_picture(cube, 0);
  lost.document["textures"][0]["source"] = 7;
  EXPECT_THROW(colours_of(write_file(folder / "lost.glb", lost.bytes()), mesh), Error);
  EXPECT_TRUE(colours_of(write_file(folder / "plain.glb", plain_cube(cube).bytes()), mesh).empty());
}

}  // namespace
}  // namespace sheen::core
