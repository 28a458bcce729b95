// SPDX-License-Identifier: MIT
#pragma once

#include "app/commands/session_options.h"
#include "app/pipeline/photometric_aligner.h"
#include "core/samples/vertex_view.h"
#include "fitting/iwls/options.h"
#include "fitting/sparse/options.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace sheen::app {

/// Which of the agreeing implementations finds hidden vertices; `automatic` is the fastest.
enum class VisibilityMethod { automatic, raster, rays, depth };

/// Everything `sheen replay` may be asked.
struct ReplayOptions {
  SessionOptions session;
  std::filesystem::path output;        ///< the model
  std::filesystem::path mean_output;   ///< the mean colours as a model; empty: not written
  std::filesystem::path poses_output;  ///< estimated poses, TUM form; empty: not written
  std::string representation;          ///< name in the registry, or "iwls" for what `fitter` says
  std::string fitter = "sparse";       ///< sparse, or one of the paper's constructions
  std::string patches = "vertex";      ///< or "texel": as fine as the images resolve
  double texel_px = 1.5;               ///< longest edge between texel patches, pixels, > 0
  fitting::iwls::Options iwls;         ///< for every fitter but sparse
  fitting::sparse::Options sparse;     ///< for the sparse fitter
  VisibilityMethod visibility = VisibilityMethod::automatic;
  core::SamplingLimits limits;
  PhotometricOptions photometric;
  bool preview = false;                   ///< watched in a window
  std::filesystem::path snapshots = ".";  ///< folder for the window's snapshots
  bool refuse_mismatches = false;         ///< keep frames out that contradict the model
  bool refine_board = false;              ///< refine the tags' places before their poses are used

  /// Name of the registry's representation that `representation` and `fitter` come to.
  [[nodiscard]] std::string registered_name() const;
};

/// The part of them that says what becomes of frames, live ones too.
void add_model_options(CLI::App& command, ReplayOptions& options);

void add_replay_options(CLI::App& command, ReplayOptions& options);

/// The options as they stand in reports.
nlohmann::ordered_json to_json(const ReplayOptions& options);

}  // namespace sheen::app
