// SPDX-License-Identifier: MIT
#include "fitting/iwls/descriptor.h"

#include "core/mesh/neighbours.h"
#include "fitting/iwls/iwls_fitter.h"
#include "fitting/iwls/model_codec.h"
#include "fitting/iwls/options.h"

namespace sheen::fitting::iwls {

constinit const Descriptor kDescriptor{
    .name = "iwls",
    .sentence = "the paper's incremental weighted least squares: polynomials at fixed centres",
    .default_options = new_options<Options>,
    .make = [](const core::Mesh& mesh, const FitOptions& options,
               int threads) -> std::unique_ptr<Fitter> {
      return make_iwls_fitter(core::vertex_neighbours(mesh), options_as<Options>(options), threads);
    },
    .encode = encode_model,
    .decode = decode_model};

}  // namespace sheen::fitting::iwls
