// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/detail/options.h"
#include "fitting/fitter.h"

#include <memory>

namespace sheen::fitting::detail {

std::unique_ptr<Fitter> make_detail_fitter(const core::Mesh& mesh, const Options& options,
                                           int threads);

}  // namespace sheen::fitting::detail
