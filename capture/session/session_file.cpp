// SPDX-License-Identifier: MIT
#include "capture/session/session_file.h"

#include "capture/files/text_file.h"
#include "core/diagnostics/error.h"
#include "core/files/write_file.h"

#include <nlohmann/json.hpp>

#include <system_error>

namespace sheen::capture {
namespace {

using nlohmann::ordered_json;

ordered_json transform_json(const Eigen::Isometry3d& transform) {
  auto numbers = ordered_json::array();
  for (Eigen::Index i = 0; i < 16; ++i) numbers.push_back(transform.matrix()(i / 4, i % 4));
  return numbers;
}

template <typename Value>
void put(ordered_json& object, const char* key, const std::optional<Value>& value) {
  if (value) object[key] = *value;
}

void write_json(const std::filesystem::path& path, const ordered_json& document) {
  core::write_file(path,
                   document.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace

void copy_into_session(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code fault;
  std::filesystem::copy_file(from, to, fault);
  if (fault) {
    throw core::bad_input(from, "cannot be copied into the session: " + fault.message(),
                          "check the file and the free space");
  }
}

void write_session_file(const std::filesystem::path& folder, const SessionFile& session) {
  ordered_json frames;
  put(frames, "video", session.video);
  put(frames, "images", session.images);
  put(frames, "fps", session.fps);
  put(frames, "stamps", session.stamps);
  ordered_json document{{"format", "sheen-session"}, {"version", 1}, {"frames", std::move(frames)}};
  if (session.depth) {
    document["depth"] = {{"images", session.depth->pattern}, {"unit_m", session.depth->unit_m}};
  }
  if (!session.camera.empty()) document["camera"] = session.camera;
  put(document, "board", session.board);
  put(document, "poses", session.poses);
  if (!session.mesh.empty()) {
    document["object"] = {{"mesh", session.mesh},
                          {"T_stage_object", transform_json(session.board_from_object)}};
  }
  write_json(folder / "session.json", document);
}

void write_camera_and_board(const std::filesystem::path& session_file,
                            const std::optional<std::string>& camera,
                            const std::optional<std::string>& board) {
  auto session =
      ordered_json::parse(read_text_file(session_file, kMaxSessionBytes), nullptr, false);
  if (!session.is_object()) {
    throw core::bad_input(session_file, "is no JSON object", "see docs/session-format.md");
  }
  put(session, "camera", camera);
  put(session, "board", board);
  write_json(session_file, session);
}

void write_object(const std::filesystem::path& from, const std::filesystem::path& to,
                  const std::string& mesh) {
  auto session = ordered_json::parse(read_text_file(from, kMaxSessionBytes), nullptr, false);
  if (!session.is_object()) {
    throw core::bad_input(from, "is no JSON object", "see docs/session-format.md");
  }
  session["object"] = {{"mesh", mesh},
                       {"T_stage_object", transform_json(Eigen::Isometry3d::Identity())}};
  write_json(to, session);
}

void write_board_from_object(const std::filesystem::path& from, const std::filesystem::path& to,
                             const Eigen::Isometry3d& board_from_object) {
  auto session = ordered_json::parse(read_text_file(from, kMaxSessionBytes), nullptr, false);
  if (!session.is_object() || !session.contains("object") || !session["object"].is_object()) {
    throw core::bad_input(from, "holds no \"object\"", "see docs/session-format.md");
  }
  session["object"]["T_stage_object"] = transform_json(board_from_object);
  write_json(to, session);
}

}  // namespace sheen::capture
