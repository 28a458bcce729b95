// SPDX-License-Identifier: MIT
#pragma once

namespace sheen::core {

/// CPU time of the whole process, all threads, milliseconds.
double process_cpu_ms();

/// CPU time spent for the calling thread, milliseconds: its own, and what `parallel_for` had other
/// threads do for it.
double own_cpu_ms();

/// Adds work that another thread did for the calling one to its `own_cpu_ms`.
void credit_cpu_ms(double ms);

}  // namespace sheen::core
