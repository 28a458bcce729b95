// SPDX-License-Identifier: MIT
#include "fitting/spherical_harmonics/descriptor.h"

#include "core/mesh/neighbours.h"
#include "fitting/spherical_harmonics/harmonics_fitter.h"
#include "fitting/spherical_harmonics/model_codec.h"
#include "fitting/spherical_harmonics/options.h"

namespace sheen::fitting::spherical_harmonics {

constinit const Descriptor kDescriptor{.name = "sh",
                                       .sentence = "one set of spherical harmonics per patch",
                                       .default_options = new_options<Options>,
                                       .make = [](const core::Mesh& mesh, const FitOptions& options,
                                                  int threads) -> std::unique_ptr<Fitter> {
                                         return make_harmonics_fitter(core::vertex_neighbours(mesh),
                                                                      options_as<Options>(options),
                                                                      threads);
                                       },
                                       .encode = encode_model,
                                       .decode = decode_model};

}  // namespace sheen::fitting::spherical_harmonics
