// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"

namespace sheen::core {

Error::Error(Kind kind, const std::filesystem::path& subject, const std::string& fault,
             const std::string& remedy)
    : std::runtime_error(subject.string() + ": " + fault + "; " + remedy), kind_(kind) {}

Error bad_input(const std::filesystem::path& subject, const std::string& fault,
                const std::string& remedy) {
  return {Error::Kind::bad_input, subject, fault, remedy};
}

}  // namespace sheen::core
