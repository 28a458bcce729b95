// SPDX-License-Identifier: MIT
#include "capture/session/session.h"

#include "capture/calibration/calibration_target.h"
#include "capture/calibration/camera_file.h"
#include "capture/files/text_file.h"
#include "capture/plausibility/camera_check.h"
#include "capture/session/frame_stamps.h"
#include "capture/session/new_session.h"
#include "capture/session/session_file.h"
#include "capture/source/image_check.h"
#include "capture/source/image_folder_source.h"
#include "capture/source/still_reader.h"
#include "capture/source/video_source.h"
#include "core/diagnostics/error.h"
#include "core/text/lower_case.h"
#include "core/text/nesting.h"
#include "core/text/number.h"

#include <Eigen/SVD>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace sheen::capture {
namespace {

using nlohmann::json;

constexpr const char* kRemedy = "see docs/session-format.md";

/// What a folder holds under this name in other letters, as systems that tell no case write it.
std::optional<std::string> same_name_in_other_case(const std::filesystem::path& path) {
  const std::string wanted = core::lower_case(path.filename().string());
  std::error_code fault;
  for (std::filesystem::directory_iterator entry(path.parent_path(), fault), last;
       !fault && entry != last; entry.increment(fault)) {
    std::string name = entry->path().filename().string();
    if (core::lower_case(name) == wanted) return name;
  }
  return std::nullopt;
}

/// session.json with errors that name the file and warnings for what is not understood.
class SessionReader {
 public:
  explicit SessionReader(const std::filesystem::path& folder)
      : folder_(folder), path_(folder / "session.json") {
    const std::string text = read_text_file(path_, kMaxSessionBytes);
    if (core::json_depth(text) > core::kMostNesting) this->fail("nests too deep");
    if (text.find_first_not_of(" \t\n") == std::string::npos) fail("is empty");
    try {
      root_ = json::parse(text, refuse_second_keys());
    } catch (const json::out_of_range&) {
      fail("holds a number that is too large for any computer");
    } catch (const json::parse_error& fault) {
      const auto before = static_cast<std::ptrdiff_t>(std::min(fault.byte, text.size()));
      const auto line = 1 + std::count(text.begin(), text.begin() + before, '\n');
      this->fail("is no valid JSON (line " + std::to_string(line) + ")",
                 "check commas, quotes and brackets there; JSON has no comments");
    }
    if (!root_.is_object()) fail("is no JSON object");
  }

  [[noreturn]] void fail(const std::string& fault, const std::string& remedy = kRemedy) const {
    throw core::bad_input(path_, fault, remedy);
  }

  /// Of two equal keys the last one would win without a word.
  [[nodiscard]] json::parser_callback_t refuse_second_keys() const {
    return [this, keys = std::vector<std::set<std::string>>()](
               int /*depth*/, json::parse_event_t event, json& parsed) mutable {
      if (event == json::parse_event_t::object_start) keys.emplace_back();
      if (event == json::parse_event_t::object_end) keys.pop_back();
      if (event == json::parse_event_t::key && !keys.back().insert(parsed.dump()).second) {
        fail("holds the key " + core::quotable(parsed.dump()) + " twice", "keep one of them");
      }
      return true;
    };
  }

  [[nodiscard]] const json& root() const { return root_; }

  [[nodiscard]] const json& object(const char* key) const {
    const auto found = root_.find(key);
    if (found == root_.end() || !found->is_object())
      fail("\"" + std::string(key) + "\" is missing");
    return *found;
  }

  [[nodiscard]] std::optional<std::string> text(const json& parent, const char* key) const {
    const auto found = parent.find(key);
    if (found == parent.end()) return std::nullopt;
    if (!found->is_string() || found->get_ref<const std::string&>().empty()) {
      fail("\"" + std::string(key) + "\" is no text");
    }
    return found->get<std::string>();
  }

  /// A path, after the check that it stays within the folder. Windows separates by backslashes,
  /// which elsewhere may stand in names.
  [[nodiscard]] std::optional<std::string> inner_path(const json& parent, const char* key) const {
    auto written = text(parent, key);
    if (!written) return std::nullopt;
    std::error_code no_throw;
    if (!std::filesystem::exists(folder_ / *written, no_throw)) {
      std::replace(written->begin(), written->end(), '\\', '/');
    }
    const std::filesystem::path relative(*written);
    const auto normal = relative.lexically_normal();
    if (relative.is_absolute() || normal.begin() == normal.end() || *normal.begin() == ".." ||
        written->find('\0') != std::string::npos) {
      fail("\"" + std::string(key) + "\" leaves the session folder",
           "use a path relative to and within the folder");
    }
    return written;
  }

  [[nodiscard]] std::optional<std::filesystem::path> inner_file(const json& parent,
                                                                const char* key) const {
    const auto written = inner_path(parent, key);
    if (!written) return std::nullopt;
    const auto path = folder_ / *written;
    std::error_code no_throw;
    if (!std::filesystem::is_regular_file(path, no_throw)) {
      const auto other = same_name_in_other_case(path);
      throw core::bad_input(
          path, "there is no such file, though session.json names it",
          other ? "the folder holds " + *other + ": small and capital letters differ"
                : "add it or correct session.json");
    }
    return path;
  }

  void warn_unknown(const json& parent, const std::set<std::string>& known,
                    const std::string& where) {
    for (const auto& [key, value] : parent.items()) {
      if (known.contains(key)) continue;
      warnings.push_back(path_.string() + ": unknown key " +
                         json(where + key).dump(-1, ' ', true, json::error_handler_t::replace) +
                         " is ignored");
    }
  }

  std::vector<std::string> warnings;

 private:
  std::filesystem::path folder_, path_;
  json root_;
};

void check_format(const SessionReader& reader) {
  if (reader.text(reader.root(), "format") != "sheen-session") {
    reader.fail("\"format\" is not \"sheen-session\"");
  }
  const auto version = reader.root().find("version");
  if (version == reader.root().end() || !version->is_number())
    reader.fail("\"version\" is missing");
  const double number = version->get<double>();
  if (!(number >= 1)) reader.fail("\"version\" is not 1");
  if (number >= 2) {
    reader.fail("has version " + version->dump() + ", this program reads version 1",
                "use a newer sheen");
  }
}

void read_frames(SessionReader& reader, Session& session) {
  const json& frames = reader.object("frames");
  reader.warn_unknown(frames, {"video", "images", "fps", "stamps"}, "frames.");
  if (frames.contains("video") == frames.contains("images")) {
    reader.fail("\"frames\" must hold exactly one of \"video\" and \"images\"");
  }
  session.video = reader.inner_file(frames, "video");
  session.stamps = reader.inner_file(frames, "stamps");
  session.image_pattern = reader.inner_path(frames, "images");
  if (session.image_pattern && !NumberedName::parse(*session.image_pattern)) {
    reader.fail("\"images\" is no pattern with one number", "write it like images/%04d.png");
  }
  if (const auto fps = frames.find("fps"); fps != frames.end()) {
    session.fps = fps->is_number() ? fps->get<double>() : 0;
    if (!std::isfinite(*session.fps) || !(*session.fps > 0) || *session.fps > 1e5) {
      reader.fail("\"fps\" is no positive number");
    }
  }
}

std::optional<DepthFiles> read_depth(SessionReader& reader) {
  if (!reader.root().contains("depth")) return std::nullopt;
  const json& depth = reader.object("depth");
  reader.warn_unknown(depth, {"images", "unit_m"}, "depth.");
  const auto pattern = reader.inner_path(depth, "images");
  if (!pattern || !NumberedName::parse(*pattern)) {
    reader.fail("\"depth\" names no \"images\" by a pattern with one number",
                "write it like depth/%04d.png");
  }
  DepthFiles files{*pattern};
  const auto unit = depth.find("unit_m");
  if (unit == depth.end()) {
    reader.fail("\"depth\" does not say its \"unit_m\"",
                "give the metres of a step of the numbers: 0.001 for millimetres");
  }
  files.unit_m = unit->is_number() ? unit->get<double>() : 0;
  if (!(files.unit_m > 0 && files.unit_m <= 1)) {
    reader.fail("\"unit_m\" of \"depth\" is not above 0 and at most 1",
                "give the metres of a step of the numbers: 0.001 for millimetres");
  }
  return files;
}

/// What a matrix close to a multiple of a rotation or reflection is; empty for a rotation.
std::string describe_fault(const Eigen::Matrix3d& A) {
  constexpr double tolerance = 1e-3;
  const double scale = std::cbrt(std::abs(A.determinant()));
  const Eigen::Matrix3d gram = A.transpose() * A;
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  if (!(scale > 0) || !((gram / (scale * scale) - identity).cwiseAbs().maxCoeff() < tolerance)) {
    return "shears or stretches unevenly";
  }
  if (A.determinant() < 0) return "mirrors";
  if (!((gram - identity).cwiseAbs().maxCoeff() < tolerance)) {
    return "scales by " + std::to_string(scale);
  }
  return {};
}

Eigen::Isometry3d read_transform(const SessionReader& reader, const json& object) {
  const auto found = object.find("T_stage_object");
  if (found == object.end() || !found->is_array() || found->size() != 16) {
    reader.fail("\"T_stage_object\" is no list of 16 numbers");
  }
  Eigen::Matrix4d T;
  for (Eigen::Index i = 0; i < 16; ++i) {
    const json& entry = (*found)[static_cast<std::size_t>(i)];
    T(i / 4, i % 4) = entry.is_number() ? entry.get<double>() : std::nan("");
  }
  if (!T.allFinite()) reader.fail("\"T_stage_object\" holds something that is no finite number");
  if ((T.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > 1e-9) {
    reader.fail("the last row of \"T_stage_object\" is not 0 0 0 1",
                "write the 16 numbers row by row");
  }
  if (const std::string fault = describe_fault(T.topLeftCorner<3, 3>()); !fault.empty()) {
    reader.fail("\"T_stage_object\" " + fault,
                "a rotation and a translation are allowed; scale the mesh itself to metres");
  }
  // Meshes in survey coordinates lie a thousand kilometres from their origin.
  if (T.topRightCorner<3, 1>().cwiseAbs().maxCoeff() > 1e8) {
    reader.fail("\"T_stage_object\" moves the object out of reach", "use metres");
  }
  // Replace the rounded rotation of the file by the nearest exact one.
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(T.topLeftCorner<3, 3>(),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = svd.matrixU() * svd.matrixV().transpose();
  transform.translation() = T.topRightCorner<3, 1>();
  return transform;
}

/// A session may be recorded before there is a mesh.
void read_object(SessionReader& reader, Session& session) {
  if (!reader.root().contains("object")) return;
  const json& object = reader.object("object");
  reader.warn_unknown(object, {"mesh", "T_stage_object"}, "object.");
  const auto mesh = reader.inner_file(object, "mesh");
  if (!mesh) reader.fail("\"object\" names no \"mesh\"");
  session.mesh = *mesh;
  session.board_from_object = read_transform(reader, object);
}

/// Of the recording's stored images.
ImageSize image_size(const Session& session) {
  if (session.video) return stored_video_size(*session.video);
  const auto name = NumberedName::parse(*session.image_pattern);
  std::error_code no_throw;
  const bool begins_at_0 = std::filesystem::exists(session.folder / name->at(0), no_throw);
  const cv::Mat first =
      StillReader().read(session.folder / name->at(begins_at_0 ? 0 : 1), std::nullopt);
  return {first.cols, first.rows};
}

/// What session.json says of everything but the camera.
Session read_session(SessionReader& reader, const std::filesystem::path& folder) {
  check_format(reader);
  reader.warn_unknown(
      reader.root(), {"format", "version", "frames", "depth", "camera", "board", "poses", "object"},
      "");
  Session session;
  session.folder = folder;
  read_frames(reader, session);
  session.depth = read_depth(reader);
  session.board = reader.inner_file(reader.root(), "board");
  session.poses = reader.inner_file(reader.root(), "poses");
  read_object(reader, session);
  session.camera_file = reader.inner_file(reader.root(), "camera");
  session.warnings = std::move(reader.warnings);
  if (!session.camera_file) return session;
  session.camera = read_camera(*session.camera_file);
  for (const std::string& doubt : check_camera(session.camera)) {
    session.warnings.push_back(session.camera_file->string() + ": " + doubt);
  }
  return session;
}

void require_folder(const std::filesystem::path& folder) {
  std::error_code no_throw;
  if (std::filesystem::is_directory(folder, no_throw)) return;
  throw core::bad_input(folder, "there is no such session folder", "check the path");
}

std::unique_ptr<FrameSource> open_images(const Session& session, const FrameRange& range) {
  const ImageSize size{session.camera.width_px(), session.camera.height_px()};
  if (session.video) {
    const Eigen::Vector2d& focal_px = session.camera.intrinsics().focal_px;
    return open_video(
        *session.video, size, range, session.fps,
        session.camera_file ? std::optional(focal_px.y() / focal_px.x()) : std::nullopt);
  }
  return open_image_folder(session.folder, session.image_pattern.value_or(""), size, range,
                           session.fps);
}

}  // namespace

void Session::take_offset(const Eigen::Vector3d& offset) {
  if (offset == mesh_offset) return;
  board_from_object = board_from_object * Eigen::Translation3d(offset - mesh_offset);
  mesh_offset = offset;
}

Session open_session(const std::filesystem::path& folder) {
  require_folder(folder);
  SessionReader reader(folder);
  Session session = read_session(reader, folder);
  if (!session.board && !session.poses) {
    reader.fail("names neither \"board\" nor \"poses\"",
                "add the tag board (board.yaml) or the camera poses (poses.txt); sheen mesh finds "
                "the board where it is the sheet of sheen board");
  }
  if (!session.camera_file) {
    reader.fail("names no \"camera\"", "sheen mesh finds the camera from the walk");
  }
  return session;
}

Session open_unfinished_session(const std::filesystem::path& folder) {
  require_folder(folder);
  SessionReader reader(folder);
  Session session = read_session(reader, folder);
  if (!session.camera_file) session.camera = plain_camera(image_size(session));
  return session;
}

std::unique_ptr<FrameSource> open_frames(const Session& session, int start,
                                         std::optional<int> end) {
  FrameRange range{start, end};
  if (session.stamps) {
    auto times_s = read_stamps(*session.stamps);
    const int stamped = static_cast<int>(times_s.size());
    check_range(*session.stamps, range, stamped);
    range.end = std::min(end.value_or(stamped), stamped);
    auto frames = open_images(session, range);
    return with_stamps(std::move(frames), std::move(times_s));
  }
  return open_images(session, range);
}

}  // namespace sheen::capture
