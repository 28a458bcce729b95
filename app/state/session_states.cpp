// SPDX-License-Identifier: MIT
#include "app/state/session_states.h"

#include "core/diagnostics/error.h"
#include "fitting/descriptor.h"
#include "fitting/patch_fitter.h"

#include <algorithm>
#include <string>
#include <vector>

namespace sheen::app {
namespace {

namespace fs = std::filesystem;

/// FNV-1a over names and sizes of the files with the frames: two recordings under one name differ
/// in them.
std::uint64_t recording_of(const capture::Session& session) {
  std::vector<fs::path> files;
  std::error_code failure;
  if (session.video) {
    files.push_back(*session.video);
  } else if (session.image_pattern) {
    const fs::path pattern = session.folder / *session.image_pattern;
    for (const auto& entry : fs::directory_iterator(pattern.parent_path(), failure)) {
      if (entry.is_regular_file(failure)) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const fs::path& file : files) {
    const std::string text =
        file.filename().string() + ' ' + std::to_string(fs::file_size(file, failure)) + '\n';
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  }
  return hash;
}

std::string name_of(const fs::path& folder) {
  std::error_code failure;
  const fs::path whole = fs::weakly_canonical(folder, failure);
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

}  // namespace

SessionState::SessionState(const capture::Session& session)
    : view_{name_of(session.folder), recording_of(session), 0} {}

pipeline::SamplesListener SessionState::listener() {
  return [this](int frame_index, const core::SampleBatch& samples) {
    if (!writer_) return;
    view_.frame = frame_index;
    writer_->append(view_, samples);
  };
}

void SessionState::open(const fs::path& path, const fitting::StateHeader& header) {
  const auto fitter = fitting::make_fitter(header.representation, header.mesh, header.options);
  if (dynamic_cast<const fitting::PatchFitter*>(fitter.get()) == nullptr) {
    throw core::bad_input(path,
                          "cannot be written: " + header.representation +
                              " is fitted to images, a state holds samples",
                          "leave --state out, or use --patches vertex or another representation");
  }
  writer_.emplace(path, header);
}

void SessionState::commit() {
  if (writer_) writer_->commit();
}

}  // namespace sheen::app
