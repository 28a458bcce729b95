// SPDX-License-Identifier: MIT
#include "fitting/eigen_texture/descriptor.h"

#include "fitting/eigen_texture/eigen_fitter.h"
#include "fitting/eigen_texture/model_codec.h"
#include "fitting/eigen_texture/options.h"

namespace sheen::fitting::eigen_texture {

constinit const Descriptor kDescriptor{
    .name = "eigen-texture",
    .sentence = "a mean texture and basis textures, blended anew for every direction",
    .default_options = new_options<Options>,
    .make =
        [](const core::Mesh& mesh, const FitOptions& options, int threads) {
          return make_eigen_fitter(mesh, options_as<Options>(options), threads);
        },
    .encode = encode_model,
    .decode = decode_model};

}  // namespace sheen::fitting::eigen_texture
