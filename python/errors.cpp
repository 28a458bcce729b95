// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"
#include "python/bindings.h"

namespace py = pybind11;

namespace sheen::python {

/// The library's errors keep their one line: what is wrong with which file, and what to do.
void bind_errors(py::module_& module) {
  static const py::exception<core::Error> bad_input(module, "InputError", PyExc_ValueError);
  static const py::exception<core::Error> run_failed(module, "RunError", PyExc_RuntimeError);
  bad_input.doc() = "A file or setting cannot be used; the message says which, why and what to do.";
  run_failed.doc() = "The work failed while it ran: a full disk, a missing device.";
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const core::Error& error) {
      const bool is_input = error.kind() == core::Error::Kind::bad_input;
      PyErr_SetString((is_input ? bad_input : run_failed).ptr(), error.what());
    }
  });
}

}  // namespace sheen::python
