// SPDX-License-Identifier: MIT
#include "fitting/billboard/descriptor.h"

#include "fitting/billboard/billboard_fitter.h"
#include "fitting/billboard/model_codec.h"
#include "fitting/billboard/options.h"

namespace sheen::fitting::billboard {

constinit const Descriptor kDescriptor{
    .name = "billboard",
    .sentence = "images baked from many directions, drawn on squares that face them",
    .default_options = new_options<Options>,
    .make =
        [](const core::Mesh& mesh, const FitOptions& options, int threads) {
          return make_billboard_fitter(mesh, options_as<Options>(options), threads);
        },
    .encode = encode_model,
    .decode = decode_model};

}  // namespace sheen::fitting::billboard
