// SPDX-License-Identifier: MIT
#include "capture/session/new_session.h"

#include "capture/calibration/calibration_images.h"
#include "capture/session/session_file.h"
#include "capture/source/still_reader.h"
#include "capture/source/video_source.h"
#include "core/diagnostics/error.h"
#include "core/files/staged_output.h"
#include "core/text/lower_case.h"

#include <fmt/format.h>

#include <vector>

namespace sheen::capture {
namespace {

namespace fs = std::filesystem;

void link_or_copy(const fs::path& from, const fs::path& to) {
  std::error_code fault;
  fs::create_hard_link(fs::canonical(from, fault), to, fault);
  if (fault) copy_into_session(from, to);
}

std::string ending_of(const fs::path& file) {
  return core::lower_case(file.extension().string());
}

// Both look into the source first: later its faults would be told of a copy that does not stay.
SessionFile put_video(const fs::path& video, const fs::path& folder) {
  if (is_picture_name(video)) {
    throw core::bad_input(video, "is one picture", "name the folder with all pictures, or a video");
  }
  static_cast<void>(stored_video_size(video));
  const std::string name = "frames" + ending_of(video);
  link_or_copy(video, folder / name);
  return {.video = name};
}

SessionFile put_pictures(const fs::path& pictures, const fs::path& folder) {
  const std::vector<fs::path> files = pictures_in(pictures);
  static_cast<void>(StillReader().read(files.front(), std::nullopt));
  const std::string ending = ending_of(files.front());
  fs::create_directories(folder / "images");
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (ending_of(files[i]) != ending) {
      throw core::bad_input(files[i], "has another ending than the other pictures",
                            "leave it out or convert all pictures to one format");
    }
    link_or_copy(files[i], folder / "images" / fmt::format("{:06d}{}", i, ending));
  }
  return {.images = "images/%06d" + ending};
}

}  // namespace

void write_new_session(const fs::path& source, const fs::path& folder) {
  std::error_code no_throw;
  if (fs::exists(folder, no_throw)) {
    throw core::bad_input(folder, "exists already",
                          "choose another name, or replay that session to go on with it");
  }
  const bool is_video = fs::is_regular_file(source, no_throw);
  if (!is_video && !fs::is_directory(source, no_throw)) {
    throw core::bad_input(source, "there is no such session, video or folder of pictures",
                          "check the path");
  }
  core::StagedOutput staged(folder);
  fs::create_directories(staged.path());
  SessionFile session =
      is_video ? put_video(source, staged.path()) : put_pictures(source, staged.path());
  session.camera.clear();
  session.mesh.clear();
  write_session_file(staged.path(), session);
  staged.commit();
}

}  // namespace sheen::capture
