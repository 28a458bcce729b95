// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>

extern "C" {
#include <apriltag/apriltag.h>
}

namespace sheen::capture {

/// Owner of one of libapriltag's tables of codes.
class AprilTagFamily {
 public:
  /// No value for a name that libapriltag does not know.
  static std::optional<AprilTagFamily> find(const std::string& name);

  [[nodiscard]] apriltag_family_t* get() const { return family_.get(); }

 private:
  using Owner = std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)>;
  explicit AprilTagFamily(Owner family) : family_(std::move(family)) {}

  Owner family_;
};

}  // namespace sheen::capture
