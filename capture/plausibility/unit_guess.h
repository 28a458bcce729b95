// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sheen::capture {

/// The units that a number may have been meant in: those that bring `value`, read as metres, into
/// [least_m, most_m]. In words, "millimetres" or "centimetres or inches"; empty where there is
/// none.
std::string unit_guess(double value, double least_m, double most_m);

/// The question that goes with it: "are the numbers millimetres?"; `otherwise` where nothing fits.
std::string unit_question(double value, double least_m, double most_m,
                          const std::string& otherwise);

/// A length in metres for a message, three digits: "0.143 m".
std::string length_text(double length_m);

}  // namespace sheen::capture
