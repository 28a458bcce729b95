// SPDX-License-Identifier: MIT
#include "python/bindings.h"

PYBIND11_MODULE(sheen, module) {
  module.doc() =
      "Surface light fields from recordings of a walk round an object.\n\n"
      "    session = sheen.open_session('sample_data/glossy')\n"
      "    model = sheen.reconstruct(session)\n"
      "    colours = model.evaluate([0, 1], [[0, 0, 1], [0, 0, 1]])\n"
      "    model.write('model.glb')\n\n"
      "Lengths are metres, colours display-referred sRGB in [0, 1], directions unit vectors in "
      "the\n"
      "object frame that point away from the surface.";
  sheen::python::bind_errors(module);
  sheen::python::bind_session(module);
  sheen::python::bind_model(module);
}
