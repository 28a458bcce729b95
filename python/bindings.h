// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

namespace sheen::python {

// One part of the module each.
void bind_errors(pybind11::module_& module);
void bind_session(pybind11::module_& module);
void bind_model(pybind11::module_& module);

}  // namespace sheen::python
