// SPDX-License-Identifier: MIT
#include "fitting/mean/descriptor.h"

#include "core/mesh/neighbours.h"
#include "fitting/mean/mean_fitter.h"
#include "fitting/mean/model_codec.h"

namespace sheen::fitting::mean {

constinit const Descriptor kDescriptor{
    .name = "mean",
    .sentence = "one colour per patch",
    .default_options = new_options<NoOptions>,
    .make = [](const core::Mesh& mesh, const FitOptions& /*options*/,
               int threads) -> std::unique_ptr<Fitter> {
      return make_mean_fitter(core::vertex_neighbours(mesh), threads);
    },
    .encode = encode_model,
    .decode = decode_model};

}  // namespace sheen::fitting::mean
