// SPDX-License-Identifier: MIT
#include "core/geometry/tangent_frame.h"
#include "fitting/descriptor.h"
#include "fitting/model_file/model_file.h"
#include "fitting/model_file/model_part.h"
#include "fitting/patch_light_field.h"
#include "pipeline/light/session_light.h"
#include "pipeline/reconstruct.h"
#include "pipeline/session_readout.h"
#include "python/bindings.h"

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <optional>
#include <string>

namespace py = pybind11;

namespace sheen::python {
namespace {

/// A light field on its mesh, from a file or from a reconstruction that is kept alive.
struct Model {
  std::shared_ptr<const void> owner;
  const core::Mesh* mesh = nullptr;
  const fitting::LightField* light_field = nullptr;
  fitting::SeenDirections seen{};
  std::optional<pipeline::FrameStatistics> frames{};  ///< of a reconstruction
};

Model model_of(const std::shared_ptr<const fitting::Model>& file) {
  return {file, &file->mesh, file->light_field.get(), file->seen};
}

/// Numbers that lie in `owner`, seen from Python without a copy and not to be written.
template <typename Number>
py::array view_of(const Number* numbers, std::vector<py::ssize_t> shape, const py::object& owner) {
  py::array_t<Number> array(std::move(shape), numbers, owner);
  array.attr("flags").attr("writeable") = false;
  return py::array(array);
}

py::array vectors(const std::vector<Eigen::Vector3f>& list, const py::object& owner) {
  return view_of(list.empty() ? nullptr : list.front().data(),
                 {static_cast<py::ssize_t>(list.size()), 3}, owner);
}

const Model& model_in(const py::object& self) {
  return self.cast<const Model&>();
}

/// The arrays of the model file, as they lie in memory: half floats where the file has them.
py::dict coefficients(const py::object& self) {
  const Model& model = model_in(self);
  const auto part = std::make_shared<fitting::ModelPart>(
      fitting::representation_named(model.light_field->representation())
          .encode(*model.light_field));
  // Whoever holds an array holds what it points into.
  const py::capsule owner(new std::pair(part, model.owner), [](void* pair) {
    delete static_cast<
        std::pair<std::shared_ptr<fitting::ModelPart>, std::shared_ptr<const void>>*>(pair);
  });
  py::dict arrays;
  for (const auto& [name, bytes] : part->arrays) {
    py::array raw = view_of(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                            {static_cast<py::ssize_t>(bytes.size())}, owner);
    const bool is_half = name == "coefficients";
    arrays[py::str(name)] = is_half ? raw.attr("view")("float16") : py::object(raw);
  }
  return arrays;
}

using Indices = py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>;
using Directions = py::array_t<float, py::array::c_style | py::array::forcecast>;

py::array_t<float> evaluate(const Model& model, const Indices& patches,
                            const Directions& directions) {
  const auto& light_field = fitting::require_patches(*model.light_field, "evaluate");
  if (patches.ndim() != 1 || directions.ndim() != 2 || directions.shape(1) != 3 ||
      directions.shape(0) != patches.shape(0)) {
    throw py::value_error("patches must have shape (N,) and directions (N, 3)");
  }
  const auto count = patches.shape(0);
  const auto patch = patches.unchecked<1>();
  const auto direction = directions.unchecked<2>();
  py::array_t<float> colours({count, py::ssize_t{3}});
  auto colour = colours.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < count; ++i) {
    if (patch(i) >= light_field.patch_count()) {
      throw py::index_error("patch " + std::to_string(patch(i)) + " of " +
                            std::to_string(light_field.patch_count()));
    }
    const core::TangentFrame frame = core::tangent_frame(model.mesh->normals[patch(i)]);
    const Eigen::Vector3f w(direction(i, 0), direction(i, 1), direction(i, 2));
    const Eigen::Vector2f uv(w.dot(frame.tangent), w.dot(frame.bitangent));
    const Eigen::Vector3f rgb = light_field.evaluate(patch(i), uv).colour();
    for (py::ssize_t c = 0; c < 3; ++c) colour(i, c) = rgb[c];
  }
  return colours;
}

/// Tells a Python function of progress; what it raises ends the work, as Ctrl-C does.
class PythonSink final : public pipeline::ProgressSink {
 public:
  explicit PythonSink(std::optional<py::function> progress) : progress_(std::move(progress)) {}
  ~PythonSink() override {
    const py::gil_scoped_acquire python;
    progress_.reset();
  }
  PythonSink(const PythonSink&) = delete;
  PythonSink& operator=(const PythonSink&) = delete;
  PythonSink(PythonSink&&) = delete;
  PythonSink& operator=(PythonSink&&) = delete;

  void progress(const pipeline::StepProgress& step) override {
    const py::gil_scoped_acquire python;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (progress_) (*progress_)(std::string(step.step), step.done, step.total);
  }
  void note(const std::string& line) override {
    const py::gil_scoped_acquire python;
    PyErr_WarnEx(PyExc_UserWarning, line.c_str(), 1);
  }

 private:
  std::optional<py::function> progress_;
};

Model reconstruct(const capture::Session& session, const std::optional<std::string>& representation,
                  const fitting::OptionValues& options, int start, std::optional<int> end,
                  int hold_out, int threads, std::optional<py::function> progress) {
  pipeline::ReconstructionOptions settings;
  if (representation) {
    settings.representation = *representation;
    settings.patches = pipeline::Patches::detail;  // no other is chosen instead
  }
  settings.fit = options;
  settings.frames.start = start;
  settings.frames.end = end;
  settings.frames.hold_out = hold_out;
  settings.threads = threads;
  PythonSink sink(std::move(progress));
  const py::gil_scoped_release others_may_run;
  capture::Session completed = session;
  pipeline::complete_readout(completed, settings.frames, sink);
  pipeline::complete_light(completed, settings.frames, sink);
  auto fitted = std::make_shared<pipeline::Reconstruction>(
      pipeline::reconstruct({.session = std::move(completed)}, settings, sink));
  const core::Mesh& mesh = fitted->mesh();
  const fitting::LightField& light_field = fitted->light_field();
  return {fitted, &mesh, &light_field, fitted->frames().seen, fitted->frames()};
}

std::string describe(const Model& model) {
  return "<sheen.Model " + std::string(model.light_field->representation()) + ", " +
         std::to_string(model.mesh->positions.size()) + " vertices>";
}

void bind_geometry(py::class_<Model>& model) {
  model
      .def_property_readonly(
          "positions",
          [](const py::object& self) { return vectors(model_in(self).mesh->positions, self); },
          "float32 (V, 3): vertices, metres, object frame. No copy; not writeable.")
      .def_property_readonly(
          "normals",
          [](const py::object& self) { return vectors(model_in(self).mesh->normals, self); },
          "float32 (V, 3): unit normals. No copy; not writeable.")
      .def_property_readonly(
          "triangles",
          [](const py::object& self) {
            const auto& triangles = model_in(self).mesh->triangles;
            return view_of(triangles.empty() ? nullptr : triangles.front().data(),
                           {static_cast<py::ssize_t>(triangles.size()), 3}, self);
          },
          "uint32 (T, 3): vertices of each triangle, counter-clockwise from outside. No copy; not "
          "writeable.");
}

void bind_light_field(py::class_<Model>& model) {
  model
      .def_property_readonly(
          "representation",
          [](const Model& self) { return std::string(self.light_field->representation()); })
      .def_property_readonly(
          "patch_count",
          [](const Model& self) {
            const auto* const patches = fitting::as_patches(*self.light_field);
            return patches != nullptr ? patches->patch_count() : 0;
          },
          "Patches, one per vertex; 0 for a representation that has none.")
      .def_property_readonly(
          "observed",
          [](const py::object& self) {
            const auto& flags =
                fitting::require_patches(*model_in(self).light_field, "observed").observed();
            return view_of(flags.data(), {static_cast<py::ssize_t>(flags.size())}, self);
          },
          "uint8 (V,): 1 where a patch was seen in the fit. No copy; not writeable.")
      .def_property_readonly(
          "vertex_colours",
          [](const Model& self) {
            const auto colours = self.light_field->vertex_colours(*self.mesh);
            py::array_t<float> array({static_cast<py::ssize_t>(colours.size()), py::ssize_t{3}});
            auto out = array.mutable_unchecked<2>();
            for (py::ssize_t i = 0; i < out.shape(0); ++i) {
              for (py::ssize_t c = 0; c < 3; ++c)
                out(i, c) = colours[static_cast<std::size_t>(i)][c];
            }
            return array;
          },
          "float32 (V, 3): direction-independent colours, sRGB in [0, 1].")
      .def_property_readonly(
          "coefficients", &coefficients,
          "Arrays of the model file by name (docs/formats.md), 'coefficients' as "
          "float16, others as bytes. Not writeable.")
      .def("evaluate", &evaluate, py::arg("patches"), py::arg("directions"),
           "Radiance of patches towards directions.\n\n"
           "patches: integers (N,), each below patch_count.\n"
           "directions: (N, 3), unit vectors in the object frame from the surface to the eye.\n"
           "Returns float32 (N, 3), display-referred sRGB, not limited to [0, 1].");
}

}  // namespace

void bind_model(py::module_& module) {
  py::class_<Model> model(module, "Model", "A light field and the surface that it lies on.");
  bind_geometry(model);
  bind_light_field(model);
  model
      .def_property_readonly(
          "frames",
          [](const Model& self) -> py::object {
            if (!self.frames) return py::none();
            py::dict counts;
            counts["read"] = self.frames->frames_read;
            counts["posed"] = self.frames->posed.size();
            counts["fitted"] = self.frames->frames_fitted;
            counts["held_out"] = self.frames->held_out.size();
            return py::object(counts);
          },
          "What became of the frames, by count; None for a model that was read from a file.")
      .def(
          "write",
          [](const Model& self, const std::filesystem::path& path) {
            fitting::write_model(path, *self.mesh, *self.light_field, self.seen);
          },
          py::arg("path"), "Writes a .glb; an old file stays until the new one is complete.")
      .def("__repr__", &describe);
  module.def(
      "read_model",
      [](const std::filesystem::path& path) {
        return model_of(std::make_shared<const fitting::Model>(fitting::read_model(path)));
      },
      py::arg("path"), "Reads a .glb that sheen wrote. Raises sheen.InputError for anything else.");
  module.def(
      "reconstruct", &reconstruct, py::arg("session"), py::kw_only(),
      py::arg("representation") = py::none(), py::arg("options") = fitting::OptionValues{},
      py::arg("start") = 0, py::arg("end") = py::none(), py::arg("hold_out") = 0,
      py::arg("threads") = 1, py::arg("progress") = py::none(),
      "Poses every frame of a session, fits a light field and returns the model.\n\n"
      "representation, options: as on the command line (None: as with --patches auto), options\n"
      "as text by name without "
      "dashes, e.g. representation='iwls', options={'fitter': 'batch'}.\n"
      "start, end: frames [start, end); hold_out: every n-th frame stays out of the fit.\n"
      "progress: called as progress(step, done, total), total 0 where it is not known; what\n"
      "it raises ends the work and comes out here.\n"
      "The result does not depend on threads. Other Python threads run meanwhile.");
}

}  // namespace sheen::python
