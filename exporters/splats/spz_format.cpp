// SPDX-License-Identifier: MIT
#include "exporters/splats/spz_format.h"

#include "core/diagnostics/error.h"
#include "core/files/write_file.h"
#include "exporters/splats/splats.h"
#include "exporters/upright.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace sheen::exporters {
namespace {

constexpr std::string_view kSpzEndings[] = {".spz"};

constexpr float kLargestByte = 255.0f;
constexpr float kColourScale = 0.15f;  // the format's: f_dc of +-3.3 fill a byte
constexpr int kMostFractionBits = 20;

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(std::round(value), 0.0f, kLargestByte));
}

template <typename Value>
void append_bytes_of(std::string& bytes, Value value) {
  for (std::size_t byte = 0; byte < sizeof value; ++byte) {
    bytes += static_cast<char>(value >> (8 * byte));
  }
}

/// Numbers as the file holds them; `splat` becomes what a reader makes of them.
struct PackedSplat {
  std::array<std::int32_t, 3> position{};
  std::uint8_t opacity = 0;
  std::array<std::uint8_t, 3> colour{}, sigma{}, rotation{};
  std::array<std::uint8_t, 45> harmonics{};  ///< [term][channel]
};

PackedSplat packed(Splat& splat, int fraction_bits) {
  PackedSplat bytes;
  const float step = std::ldexp(1.0f, -fraction_bits);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    bytes.position[i] = static_cast<std::int32_t>(std::lround(splat.position[axis] / step));
    splat.position[axis] = static_cast<float>(bytes.position[i]) * step;
    bytes.sigma[i] = to_byte((std::log(splat.sigma[axis]) + 10.0f) * 16.0f);
    splat.sigma[axis] = std::exp(static_cast<float>(bytes.sigma[i]) / 16.0f - 10.0f);
    const float scale = kColourScale * kLargestByte;
    bytes.colour[i] = to_byte(splat.harmonics[0][axis] * scale + 0.5f * kLargestByte);
    splat.harmonics[0][axis] = (static_cast<float>(bytes.colour[i]) - 0.5f * kLargestByte) / scale;
    for (std::size_t term = 1; term < 16; ++term) {
      std::uint8_t& byte = bytes.harmonics[3 * (term - 1) + i];
      byte = to_byte(splat.harmonics[term][axis] * 128.0f + 128.0f);
      splat.harmonics[term][axis] = (static_cast<float>(byte) - 128.0f) / 128.0f;
    }
  }
  bytes.opacity = to_byte(splat.opacity * kLargestByte);
  splat.opacity = static_cast<float>(bytes.opacity) / kLargestByte;
  // x, y and z of the quaternion whose w is not negative.
  const Eigen::Vector4f q = (splat.rotation.w() < 0 ? -1.0f : 1.0f) * splat.rotation.coeffs();
  Eigen::Vector3f read;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    bytes.rotation[i] = to_byte(q[axis] * 127.5f + 127.5f);
    read[axis] = static_cast<float>(bytes.rotation[i]) / 127.5f - 1.0f;
  }
  splat.rotation.vec() = read;
  splat.rotation.w() = std::sqrt(std::max(0.0f, 1.0f - read.squaredNorm()));
  splat.rotation.normalize();
  return bytes;
}

/// Bits behind the point: as many as leave room for the farthest splat in 24 bits.
int fraction_bits_for(const Splats& splats) {
  float farthest = 0;
  for (const Splat& splat : splats.splats) {
    farthest = std::max(farthest, splat.position.cwiseAbs().maxCoeff());
  }
  int bits = kMostFractionBits;
  while (bits > 0 && std::ldexp(farthest, bits) >= 8388607.0f) --bits;
  return bits;
}

std::string gzipped(const std::string& bytes) {
  constexpr int gzip = 15 + 16;  // zlib's code for a window of 32 KB and gzip's header
  z_stream stream{};
  std::string result;
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, gzip, 9, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::bad_alloc();
  }
  result.resize(deflateBound(&stream, bytes.size()));
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  deflate(&stream, Z_FINISH);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  return result;
}

/// `splats` become what a reader makes of the file.
std::string spz_bytes(Splats& splats) {
  constexpr std::uint32_t magic = 0x5053474e;
  constexpr std::uint32_t version = 2;
  const int bits = fraction_bits_for(splats);
  std::string bytes;
  append_bytes_of(bytes, magic);
  append_bytes_of(bytes, version);
  append_bytes_of(bytes, static_cast<std::uint32_t>(splats.splats.size()));
  bytes += '\x03';  // degree of the harmonics
  bytes += static_cast<char>(bits);
  bytes += std::string(2, '\0');  // flags, reserved
  std::string positions;
  std::string opacities;
  std::string colours;
  std::string sigmas;
  std::string rotations;
  std::string harmonics;
  const auto append_all = [](std::string& to, const auto& values) {
    to.append(reinterpret_cast<const char*>(values.data()), values.size());
  };
  for (Splat& splat : splats.splats) {
    const PackedSplat p = packed(splat, bits);
    for (const std::int32_t number : p.position) {
      const auto low = static_cast<std::uint32_t>(number);
      for (int byte = 0; byte < 3; ++byte) positions += static_cast<char>(low >> (8 * byte));
    }
    opacities += static_cast<char>(p.opacity);
    append_all(colours, p.colour);
    append_all(sigmas, p.sigma);
    append_all(rotations, p.rotation);
    append_all(harmonics, p.harmonics);
  }
  return gzipped(bytes + positions + opacities + colours + sigmas + rotations + harmonics);
}

Written write_spz(const fitting::Model& model, const std::filesystem::path& path,
                  const fitting::FitOptions& options) {
  const Eigen::Matrix3f y_up = y_up_from_object(fitting::options_as<UprightOptions>(options).up);
  Splats splats = make_splats(model, y_up);
  constexpr std::size_t most = 10'000'000;  // readers refuse more
  if (splats.splats.size() > most) {
    throw core::bad_input(path, "cannot hold more than 10 million splats", "write .splat.ply");
  }
  core::write_file(path, spz_bytes(splats));
  return {.files = {path},
          .as_read = splat_model(model, splats, y_up),
          .remarks = splat_remarks(model)};
}

}  // namespace

constinit const Format kSpzFormat{.name = "compressed splats",
                                  .endings = kSpzEndings,
                                  .sentence = "the same in a tenth of the bytes",
                                  .default_options = fitting::new_options<UprightOptions>,
                                  .write = write_spz};

}  // namespace sheen::exporters
