// SPDX-License-Identifier: MIT
#pragma once

#include "fitting/iwls/options.h"
#include "fitting/option_table.h"
#include "fitting/patch_fitter.h"

#include <memory>
#include <string>
#include <vector>

namespace sheen::evaluation {

/// A representation with its settings, under the name that tables use.
struct Method {
  std::string name;
  std::string representation;
  fitting::OptionValues options{};

  /// For independent points: no patch has neighbours.
  [[nodiscard]] std::unique_ptr<fitting::PatchFitter> make(std::size_t patch_count) const;
};

/// IWLS in one construction; `faithful` follows the paper to the letter.
Method iwls_method(fitting::iwls::Construction construction, bool faithful, int centers = 16,
                   int terms = 3, fitting::iwls::Layout layout = fitting::iwls::Layout::grid);

/// Spherical harmonics of degree 1, 2 or 3 with the ridge that users get.
Method harmonics_method(int degree);

/// Degree 3 with next to no ridge: what a model does that nothing holds back.
Method free_harmonics_method();

/// Everything the studies compare: the constructions of IWLS, faithful and with the ridge, batch
/// with one and six terms, spherical harmonics, and the other representations of patches by their
/// names.
std::vector<Method> all_methods();

/// Name of the method whose promises are checked.
inline constexpr const char* kDefaultMethod = "sparse";

}  // namespace sheen::evaluation
