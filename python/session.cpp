// SPDX-License-Identifier: MIT
#include "capture/session/session.h"

#include "pipeline/options.h"
#include "python/bindings.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace py = pybind11;

namespace sheen::python {
namespace {

Eigen::Matrix3d camera_matrix(const capture::Session& session) {
  const auto& lens = session.camera.intrinsics();
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
  K(0, 0) = lens.focal_px.x();
  K(1, 1) = lens.focal_px.y();
  K(0, 2) = lens.principal_px.x();
  K(1, 2) = lens.principal_px.y();
  return K;
}

}  // namespace

void bind_session(py::module_& module) {
  py::class_<capture::Session>(module, "Session", "A recorded session: what session.json says.")
      .def_readonly("folder", &capture::Session::folder)
      .def_readonly("mesh", &capture::Session::mesh, "Path of the object's mesh.")
      .def_readonly("warnings", &capture::Session::warnings,
                    "What was not understood, a line each.")
      .def_property_readonly(
          "image_size",
          [](const capture::Session& session) {
            return py::make_tuple(session.camera.width_px(), session.camera.height_px());
          },
          "(width, height) in pixels.")
      .def_property_readonly("camera_matrix", &camera_matrix,
                             "3x3, pixels; pixel (0, 0) is the centre of the first pixel.")
      .def_property_readonly(
          "distortion",
          [](const capture::Session& session) { return session.camera.intrinsics().distortion; },
          "The lens's eight coefficients: k1 k2 p1 p2 k3 k4 k5 k6 as OpenCV has them.")
      .def_property_readonly(
          "board_from_object",
          [](const capture::Session& session) { return session.board_from_object.matrix(); },
          "4x4, metres: where the object stands on the board.")
      .def("__repr__", [](const capture::Session& session) {
        return "<sheen.Session " + session.folder.string() + ">";
      });
  module.def("open_session", &capture::open_session, py::arg("folder"),
             "Opens a session folder and checks it.\n\n"
             "Raises sheen.InputError with one line: which file, what is wrong, what to do.");
}

}  // namespace sheen::python
