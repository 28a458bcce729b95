// SPDX-License-Identifier: MIT
#pragma once

#include "core/files/staged_output.h"
#include "core/mesh/mesh.h"
#include "core/samples/patch_share.h"
#include "core/samples/sample_batch.h"
#include "fitting/option_table.h"

#include <compare>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace sheen::fitting {

/// The frame that a view was. States order their views by this: session, recording, frame.
struct StateView {
  std::string session;          ///< name of its folder
  std::uint64_t recording = 0;  ///< tells recordings of one name apart
  int frame = 0;                ///< its index in the recording
  // NOLINTNEXTLINE(modernize-use-nullptr): sees a null pointer in what the compiler writes
  auto operator<=>(const StateView&) const = default;
};

/// What the views of a state are samples of, and how they are fitted.
struct StateHeader {
  std::string representation;  ///< name of a descriptor
  OptionValues options;
  core::Mesh mesh;           ///< a patch per vertex
  core::PatchShare share{};  ///< whose samples the views hold
};

/// Writes a fit state (docs/states.md): every view's samples, bit for bit, 24 bytes each.
/// They are all that a fit of samples looks at, so views can be joined and left out exactly. It is
/// written beside its final name.
class StateWriter {
 public:
  /// Throws core::Error (bad_input) when the place cannot be written.
  StateWriter(const std::filesystem::path& path, const StateHeader& header);

  /// Throws core::Error (run_failed) when the disk is full.
  void append(const StateView& view, const core::SampleBatch& batch);

  /// Moves the file into place. Throws core::Error (run_failed).
  void commit();

 private:
  void write(const void* bytes, std::size_t count);
  void close_block();

  std::filesystem::path path_;
  core::StagedOutput output_;
  std::ofstream file_;
  std::uint64_t hash_;
  std::uint64_t views_ = 0;
};

/// Whether the file begins as a fit state does.
bool is_state(const std::filesystem::path& path);

/// A fit state on disk; reads one view at a time.
class StateReader {
 public:
  /// Reads all of the file once and checks it. Throws core::Error (bad_input) for files that are
  /// cut short, altered, of a later version or no state.
  explicit StateReader(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const StateHeader& header() const { return header_; }
  [[nodiscard]] const std::vector<StateView>& views() const { return views_; }

  /// Replaces `batch` by the samples of a view, < views().size().
  void read(std::size_t idx, core::SampleBatch& batch);

 private:
  [[noreturn]] void fail(const std::string& fault) const;
  void take(void* bytes, std::size_t count);
  template <typename Value>
  Value take();
  void check_block();
  void read_header();
  void read_mesh(std::size_t vertices, std::size_t triangles);
  void check_mesh() const;
  void check_share() const;
  void read_views();
  void take_samples(std::size_t count, core::SampleBatch& batch);
  void check_samples(const core::SampleBatch& batch) const;

  std::filesystem::path path_;
  std::ifstream file_;
  std::uint64_t left_ = 0;  ///< bytes of the file not yet read
  std::uint64_t hash_;
  StateHeader header_;
  std::vector<StateView> views_;
  struct Place {
    std::uint64_t begin;
    std::uint32_t samples;
  };
  std::vector<Place> places_;
};

}  // namespace sheen::fitting
