// SPDX-License-Identifier: MIT
#include "app/batch/failure.h"

#include "core/diagnostics/error.h"
#include "core/files/read_file.h"
#include "core/files/write_file.h"

#include <nlohmann/json.hpp>

namespace sheen::app {
namespace {

constexpr const char* kFailure = "failed.json";
constexpr const char* kFailedLog = "failed.log";
constexpr std::size_t kMostFailureBytes = std::size_t{1} << 20;

}  // namespace

void write_failure(const std::filesystem::path& folder, const Failure& failure,
                   const std::filesystem::path& log) {
  std::error_code ignored;
  std::filesystem::copy_file(log, folder / kFailedLog,
                             std::filesystem::copy_options::overwrite_existing, ignored);
  const nlohmann::ordered_json document{{"step", failure.step}, {"message", failure.message}};
  core::write_file(folder / kFailure,
                   document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

std::optional<Failure> read_failure(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::exists(folder / kFailure, ignored)) return std::nullopt;
  const auto document =
      nlohmann::json::parse(core::read_file(folder / kFailure, kMostFailureBytes), nullptr, false);
  if (!document.is_object()) return std::nullopt;
  return Failure{document.value("step", ""), document.value("message", "")};
}

void remove_failure(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::remove(folder / kFailure, ignored);
  std::filesystem::remove(folder / kFailedLog, ignored);
}

}  // namespace sheen::app
