// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace sheen::core {

/// The world failed: a file is broken, a device is gone, a disk is full. Caught once in main and
/// at the thread boundary. `what()` is one line: subject, fault, remedy.
class Error : public std::runtime_error {
 public:
  /// Decides the exit code of the program: bad_input 2, run_failed 1.
  enum class Kind { bad_input, run_failed };

  /// `subject` is the file or device, `fault` what is wrong with it, `remedy` what the user can do.
  Error(Kind kind, const std::filesystem::path& subject, const std::string& fault,
        const std::string& remedy);

  [[nodiscard]] Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

/// Shorthand for the most frequent throw: the user's input cannot be used.
[[nodiscard]] Error bad_input(const std::filesystem::path& subject, const std::string& fault,
                              const std::string& remedy);

}  // namespace sheen::core
