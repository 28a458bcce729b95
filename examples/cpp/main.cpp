// SPDX-License-Identifier: MIT
// A light field from a recorded session, in a program of one's own: example SESSION MODEL.glb
#include <sheen/core/diagnostics/error.h>
#include <sheen/fitting/model_file/model_file.h>
#include <sheen/fitting/patch_light_field.h>
#include <sheen/pipeline/reconstruct.h>

#include <cstdio>

int main(int argc, char** argv) try {
  if (argc != 3) return std::fputs("usage: example SESSION MODEL.glb\n", stderr), 2;

  // Pose every frame and fit; a sink of one's own hears of every frame, and cancels by throwing.
  sheen::pipeline::ProgressSink silent;
  const auto fitted =
      sheen::pipeline::reconstruct({sheen::capture::open_session(argv[1])}, {.threads = 2}, silent);
  std::printf("%zu of %d frames posed\n", fitted.frames().posed.size(),
              fitted.frames().frames_read);

  // Ask what patch 0 looks like from straight above: (0, 0) is the middle of the disc of
  // directions.
  const auto& patches = sheen::fitting::require_patches(fitted.light_field(), "this example");
  const auto rgb = patches.evaluate(0, {0, 0}).colour();
  std::printf("patch 0 from above: sRGB %.3f %.3f %.3f\n", static_cast<double>(rgb.x()),
              static_cast<double>(rgb.y()), static_cast<double>(rgb.z()));

  sheen::fitting::write_model(argv[2], fitted.mesh(), fitted.light_field(), fitted.frames().seen);
  return 0;
} catch (const sheen::core::Error& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
