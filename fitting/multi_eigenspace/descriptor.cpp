// SPDX-License-Identifier: MIT
#include "fitting/multi_eigenspace/descriptor.h"

#include "fitting/multi_eigenspace/eigenspace_fitter.h"
#include "fitting/multi_eigenspace/model_codec.h"
#include "fitting/multi_eigenspace/options.h"

namespace sheen::fitting::multi_eigenspace {

constinit const Descriptor kDescriptor{
    .name = "multi-eigenspace",
    .sentence =
        "pictures of the whole object, packed into several eigenspaces and drawn on a billboard",
    .default_options = new_options<Options>,
    .make =
        [](const core::Mesh& mesh, const FitOptions& options, int threads) {
          return make_eigenspace_fitter(mesh, options_as<Options>(options), threads);
        },
    .encode = encode_model,
    .decode = decode_model};

}  // namespace sheen::fitting::multi_eigenspace
