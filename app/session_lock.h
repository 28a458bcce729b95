// SPDX-License-Identifier: MIT
#pragma once

#include "core/files/folder_lock.h"

#include <filesystem>
#include <initializer_list>
#include <optional>

namespace sheen::app {

/// While one exists no other command writes into the session; no lock is asked for where the
/// outputs lie elsewhere. Throws core::Error (bad_input) that names who holds it.
class SessionLock {
 public:
  SessionLock(const std::filesystem::path& session,
              std::initializer_list<std::filesystem::path> outputs);

 private:
  std::optional<core::FolderLock> lock_;
};

}  // namespace sheen::app
