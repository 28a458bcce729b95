// SPDX-License-Identifier: MIT
#pragma once

#include "capture/pose/pose_estimator.h"
#include "core/samples/patch_share.h"
#include "core/samples/vertex_view.h"
#include "core/visibility/visibility.h"
#include "fitting/option_table.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace sheen::pipeline {

/// Where poses come from: `automatic` takes poses.txt when the session has one, else the tags.
enum class PoseSource { automatic, tags, file };

/// Which frames of a session are taken and where their poses come from.
struct FrameChoice {
  int start = 0;             ///< first frame, >= 0
  std::optional<int> end{};  ///< one past the last frame; nothing: all
  int hold_out = 0;          ///< keep frames with index % n == n / 2 out of the fit; 0: none
  PoseSource pose_source = PoseSource::automatic;
  capture::PoseGate gate{};
};

/// What is adjusted per frame to agree with the model that is being built.
struct PhotometricOptions {
  bool refine_poses = false;
  double pose_error_px = 0.3;  ///< expected of the poses to be refined, in the image, > 0
  bool exposure = false;
};

/// Where patches lie: one per vertex of the mesh; the mesh subdivided until its edges are as short
/// as a pixel's footprint; one per vertex and, where the representation is "detail", a texture of
/// such a footprint. Automatic: as detail, but where the vertices lie about as densely as the
/// texels would a texture has nothing to add, and the representation becomes "sparse".
enum class Patches { automatic, vertex, texel, detail };

/// Everything a reconstruction may be asked.
struct ReconstructionOptions {
  std::string representation = "detail";  ///< name of a descriptor (fitting/descriptor.h)
  fitting::OptionValues fit{};            ///< its settings
  FrameChoice frames{};
  Patches patches = Patches::automatic;
  double texel_px = 1.5;  ///< of texel patches: longest edge, pixels, > 0
  core::SamplingLimits limits{};
  PhotometricOptions photometric{};
  core::PatchShare share{};  ///< of the patches: the only ones that are fitted
  /// Whether to move the mesh's vertices to where the pictures agree, if they do there. Nothing:
  /// where a texture is fitted to a mesh much coarser than its texels, never while it is recorded.
  std::optional<bool> refine_mesh{};
  bool refine_board = false;       ///< refine the tags' places before their poses are used
  bool refuse_mismatches = false;  ///< keep frames out that contradict the model
  bool with_mean = false;          ///< fit mean colours to the same samples, to compare with
  bool undoable = false;           ///< views may be taken back; costs disk or time
  int threads = 1;                 ///< >= 1; the result does not depend on it
};

/// Makes the method that finds hidden vertices; nothing: the z-buffer on the CPU.
using VisibilityFactory =
    std::function<std::unique_ptr<core::Visibility>(const core::Mesh& mesh, int threads)>;

}  // namespace sheen::pipeline
