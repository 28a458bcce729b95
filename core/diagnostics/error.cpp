// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"

#include "core/text/number.h"

namespace sheen::core {
namespace {

constexpr std::size_t kLongest = std::size_t{1} << 16;

}  // namespace

Error::Error(Kind kind, const std::filesystem::path& subject, const std::string& fault,
             const std::string& remedy)
    // Names of files hold any bytes, a message is one line.
    : std::runtime_error(quotable(subject.string() + ": " + fault + "; " + remedy, kLongest)),
      kind_(kind) {}

Error bad_input(const std::filesystem::path& subject, const std::string& fault,
                const std::string& remedy) {
  return {Error::Kind::bad_input, subject, fault, remedy};
}

}  // namespace sheen::core
