// SPDX-License-Identifier: MIT
#include "fitting/sparse/options.h"

#include "fitting/sparse/sample_store.h"

#include <stdexcept>
#include <string>

namespace sheen::fitting::sparse {

void Options::check() const {
  if (tolerance && !(*tolerance > 0.0f && *tolerance < 1.0f)) {
    throw std::invalid_argument("tolerance is " + std::to_string(*tolerance) +
                                ", it must lie between 0 and 1");
  }
  if (!(criterion_weight >= 0.0f && criterion_weight <= 10.0f)) {
    throw std::invalid_argument("criterion_weight is " + std::to_string(criterion_weight) +
                                ", it must lie between 0 and 10");
  }
  if (max_samples < 8 || max_samples > static_cast<int>(kMaxStoredSamples)) {
    throw std::invalid_argument("max_samples is " + std::to_string(max_samples) +
                                ", it must lie between 8 and " + std::to_string(kMaxStoredSamples));
  }
}

OptionTable option_table(Options& options) {
  return {number_option("tolerance", options.tolerance, 0.0005, 0.5,
                        "Error that nobody minds, of 1; more is smaller (default: twice the "
                        "camera's noise, estimated from the samples)")};
}

}  // namespace sheen::fitting::sparse
