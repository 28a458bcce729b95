// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"
#include "core/files/read_file.h"
#include "core/mesh/bounds.h"
#include "core/mesh/neighbours.h"
#include "core/mesh/read_mesh.h"
#include "tests/core/shapes.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <set>
#include <sstream>

namespace sheen::core {
namespace {

using tests::read_file;
using tests::TemporaryFolder;
using tests::write_file;

/// Side 2 around the origin, corner i at the signs of its bits, faces as outward quads.
constexpr int kCubeFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

Eigen::Vector3f cube_corner(int i) {
  return {(i & 1) != 0 ? 1.0f : -1.0f, (i & 2) != 0 ? 1.0f : -1.0f, (i & 4) != 0 ? 1.0f : -1.0f};
}

std::string ascii_ply(const std::string& vertices, int vertex_count, const std::string& faces,
                      int face_count) {
  return "ply\nformat ascii 1.0\ncomment made by a test\nelement vertex " +
         std::to_string(vertex_count) + "\nproperty float x\nproperty float y\nproperty float z\n" +
         "element face " + std::to_string(face_count) +
         "\nproperty list uchar int vertex_indices\nend_header\n" + vertices + faces;
}

std::string cube_ply(bool inside_out) {
  std::ostringstream vertices;
  std::ostringstream faces;
  for (int i = 0; i < 8; ++i) vertices << cube_corner(i).transpose() << "\n";
  for (const auto& face : kCubeFaces) {
    faces << 4;
    for (int c = 0; c < 4; ++c) faces << " " << face[inside_out ? 3 - c : c];
    faces << "\n";
  }
  return ascii_ply(vertices.str(), 8, faces.str(), 6);
}

/// Four vertices per face, as hard edges need.
Mesh hard_cube() {
  Mesh mesh;
  for (const auto& face : kCubeFaces) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    Eigen::Vector3f centre = Eigen::Vector3f::Zero();
    for (const int corner : face) {
      mesh.positions.push_back(cube_corner(corner));
      centre += cube_corner(corner) / 4;
    }
    mesh.normals.insert(mesh.normals.end(), 4, centre);
    mesh.triangles.emplace_back(base, base + 1, base + 2);
    mesh.triangles.emplace_back(base, base + 2, base + 3);
  }
  return mesh;
}

template <typename T>
void append_raw(std::string& bytes, const T& value) {
  const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  bytes.append(raw.data(), raw.size());
}

/// A GLB with one mesh of positions and indices under a node with the given transform.
std::string glb(const std::vector<Eigen::Vector3f>& positions,
                const std::vector<std::uint32_t>& indices, const std::string& node_transform) {
  std::string binary;
  for (const auto& position : positions) {
    for (const float value : position) append_raw(binary, value);
  }
  for (const std::uint32_t index : indices) append_raw(binary, index);
  const std::string split = std::to_string(positions.size() * 12);
  const std::string index_bytes = std::to_string(indices.size() * 4);
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" +
      node_transform +
      R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"buffers":[{"byteLength":)" +
      std::to_string(binary.size()) + R"(}],"bufferViews":[{"buffer":0,"byteLength":)" + split +
      R"(},{"buffer":0,"byteOffset":)" + split + R"(,"byteLength":)" + index_bytes +
      R"(}],"accessors":[{"bufferView":0,"componentType":5126,"count":)" +
      std::to_string(positions.size()) +
      R"(,"type":"VEC3"},{"bufferView":1,"componentType":5125,"count":)" +
      std::to_string(indices.size()) + R"(,"type":"SCALAR"}]})";
  json.append((4 - json.size() % 4) % 4, ' ');
  std::string bytes = "glTF";
  append_raw(bytes, std::uint32_t{2});
  append_raw(bytes, static_cast<std::uint32_t>(28 + json.size() + binary.size()));
  append_raw(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  append_raw(bytes, static_cast<std::uint32_t>(binary.size()));
  return bytes + std::string("BIN\0", 4) + binary;
}

/// What read_mesh says about a file it refuses; fails the test when it does not refuse it.
std::string refusal(const std::filesystem::path& path) {
  try {
    read_mesh(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::bad_input);
    const std::string what = error.what();
    EXPECT_TRUE(what.starts_with(path.string() + ": ")) << what;
    EXPECT_EQ(std::count(what.begin(), what.end(), ';') > 0, true) << what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    return what;
  }
  ADD_FAILURE() << path << " was accepted";
  return {};
}

TEST(ReadMesh, AngleWeightsMakeCubeNormalsDiagonal) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(write_file(folder / "cube.ply", cube_ply(false)));
  ASSERT_EQ(mesh.positions.size(), 8u);
  ASSERT_EQ(mesh.triangles.size(), 12u);
  // Three right angles meet at every corner however the squares are cut: normal = corner / sqrt 3.
  for (int i = 0; i < 8; ++i) {
    const auto idx = static_cast<std::size_t>(i);
    EXPECT_EQ(mesh.positions[idx], cube_corner(i));
    EXPECT_LT((mesh.normals[idx] - cube_corner(i).normalized()).norm(), 1e-6f);
  }
}

TEST(ReadMesh, NamesWhatAFileIsWhateverItsEnding) {
  const tests::TemporaryFolder folder;
  const auto refusal = [&](const char* name, const std::string& bytes) -> std::string {
    folder.write(name, bytes);
    try {
      static_cast<void>(read_mesh(folder.path() / name));
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(refusal("a.obj", "solid a\n facet normal 0 0 1\n").find("STL"), std::string::npos);
  EXPECT_NE(refusal("a.ply", "glTF binary").find(".glb"), std::string::npos);
  EXPECT_NE(refusal("b.obj", "ply\nformat ascii 1.0\n").find(".ply"), std::string::npos);
  EXPECT_NE(refusal("a.glb", "{\"asset\": {}}").find("glTF text"), std::string::npos);
  EXPECT_NE(refusal("c.obj", "<!DOCTYPE html><title>Sign in</title>").find("web page"),
            std::string::npos);
  EXPECT_NE(refusal("c.ply", "version https://git-lfs.github.com/spec/v1\n").find("git lfs pull"),
            std::string::npos);
  std::string stl(84 + 2 * 50, '\0');
  stl[80] = 2;
  EXPECT_NE(refusal("d.ply", stl).find("STL"), std::string::npos);
  EXPECT_NE(refusal("e.obj", "# nothing\n").find("no vertex"), std::string::npos);
}

TEST(ReadMesh, TurnsAClosedSurfaceThatIsInsideOut) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(write_file(folder / "cube.ply", cube_ply(true)));
  for (int i = 0; i < 8; ++i) {
    EXPECT_LT((mesh.normals[static_cast<std::size_t>(i)] - cube_corner(i).normalized()).norm(),
              1e-6f);
  }
}

TEST(ReadMesh, PlyKeepsHardEdges) {
  const TemporaryFolder folder;
  const Mesh cube = hard_cube();
  write_ply(folder / "cube.ply", cube);
  const Mesh mesh = read_mesh(folder / "cube.ply");
  EXPECT_EQ(mesh.positions, cube.positions);
  EXPECT_EQ(mesh.normals, cube.normals);
  EXPECT_EQ(mesh.triangles, cube.triangles);
}

TEST(ReadMesh, InsideOutHardCubeIsTurnedWithItsNormals) {
  const TemporaryFolder folder;
  const Mesh cube = hard_cube();
  Mesh wrong = cube;
  for (auto& triangle : wrong.triangles) std::swap(triangle[1], triangle[2]);
  for (auto& normal : wrong.normals) normal = -normal;
  write_ply(folder / "cube.ply", wrong);
  const Mesh mesh = read_mesh(folder / "cube.ply");
  EXPECT_EQ(mesh.normals, cube.normals);
  EXPECT_EQ(mesh.triangles, cube.triangles);
}

TEST(WritePly, ConfidenceIsShownFromRedToGreen) {
  const TemporaryFolder folder;
  const Mesh cube = hard_cube();
  std::vector<float> confidence(cube.positions.size(), 0.5F);
  confidence.front() = 0;
  confidence[1] = 1;
  write_ply(folder / "cube.ply", cube, confidence);
  EXPECT_EQ(read_mesh(folder / "cube.ply").positions, cube.positions);
  // A vertex is 6 floats, its confidence and 3 bytes: 31 bytes.
  const std::string bytes = read_file(folder / "cube.ply");
  const std::size_t body = bytes.find("end_header\n") + 11;
  const auto colour = [&](std::size_t vertex) { return bytes.substr(body + 31 * vertex + 28, 3); };
  EXPECT_EQ(colour(0), std::string("\xff\x00\x00", 3));
  EXPECT_EQ(colour(1), std::string("\x00\xff\x00", 3));
  EXPECT_EQ(colour(2), std::string("\xff\xff\x00", 3));
}

TEST(ReadMesh, PlyRoundTripIsExact) {
  const TemporaryFolder folder;
  const Mesh sphere = testing::sphere(12, 17);
  write_ply(folder / "sphere.ply", sphere);
  const Mesh mesh = read_mesh(folder / "sphere.ply");
  EXPECT_EQ(mesh.positions, sphere.positions);
  EXPECT_EQ(mesh.triangles, sphere.triangles);
  // Normals are brought to unit length again: one rounding.
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    EXPECT_LT((mesh.normals[i] - sphere.normals[i]).norm(), 3e-7f);
  }
}

TEST(ReadMesh, ReadsBigEndianDoublesAndForeignProperties) {
  const TemporaryFolder folder;
  std::string bytes =
      "ply\r\nformat binary_big_endian 1.0\r\nelement camera 1\r\nproperty list uint8 short "
      "view\r\nelement vertex 3\r\nproperty uchar red\r\nproperty double x\r\nproperty double "
      "y\r\nproperty double z\r\nelement face 1\r\nproperty ushort flags\r\nproperty list uint "
      "uint16 vertex_index\r\nend_header\r\n";
  const auto append_big = [&bytes](const auto& value) {
    std::string raw;
    append_raw(raw, value);
    std::reverse(raw.begin(), raw.end());
    bytes += raw;
  };
  append_big(std::uint8_t{2});
  append_big(std::int16_t{-1});
  append_big(std::int16_t{5});
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0, 0, 0.5), Eigen::Vector3d(1, 0, 0.5), Eigen::Vector3d(0, -2.25, 0.5)}) {
    append_big(std::uint8_t{200});
    for (const double value : p) append_big(value);
  }
  append_big(std::uint16_t{9});
  append_big(std::uint32_t{3});
  for (int index = 2; index >= 0; --index) append_big(static_cast<std::uint16_t>(index));
  const Mesh mesh = read_mesh(write_file(folder / "big.ply", bytes));
  ASSERT_EQ(mesh.positions.size(), 3u);
  EXPECT_EQ(mesh.positions[2], Eigen::Vector3f(0, -2.25f, 0.5f));
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.triangles[0], (Eigen::Matrix<std::uint32_t, 3, 1>(2, 1, 0)));
  EXPECT_EQ(mesh.normals[0], Eigen::Vector3f(0, 0, 1));
}

TEST(ReadMesh, RepairsNormalsAndKeepsUnusedVertices) {
  const TemporaryFolder folder;
  const std::string bytes =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float "
      "z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face 3\nproperty list "
      "uchar int vertex_indices\nend_header\n"
      "0 0 0 0 0 0\n1 0 0 nan 0 1\n0 1 0 0 3 4\n7 7 7 0 0 0\n2 0 0 inf 0 0\n"
      "3 0 1 2\n3 0 1 1\n3 0 1 4\n";
  const Mesh mesh = read_mesh(write_file(folder / "odd.ply", bytes));
  ASSERT_EQ(mesh.positions.size(), 5u);
  // The second triangle repeats a corner, the third has three corners in line.
  EXPECT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.normals[0], Eigen::Vector3f(0, 0, 1));
  EXPECT_EQ(mesh.normals[1], Eigen::Vector3f(0, 0, 1));
  EXPECT_LT((mesh.normals[2] - Eigen::Vector3f(0, 0.6f, 0.8f)).norm(), 1e-7f);
  EXPECT_EQ(mesh.normals[3], Eigen::Vector3f(0, 0, 1));
  EXPECT_EQ(mesh.normals[4], Eigen::Vector3f(0, 0, 1));
}

TEST(ReadMesh, VerticesWithoutTrianglesCountForNothing) {
  const TemporaryFolder folder;
  // Cleaned scans leave them: one far off, one that is no number, one on the surface.
  const auto path = write_file(
      folder / "stray.ply",
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "9000 0 0\n0 0 0\n1 0 0\n0 1 0\nnan nan nan\n0.2 0.2 0\n3 1 2 3\n");
  std::vector<std::string> notes;
  const Mesh mesh = read_mesh(path, &notes);
  ASSERT_EQ(mesh.positions.size(), 6u);
  EXPECT_EQ(bounds_of(mesh).sizes(), Eigen::Vector3f(1, 1, 0));
  EXPECT_TRUE(mesh.offset.isZero(0));
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(notes[0].starts_with("2 of its vertices")) << notes[0];
}

TEST(ReadMesh, PlyFacesMayComeBeforeTheirVertices) {
  const TemporaryFolder folder;
  const std::string vertex =
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  const std::string begin = "ply\nformat ascii 1.0\n", positions = "0 0 0\n1 0 0\n0 1 0\n";
  const Mesh usual = read_mesh(write_file(
      folder / "usual.ply", begin + vertex + face + "end_header\n" + positions + "3 0 1 2\n"));
  const Mesh turned = read_mesh(write_file(
      folder / "first.ply", begin + face + vertex + "end_header\n3 0 1 2\n" + positions));
  EXPECT_EQ(turned.positions, usual.positions);
  EXPECT_EQ(turned.triangles, usual.triangles);
  EXPECT_NE(refusal(write_file(folder / "none.ply", begin + face + "end_header\n3 0 1 2\n"))
                .find("no element vertex"),
            std::string::npos);
}

TEST(ReadMesh, GlbKeepsVerticesAndAppliesTransforms) {
  const TemporaryFolder folder;
  // Vertex 1 is used by nothing: it moves to the first corner. Vertices 0 and 4 share a position.
  const std::vector<Eigen::Vector3f> positions = {{0, 0, 0}, {9, 9, 9}, {1, 0, 0},
                                                  {0, 1, 0}, {0, 0, 0}, {-1, 0, 0}};
  const std::vector<std::uint32_t> indices = {0, 2, 3, 4, 3, 5};
  const auto path = write_file(
      folder / "part.glb", glb(positions, indices, R"(,"translation":[1,2,3],"scale":[2,1,1])"));
  const Mesh mesh = read_mesh(path);
  ASSERT_EQ(mesh.positions.size(), positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Eigen::Vector3f& p = positions[i == 1 ? indices[0] : i];
    EXPECT_EQ(mesh.positions[i], Eigen::Vector3f(2 * p.x() + 1, p.y() + 2, p.z() + 3));
  }
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[1], (Eigen::Matrix<std::uint32_t, 3, 1>(4, 3, 5)));
  EXPECT_EQ(mesh.normals[0], Eigen::Vector3f(0, 0, 1));
}

TEST(ReadMesh, MirroringNodeTurnsTheWinding) {
  const TemporaryFolder folder;
  const auto path = write_file(folder / "mirror.glb", glb({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                                          {0, 1, 2}, R"(,"scale":[-1,1,1])"));
  // Mirroring x keeps the side z+ outside; the turned winding says the same.
  EXPECT_EQ(read_mesh(path).normals[0], Eigen::Vector3f(0, 0, 1));
}

TEST(ReadMesh, ObjJoinsCornersWhateverTheirTexture) {
  const TemporaryFolder folder;
  // A quad of two triangles, every corner with a texture coordinate of its own, in two groups; one
  // vertex is unused.
  const auto path = write_file(folder / "quad.obj",
                               "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 5 5\nvt 0 0\nvt 1 0\nvt 1 "
                               "1\nvt 0.5 0.5\nvt 0.1 0.2\nvt "
                               "0.3 0.3\ng a\nf 1/1 2/2 3/3\ng b\nf 1/4 3/5 4/6\n");
  const Mesh mesh = read_mesh(path);
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(vertex_neighbours(mesh).indices.size(), 10u);  // 5 edges, both ways
}

TEST(ReadMesh, ObjNormalsMakeHardEdges) {
  const TemporaryFolder folder;
  // Two triangles fold along an edge whose two corners have a normal on either side.
  const auto path = write_file(folder / "fold.obj",
                               "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 0 0 1\nvn 0 0 -1\nvn -1 0 0\n"
                               "f 1//1 2//1 3//1\nf 1//2 4//2 2//2\n");
  EXPECT_EQ(read_mesh(path).positions.size(), 6u);
}

TEST(ReadMesh, ObjBackslashesJoinLinesOfNumbersOnly) {
  const TemporaryFolder folder;
  // Folders of Windows end comments and names with one; the vertex after them is the first all the
  // same. Lines keep their numbers: corner 9 stands in line 8, behind two that are one.
  const std::string text =
      "# from C:\\scans\\\nv 0 0 0\nv 1 \\\n0 0\nv 0 1 0\ng D:\\parts\\\nf 1 2 3\n";
  const Mesh mesh = read_mesh(write_file(folder / "joined.obj", text));
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.positions[mesh.triangles[0][1]], Eigen::Vector3f(1, 0, 0));
  EXPECT_NE(refusal(write_file(folder / "line.obj", text + "f 1 2 9\n")).find("line 8 "),
            std::string::npos);
}

TEST(ReadMesh, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  const std::string corners = "0 0 0\n1 0 0\n0 1 0\n";
  const auto fault_of = [&folder](const std::string& name, const std::string& bytes) {
    return refusal(write_file(folder / name, bytes));
  };
  EXPECT_NE(refusal(folder / "none.ply").find("does not exist"), std::string::npos);
  EXPECT_NE(refusal(folder.path()).find("not a mesh format"), std::string::npos);
  EXPECT_NE(fault_of("mesh.stl", "solid").find("not a mesh format"), std::string::npos);
  for (const char* name : {"empty.ply", "empty.obj", "empty.glb"}) {
    EXPECT_NE(fault_of(name, "").find("is empty"), std::string::npos);
  }
  EXPECT_NE(fault_of("cloud.ply", ascii_ply(corners, 3, "", 0)).find("no triangles"),
            std::string::npos);
  EXPECT_NE(fault_of("flat.ply", ascii_ply(corners, 3, "3 0 1 1\n", 1)).find("no triangles"),
            std::string::npos);
  EXPECT_NE(fault_of("nan.ply", ascii_ply("0 0 0\nnan 0 0\n0 1 0\n", 3, "3 0 1 2\n", 1))
                .find("not a finite number (vertex 1)"),
            std::string::npos);
  EXPECT_NE(fault_of("wide.ply", ascii_ply("0 0 0\n1e99 0 0\n0 1 0\n", 3, "3 0 1 2\n", 1))
                .find("not a finite number"),
            std::string::npos);
  for (const char* face : {"3 0 1 3\n", "3 0 1 -1\n", "3 0 1 1.5\n", "3 0 1 nan\n"}) {
    EXPECT_NE(fault_of("index.ply", ascii_ply(corners, 3, face, 1)).find("does not exist"),
              std::string::npos);
  }
  EXPECT_NE(fault_of("many.ply", ascii_ply(corners, 2'000'000'000, "", 0)).find("shorter"),
            std::string::npos);
  EXPECT_NE(fault_of("word.ply", ascii_ply("0 0 zero\n1 0 0\n0 1 0\n", 3, "3 0 1 2\n", 1))
                .find("not a number"),
            std::string::npos);
  fault_of("garbage.ply", "ply\nformat ascii 1.0\nnonsense\n");
  fault_of("garbage.obj", "\x01\x02\x03 no mesh at all");
  fault_of("garbage.glb", "glTF and then nothing that makes sense");
}

TEST(ReadMesh, RefusesEveryFileCutShort) {
  const TemporaryFolder folder;
  write_ply(folder / "whole.ply", hard_cube());
  const std::string ply = read_file(folder / "whole.ply");
  // A new name every time: file systems flush a file that is cut and written again.
  for (std::size_t size = 1; size < ply.size(); ++size) {
    refusal(write_file(folder / (std::to_string(size) + ".ply"), ply.substr(0, size)));
  }
  const std::string binary = glb({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}, "");
  ASSERT_EQ(read_mesh(write_file(folder / "whole.glb", binary)).triangles.size(), 1u);
  for (std::size_t size = 1; size < binary.size(); ++size) {
    refusal(write_file(folder / (std::to_string(size) + ".glb"), binary.substr(0, size)));
  }
}

TEST(ReadMesh, RefusesGlbNodesThatAreNoTrees) {
  const TemporaryFolder folder;
  const auto with_nodes = [&](const std::string& name, const std::string& nodes) {
    return write_file(folder / name, glb({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}, nodes));
  };
  // Node 0 carries the mesh; the nodes appended are its parents.
  const auto chain = [](int parents) {
    std::string nodes;
    for (int i = 0; i < parents; ++i) nodes += "},{\"children\":[" + std::to_string(i) + "]";
    return nodes;
  };
  // 255 parents and the node itself are 256 levels, the most that are taken.
  EXPECT_EQ(read_mesh(with_nodes("deep.glb", chain(255))).triangles.size(), 1u);
  for (const std::string& nodes :
       {chain(256), chain(100'000), std::string(R"(,"children":[0])"),
        std::string(R"(},{"children":[0,0])"), std::string(R"(},{"children":[0]},{"children":[0])"),
        std::string(R"(},{"children":[7])"), std::string(R"(},{"children":0)")}) {
    EXPECT_NE(refusal(with_nodes("odd.glb", nodes)).find("no trees"), std::string::npos);
  }
}

TEST(WritePly, LeavesTheOldFileWhenTheFolderIsNotWritable) {
  const TemporaryFolder folder;
  write_file(folder / "file", "old");
  EXPECT_THROW(write_ply(folder / "file" / "mesh.ply", hard_cube()), Error);
  EXPECT_EQ(read_file(folder / "file"), "old");
}

TEST(VertexNeighbours, AreTheEdgesOfTheTriangles) {
  const Mesh mesh = testing::sphere(9, 13);
  std::vector<std::set<std::uint32_t>> expected(mesh.positions.size());
  for (const auto& triangle : mesh.triangles) {
    for (int c = 0; c < 3; ++c) {
      expected[triangle[c]].insert({triangle[(c + 1) % 3], triangle[(c + 2) % 3]});
    }
  }
  const VertexNeighbours neighbours = vertex_neighbours(mesh);
  ASSERT_EQ(neighbours.vertex_count(), mesh.positions.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto row = neighbours.of(i);
    EXPECT_TRUE(std::equal(row.begin(), row.end(), expected[i].begin(), expected[i].end())) << i;
  }
  // Euler: V - E + F = 2 on a sphere; every edge is counted from both ends.
  EXPECT_EQ(neighbours.indices.size() / 2, mesh.positions.size() + mesh.triangles.size() - 2);
}

TEST(VertexNeighbours, OfAMeshWithoutTrianglesAreNone) {
  Mesh mesh;
  EXPECT_EQ(vertex_neighbours(mesh).vertex_count(), 0u);
  mesh.positions.assign(3, Eigen::Vector3f::Zero());
  const VertexNeighbours neighbours = vertex_neighbours(mesh);
  EXPECT_EQ(neighbours.vertex_count(), 3u);
  EXPECT_TRUE(neighbours.of(2).empty());
}

struct RealMesh {
  const char* file;
  std::size_t vertices;
  std::size_t triangles;
};

class RealMeshes : public ::testing::TestWithParam<RealMesh> {};

TEST_P(RealMeshes, AreReadWhole) {
  const auto path = std::filesystem::path(SHEEN_SHARED_DATA) / "meshes" / GetParam().file;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const Mesh mesh = read_mesh(path);
  EXPECT_EQ(mesh.positions.size(), GetParam().vertices);
  EXPECT_EQ(mesh.triangles.size(), GetParam().triangles);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (const auto& normal : mesh.normals) EXPECT_NEAR(normal.norm(), 1, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Shared, RealMeshes,
                         ::testing::Values(RealMesh{"bunny.ply", 35947, 69451},
                                           RealMesh{"spot.obj", 2930, 5856},
                                           RealMesh{"igea.ply", 134345, 268686}),
                         [](const auto& instance) {
                           return std::filesystem::path(instance.param.file).stem().string();
                         });

}  // namespace
}  // namespace sheen::core
