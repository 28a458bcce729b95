// SPDX-License-Identifier: MIT
#include "fitting/nearest_views/descriptor.h"

#include "core/mesh/neighbours.h"
#include "fitting/nearest_views/model_codec.h"
#include "fitting/nearest_views/nearest_fitter.h"

namespace sheen::fitting::nearest_views {

constinit const Descriptor kDescriptor{
    .name = "nearest-views",
    .sentence = "every sample is kept, the views nearest in direction are blended",
    .default_options = new_options<NoOptions>,
    .make = [](const core::Mesh& mesh, const FitOptions& /*options*/,
               int threads) -> std::unique_ptr<Fitter> {
      return make_nearest_fitter(core::vertex_neighbours(mesh), threads);
    },
    .encode = encode_model,
    .decode = decode_model};

}  // namespace sheen::fitting::nearest_views
