// SPDX-License-Identifier: MIT
#include "capture/session/session_edit.h"

#include "capture/files/text_file.h"
#include "core/diagnostics/error.h"
#include "core/files/staged_output.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <string>

namespace sheen::capture {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20;

}  // namespace

void write_board_from_object(const std::filesystem::path& session_file,
                             const std::filesystem::path& output,
                             const Eigen::Isometry3d& board_from_object) {
  auto session =
      nlohmann::ordered_json::parse(read_text_file(session_file, kMaxBytes), nullptr, false);
  if (!session.is_object() || !session.contains("object") || !session["object"].is_object()) {
    throw core::bad_input(session_file, "holds no \"object\"", "see docs/session-format.md");
  }
  auto numbers = nlohmann::ordered_json::array();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      numbers.push_back(board_from_object.matrix()(row, column));
    }
  }
  session["object"]["T_stage_object"] = numbers;

  core::StagedOutput staged(output);
  std::ofstream file(staged.path(), std::ios::binary);
  file << session.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
  file.close();
  if (!file) {
    throw core::Error(core::Error::Kind::run_failed, output, "cannot be written",
                      "check free space and permissions");
  }
  staged.commit();
}

std::filesystem::path keep_before(const std::filesystem::path& file, const std::string& step) {
  const std::string name = file.stem().string() + ".before-" + step;
  auto copy = file;
  copy.replace_filename(name + file.extension().string());
  std::error_code failure;
  for (int count = 2; std::filesystem::exists(copy, failure); ++count) {
    copy.replace_filename(name + "-" + std::to_string(count) + file.extension().string());
  }
  core::StagedOutput staged(copy);
  std::filesystem::copy_file(file, staged.path(), failure);
  if (failure) {
    throw core::Error(core::Error::Kind::run_failed, copy, "cannot be written",
                      "check free space and permissions");
  }
  staged.commit();
  return copy;
}

}  // namespace sheen::capture
