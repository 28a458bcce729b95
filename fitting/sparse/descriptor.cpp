// SPDX-License-Identifier: MIT
#include "fitting/sparse/descriptor.h"

#include "core/mesh/neighbours.h"
#include "fitting/sparse/model_codec.h"
#include "fitting/sparse/options.h"
#include "fitting/sparse/sparse_fitter.h"

namespace sheen::fitting::sparse {

constinit const Descriptor kDescriptor{
    .name = "sparse",
    .sentence = "as many terms as each patch needs, from a dictionary of radial functions",
    .default_options = new_options<Options>,
    .make = [](const core::Mesh& mesh, const FitOptions& options,
               int threads) -> std::unique_ptr<Fitter> {
      return make_sparse_fitter(core::vertex_neighbours(mesh), options_as<Options>(options),
                                threads);
    },
    .encode = encode_model,
    .decode = decode_model};

}  // namespace sheen::fitting::sparse
