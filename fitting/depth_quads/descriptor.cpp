// SPDX-License-Identifier: MIT
#include "fitting/depth_quads/descriptor.h"

#include "fitting/depth_quads/model_codec.h"
#include "fitting/depth_quads/options.h"
#include "fitting/depth_quads/quad_fitter.h"

namespace sheen::fitting::depth_quads {

constinit const Descriptor kDescriptor{
    .name = "depth-quads",
    .sentence = "the photographs, as small squares at the depths of what they show",
    .default_options = new_options<Options>,
    .make =
        [](const core::Mesh& mesh, const FitOptions& options, int threads) {
          return make_quad_fitter(mesh, options_as<Options>(options), threads);
        },
    .encode = encode_model,
    .decode = decode_model};

}  // namespace sheen::fitting::depth_quads
