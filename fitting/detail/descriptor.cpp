// SPDX-License-Identifier: MIT
#include "fitting/detail/descriptor.h"

#include "fitting/detail/detail_fitter.h"
#include "fitting/detail/model_codec.h"
#include "fitting/detail/options.h"

namespace sheen::fitting::detail {

constinit const Descriptor kDescriptor{
    .name = "detail",
    .sentence =
        "a texture as fine as the images, and sparse patches for what changes with the "
        "direction",
    .default_options = new_options<Options>,
    .make =
        [](const core::Mesh& mesh, const FitOptions& options, int threads) {
          return make_detail_fitter(mesh, options_as<Options>(options), threads);
        },
    .encode = encode_model,
    .decode = decode_model};

}  // namespace sheen::fitting::detail
