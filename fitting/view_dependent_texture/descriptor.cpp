// SPDX-License-Identifier: MIT
#include "fitting/view_dependent_texture/descriptor.h"

#include "fitting/view_dependent_texture/model_codec.h"
#include "fitting/view_dependent_texture/options.h"
#include "fitting/view_dependent_texture/view_texture_fitter.h"

namespace sheen::fitting::view_dependent_texture {

constinit const Descriptor kDescriptor{
    .name = "view-dependent-texture",
    .sentence = "the photographs, projected onto the mesh, the best ones blended at every pixel",
    .default_options = new_options<Options>,
    .make =
        [](const core::Mesh& mesh, const FitOptions& options, int threads) {
          return make_view_texture_fitter(mesh, options_as<Options>(options), threads);
        },
    .encode = encode_model,
    .decode = decode_model};

}  // namespace sheen::fitting::view_dependent_texture
