// SPDX-License-Identifier: MIT
// The web viewer fades to mean colours where nobody looked; where people do look that must cost
// nothing.
#include "capture/session/session.h"
#include "evaluation/views/evaluate_views.h"
#include "fitting/confidence/confidence.h"
#include "fitting/model_file/model_file.h"
#include "fitting/patch_light_field.h"
#include "pipeline/pose_frames.h"
#include "render/surface/surface_renderer.h"
#include "tests/app/program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>

namespace sheen {
namespace {

/// A light field as web/viewer/surface_vertex.glsl shows it.
class FadedLightField final : public fitting::PatchLightField {
 public:
  FadedLightField(const fitting::PatchLightField& original, const fitting::SeenDirections& seen)
      : original_(original) {
    for (const auto cells : seen) confidence_.push_back(fitting::confidence_cells(cells));
  }

  [[nodiscard]] std::string_view representation() const override { return "faded"; }
  [[nodiscard]] std::size_t coefficient_count() const override { return 0; }
  [[nodiscard]] std::size_t patch_count() const override { return original_.patch_count(); }
  [[nodiscard]] fitting::WeightedColour evaluate(std::size_t patch_idx,
                                                 const Eigen::Vector2f& uv) const override {
    fitting::WeightedColour shown = original_.evaluate(patch_idx, uv);
    const float kept =
        std::min(2.0f * fitting::confidence_towards(confidence_[patch_idx], uv), 1.0f);
    shown.colour_sum = kept * shown.colour_sum +
                       (1.0f - kept) * shown.weight_sum * original_.mean_colour(patch_idx);
    return shown;
  }
  [[nodiscard]] Eigen::Vector3f mean_colour(std::size_t patch_idx) const override {
    return original_.mean_colour(patch_idx);
  }
  [[nodiscard]] const std::vector<std::uint8_t>& observed() const override {
    return original_.observed();
  }

 private:
  const fitting::PatchLightField& original_;
  std::vector<fitting::ConfidenceCells> confidence_;
};

TEST(Fading, CostsNothingOnViewsLikeThoseOfTheFit) {
  // Fit the sample.
  const tests::TemporaryFolder folder;
  const auto run = tests::run_sheen({"replay", tests::sample_session().string(), "-o",
                                     folder / "model.glb", "--patches", "vertex", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  const fitting::Model model = fitting::read_model(folder / "model.glb");
  ASSERT_EQ(model.seen.size(), model.mesh.positions.size());
  const auto& patches = fitting::require_patches(*model.light_field, "this test");
  const FadedLightField faded(patches, model.seen);

  // Compare both with views that the fit never saw.
  const capture::Session session = capture::open_session(tests::sample_session() / "held_out");
  pipeline::ProgressSink silent;
  const auto views = pipeline::pose_frames(session, {}, silent);
  const auto gl = render::make_osmesa_context();
  const auto plain_renderer = render::make_gl_surface_renderer(*gl, model.mesh, patches);
  const auto faded_renderer = render::make_gl_surface_renderer(*gl, model.mesh, faded);
  const std::array<render::Renderer*, 2> renderers{plain_renderer.get(), faded_renderer.get()};
  const auto summaries =
      evaluation::evaluate_views(*gl, {session, model.mesh, views}, renderers, [](const auto&) {});
  const double lost_db = summaries[0].mean.psnr_db - summaries[1].mean.psnr_db;
  std::printf("faded %.3f dB, as fitted %.3f dB\n", summaries[1].mean.psnr_db,
              summaries[0].mean.psnr_db);
  // Measured: 0.003 dB.
  EXPECT_LT(lost_db, 0.02);
}

}  // namespace
}  // namespace sheen
