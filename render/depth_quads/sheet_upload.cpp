// SPDX-License-Identifier: MIT
#include "render/depth_quads/sheet_upload.h"

#include "core/diagnostics/error.h"
#include "render/depth_quads/screen_quads.h"

#include <algorithm>
#include <array>
#include <string>

namespace sheen::render {
namespace {

/// As quads.vert has its attributes.
struct CellRecord {
  std::array<float, 4> middle_along, down_depth_certainty;
  std::array<float, 2> first_px;
};
static_assert(sizeof(CellRecord) == SheetUpload::kBytesPerCell);

CellRecord record_of(const CellQuad& cell) {
  const auto single = [](double value) { return static_cast<float>(value); };
  return {{single(cell.middle.x()), single(cell.middle.y()), single(cell.along.x()),
           single(cell.along.y())},
          {single(cell.down.x()), single(cell.down.y()), cell.depth_m, cell.certainty},
          {cell.first_x, cell.first_y}};
}

gl::Texture texture_of(const gl::Functions& gl, const cv::Mat& pixels) {
  const int limit = gl::integer_limit(gl, GL_MAX_TEXTURE_SIZE);
  if (pixels.cols > limit || pixels.rows > limit) {
    throw core::Error(core::Error::Kind::run_failed,
                      "a photograph of " + std::to_string(pixels.cols) + " x " +
                          std::to_string(pixels.rows) + " pixels",
                      "is larger than this OpenGL driver holds", "use smaller images");
  }
  gl::Texture texture = gl::make_texture(gl, GL_TEXTURE_2D);
  gl.TextureStorage2D(texture.name(), 1, GL_RGBA8, pixels.cols, pixels.rows);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.TextureSubImage2D(texture.name(), 0, 0, 0, pixels.cols, pixels.rows, GL_BGR, GL_UNSIGNED_BYTE,
                       pixels.data);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  return texture;
}

}  // namespace

SheetUpload::SheetUpload(const gl::Functions& gl, const fitting::KeptView& photograph,
                         const fitting::depth_quads::QuadView& quads, double enlargement_px,
                         const RayGrid& rays) {
  const cv::Mat pixels = photograph.pixels();
  photograph_ = texture_of(gl, pixels);
  byte_size_ = 4 * pixels.total();
  for (std::size_t l = 0; l < quads.levels.size(); ++l) {
    const auto nodes = node_rays(photograph, quads.levels[l], rays);
    std::vector<CellRecord> records;
    for (const CellQuad& cell : cell_quads(photograph, quads, l, nodes, enlargement_px)) {
      records.push_back(record_of(cell));
    }
    const auto count = static_cast<GLsizei>(records.size());
    if (records.empty()) records.emplace_back();  // so that there is a buffer
    const std::size_t bytes = records.size() * sizeof(CellRecord);
    levels_.push_back({gl::make_buffer(gl, static_cast<GLsizeiptr>(bytes), records.data()), count});
    byte_size_ += bytes;
  }
}

}  // namespace sheen::render
