// SPDX-License-Identifier: MIT
#pragma once

#include "core/mesh/mesh.h"
#include "fitting/fitter.h"
#include "fitting/option_table.h"

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sheen::render {
class Context;
class Renderer;
}  // namespace sheen::render

namespace sheen::fitting {

struct ModelPart;

/// All that the program knows of a representation: everything else asks the descriptor. Built-in
/// ones are listed in registry.cpp; a program adds its own by `register_representation`.
struct Descriptor {
  std::string_view name;      ///< as on the command line and in the model file
  std::string_view sentence;  ///< for the help: what it is, in a few words

  /// Its settings at their defaults.
  std::unique_ptr<FitOptions> (*default_options)();

  /// An empty light field over `mesh`, which outlives it (a PatchFitter looks at it during the call
  /// only); `options` come from `default_options` and are checked; `threads` >= 1.
  std::unique_ptr<Fitter> (*make)(const core::Mesh& mesh, const FitOptions& options, int threads);

  /// Its part of a model file (fitting/model_file/model_part.h); points into `light_field`.
  ModelPart (*encode)(const LightField& light_field);
  /// Throws ModelFault for anything that `encode` does not write.
  std::unique_ptr<const LightField> (*decode)(const ModelPart& part, const core::Mesh& mesh);

  /// Draws it. Null: by a renderer that is built in (render/renderer.h); those know
  /// every light field of patches.
  std::unique_ptr<render::Renderer> (*make_renderer)(render::Context& context,
                                                     const core::Mesh& mesh,
                                                     const LightField& light_field,
                                                     int threads) = nullptr;
};

/// In the order in which users should see them.
std::vector<const Descriptor*> representations();

/// Throws std::invalid_argument for an unknown name, listing the known ones.
const Descriptor& representation_named(std::string_view name);

/// Adds one for the rest of the program's life; `descriptor` outlives it. Not to be called while
/// other threads use this library. Throws std::invalid_argument when the name is taken.
void register_representation(const Descriptor& descriptor);

/// The representation's settings, set to `values`. Throws std::invalid_argument for a name that it
/// does not have and for values that are not allowed.
std::unique_ptr<FitOptions> options_from(const Descriptor& descriptor, const OptionValues& values);

/// An empty light field of this representation over `mesh`, which outlives it. Throws
/// std::invalid_argument as the functions above, and when `threads` < 1.
std::unique_ptr<Fitter> make_fitter(std::string_view representation, const core::Mesh& mesh,
                                    const OptionValues& values = {}, int threads = 1);

}  // namespace sheen::fitting
