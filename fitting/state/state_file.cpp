// SPDX-License-Identifier: MIT
#include "fitting/state/state_file.h"

#include "core/diagnostics/error.h"
#include "core/text/nesting.h"

#include <nlohmann/json.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>

namespace sheen::fitting {
namespace {

static_assert(std::endian::native == std::endian::little, "states are little-endian");

constexpr std::array<char, 8> kMagic{'S', 'H', 'E', 'E', 'N', 'F', 'I', 'T'};
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kViewTag = 0x57454956;  // "VIEW"
constexpr std::uint32_t kEndTag = 0x20444e45;   // "END "
constexpr std::uint32_t kMostHeaderBytes = 1U << 16;
constexpr std::uint32_t kMostNameBytes = 4096;
constexpr std::uint64_t kEmptyHash = 0xcbf29ce484222325U;
constexpr float kDiscEdge = 1.001F;  // with rounding

std::uint64_t hashed(std::uint64_t hash, const void* bytes, std::size_t count) {
  const auto* at = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i < count; ++i) hash = (hash ^ at[i]) * 0x100000001b3U;
  return hash;
}

template <typename Batch, typename Action>
void for_each_state_column(Batch& batch, const Action& action) {
  action(batch.patch);
  for (auto* column : {&batch.u, &batch.v, &batch.r, &batch.g, &batch.b}) action(*column);
}

std::string header_text(const StateHeader& header) {
  const core::Mesh& mesh = header.mesh;
  return nlohmann::ordered_json{{"representation", header.representation},
                                {"options", header.options},
                                {"vertices", mesh.positions.size()},
                                {"triangles", mesh.triangles.size()},
                                {"offset", {mesh.offset.x(), mesh.offset.y(), mesh.offset.z()}},
                                {"share", {header.share.number, header.share.of}}}
      .dump();
}

}  // namespace

StateWriter::StateWriter(const std::filesystem::path& path, const StateHeader& header)
    : path_(path), output_(path), file_(output_.path(), std::ios::binary), hash_(kEmptyHash) {
  const std::string text = header_text(header);
  const auto length = static_cast<std::uint32_t>(text.size());
  write(kMagic.data(), kMagic.size());
  write(&kVersion, sizeof kVersion);
  write(&length, sizeof length);
  write(text.data(), text.size());
  const core::Mesh& mesh = header.mesh;
  write(mesh.positions.data(), mesh.positions.size() * sizeof mesh.positions[0]);
  write(mesh.normals.data(), mesh.normals.size() * sizeof mesh.normals[0]);
  write(mesh.triangles.data(), mesh.triangles.size() * sizeof mesh.triangles[0]);
  close_block();
}

void StateWriter::append(const StateView& view, const core::SampleBatch& batch) {
  const auto name_bytes = static_cast<std::uint32_t>(view.session.size());
  const auto samples = static_cast<std::uint32_t>(batch.size());
  const auto frame = static_cast<std::int32_t>(view.frame);
  write(&kViewTag, sizeof kViewTag);
  write(&name_bytes, sizeof name_bytes);
  write(&view.recording, sizeof view.recording);
  write(&frame, sizeof frame);
  write(&samples, sizeof samples);
  write(view.session.data(), name_bytes);
  for_each_state_column(batch, [this](const auto& column) {
    write(column.data(), column.size() * sizeof(column[0]));
  });
  close_block();
  ++views_;
}

void StateWriter::commit() {
  write(&kEndTag, sizeof kEndTag);
  write(&views_, sizeof views_);
  close_block();
  file_.close();
  if (!file_) {
    throw core::Error(core::Error::Kind::run_failed, path_, "cannot be written",
                      "check free space and permissions");
  }
  output_.commit();
}

void StateWriter::write(const void* bytes, std::size_t count) {
  if (count == 0) return;  // the data of an empty column may be a null pointer
  hash_ = hashed(hash_, bytes, count);
  file_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count));
  if (!file_) {
    throw core::Error(core::Error::Kind::run_failed, path_, "cannot be written",
                      "check free space and permissions");
  }
}

void StateWriter::close_block() {
  const std::uint64_t hash = hash_;
  write(&hash, sizeof hash);
  hash_ = kEmptyHash;
}

bool is_state(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 8> magic{};
  return file.read(magic.data(), magic.size()) && magic == kMagic;
}

StateReader::StateReader(const std::filesystem::path& path)
    : path_(path), file_(path, std::ios::binary), hash_(kEmptyHash) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure) || !file_) {
    throw core::bad_input(path, "is no file that can be read", "give what replay --state wrote");
  }
  left_ = std::filesystem::file_size(path, failure);
  read_header();
  read_views();
}

void StateReader::fail(const std::string& fault) const {
  throw core::bad_input(path_, fault, "fit its sessions again with replay --state");
}

void StateReader::take(void* bytes, std::size_t count) {
  if (count == 0) return;
  if (count > left_ ||
      !file_.read(static_cast<char*>(bytes), static_cast<std::streamsize>(count))) {
    fail("is cut short");
  }
  left_ -= count;
  hash_ = hashed(hash_, bytes, count);
}

template <typename Value>
Value StateReader::take() {
  Value value;
  take(&value, sizeof value);
  return value;
}

void StateReader::check_block() {
  const std::uint64_t expected = hash_;
  [[maybe_unused]] const bool fits = take<std::uint64_t>() == expected;
#ifndef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION  // altered files must reach what lies behind
  if (!fits) fail("was altered: a checksum does not fit");
#endif
  hash_ = kEmptyHash;
}

void StateReader::read_header() {
  if (take<std::array<char, 8>>() != kMagic) fail("is no fit state");
  const auto version = take<std::uint32_t>();
  if (version != kVersion) {
    fail("has version " + std::to_string(version) + ", this program reads version 1");
  }
  const auto length = take<std::uint32_t>();
  if (length > kMostHeaderBytes) fail("was altered: its header has no length");
  std::string text(length, '\0');
  take(text.data(), text.size());
  try {
    if (core::json_depth(text) > core::kMostNesting) fail("was altered: its header nests too deep");
    const auto header = nlohmann::json::parse(text);
    header_.representation = header.at("representation").get<std::string>();
    header_.options = header.at("options").get<OptionValues>();
    for (int i = 0; i < 3; ++i) {
      header_.mesh.offset[i] = header.at("offset").at(static_cast<std::size_t>(i)).get<double>();
    }
    if (const auto share = header.find("share"); share != header.end()) {  // else all patches
      header_.share = {share->at(0).get<std::uint32_t>(), share->at(1).get<std::uint32_t>()};
    }
    read_mesh(header.at("vertices").get<std::size_t>(), header.at("triangles").get<std::size_t>());
  } catch (const nlohmann::json::exception&) {
    fail("was altered: its header cannot be read");
  }
}

void StateReader::read_mesh(std::size_t vertices, std::size_t triangles) {
  // Before anything is allocated: the file must hold as much.
  constexpr std::size_t bytes_each = 12;
  if (vertices > left_ / (2 * bytes_each) || triangles > left_ / bytes_each) fail("is cut short");
  core::Mesh& mesh = header_.mesh;
  mesh.positions.resize(vertices);
  mesh.normals.resize(vertices);
  mesh.triangles.resize(triangles);
  take(mesh.positions.data(), vertices * bytes_each);
  take(mesh.normals.data(), vertices * bytes_each);
  take(mesh.triangles.data(), triangles * bytes_each);
  check_block();
  check_mesh();
  check_share();
}

void StateReader::check_mesh() const {
  const core::Mesh& mesh = header_.mesh;
  bool good = mesh.offset.allFinite() && !mesh.positions.empty();
  for (const auto& position : mesh.positions) good = good && position.allFinite();
  for (const auto& normal : mesh.normals) {
    good = good && std::abs(normal.squaredNorm() - 1) < 1e-3F;
  }
  for (const auto& triangle : mesh.triangles)
    good = good && triangle.maxCoeff() < mesh.positions.size();
  if (!good) fail("holds no usable mesh");
}

void StateReader::check_share() const {
  const core::PatchShare& share = header_.share;
  if (share.number < 1 || share.number > share.of || share.of > header_.mesh.positions.size()) {
    fail("was altered: its share of the patches cannot be");
  }
}

void StateReader::read_views() {
  core::SampleBatch batch;
  for (;;) {
    const auto tag = take<std::uint32_t>();
    if (tag == kEndTag) break;
    if (tag != kViewTag) fail("was altered: a view does not begin where it should");
    const auto name_bytes = take<std::uint32_t>();
    StateView view;
    view.recording = take<std::uint64_t>();
    view.frame = take<std::int32_t>();
    const auto samples = take<std::uint32_t>();
    if (name_bytes > kMostNameBytes || samples > header_.mesh.positions.size() || view.frame < 0) {
      fail("was altered: a view cannot be so large");
    }
    view.session.resize(name_bytes);
    take(view.session.data(), name_bytes);
    places_.push_back({static_cast<std::uint64_t>(file_.tellg()), samples});
    take_samples(samples, batch);
    check_block();
    check_samples(batch);
    if (!views_.empty() && !(views_.back() < view)) fail("was altered: its views are out of order");
    views_.push_back(std::move(view));
  }
  if (take<std::uint64_t>() != views_.size()) fail("was altered: views are missing");
  check_block();
  if (left_ != 0) fail("was altered: something follows its end");
}

void StateReader::take_samples(std::size_t count, core::SampleBatch& batch) {
  for_each_state_column(batch, [this, count](auto& column) {
    column.resize(count);
    take(column.data(), count * sizeof(column[0]));
  });
}

void StateReader::check_samples(const core::SampleBatch& batch) const {
  const std::size_t first = header_.share.first(header_.mesh.positions.size());
  const std::size_t end = header_.share.end(header_.mesh.positions.size());
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const bool ascends = i == 0 || batch.patch[i - 1] < batch.patch[i];
    const bool is_direction =
        std::abs(batch.u[i]) <= kDiscEdge && std::abs(batch.v[i]) <= kDiscEdge;
    const bool is_colour =
        std::isfinite(batch.r[i]) && std::isfinite(batch.g[i]) && std::isfinite(batch.b[i]);
    if (!ascends || !is_direction || !is_colour || batch.patch[i] < first ||
        batch.patch[i] >= end) {
      fail("was altered: samples that cannot be");
    }
  }
}

void StateReader::read(std::size_t idx, core::SampleBatch& batch) {
  const Place& place = places_.at(idx);
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(place.begin));
  left_ = place.samples * std::uint64_t{24};
  take_samples(place.samples, batch);
}

}  // namespace sheen::fitting
