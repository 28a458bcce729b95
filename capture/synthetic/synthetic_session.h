// SPDX-License-Identifier: MIT
#pragma once

#include "capture/synthetic/brdf.h"
#include "capture/synthetic/scene.h"
#include "core/geometry/camera.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

namespace sheen::capture::synthetic {

/// How the object is seen from all round.
enum class PathKind {
  walk,       ///< a camera in hand goes round it three times
  turntable,  ///< it turns once before a camera that stands still; held-out views lie half way
              ///< between frames
};

/// A recording of an object that exists only in numbers.
struct SyntheticOptions {
  SceneKind scene = SceneKind::glossy;
  int vertices = 10'000;                      ///< of the knot, [500, 2000000]
  std::optional<std::filesystem::path> mesh;  ///< a mesh of one's own instead of the knot, metres
  int mesh_vertices = 0;  ///< of the knot as the session's mesh has it, [500, 2000000]; 0: as
                          ///< photographed; without effect on a mesh of one's own
  PathKind path = PathKind::walk;
  int width_px = 640;      ///< [160, 4096]
  int height_px = 360;     ///< [120, 4096]
  int frames = 120;        ///< of the recording, [2, 100000]
  int held_out = 12;       ///< views apart from it, [0, 10000]
  int samples = 8;         ///< rays per pixel of a frame, [1, 256]
  int jpeg_quality = 93;   ///< of the video, [1, 100]
  double readout_ms = 0;   ///< from the first row of a frame to the last, [0, 33]; not told in
                           ///< camera.yaml, and not of held-out views
  bool depth = false;      ///< depth images of the recording's frames, too, without noise
  std::uint32_t seed = 1;  ///< of path, tremor and noise
  int threads = 1;         ///< >= 1

  /// Throws std::invalid_argument naming the option and its range.
  void check() const;
};

/// Lens and sensor of the recording: focal length 0.9 times the longer side, a visible barrel.
core::CameraModel synthetic_camera(int width_px, int height_px);

/// The object on its board. Throws core::Error (bad_input) for a mesh that cannot be read, or that
/// is not between 1 cm and 2 m in radius.
Scene make_scene(const SyntheticOptions& options);

/// Called after every image; an exception it throws ends the work and leaves nothing behind.
using Progress = std::function<void(int done, int total)>;

/// Writes a session folder (docs/session-format.md) with frames.avi, board.yaml, truth_poses.txt,
/// on request depth/%04d.png, and, for `held_out` > 0, the session held_out/ of noise-free PNG
/// views with their exact poses. The same options give the same bytes whatever `threads` is. Throws
/// core::Error when the place cannot be written.
void write_synthetic_session(const std::filesystem::path& folder, const SyntheticOptions& options,
                             const Progress& progress);

}  // namespace sheen::capture::synthetic
