// SPDX-License-Identifier: MIT
#include "render/surface/budgeted_upload.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace sheen::render {
namespace {

/// Notes what it is handed; a patch takes 10 bytes.
class NotingShader final : public PatchShader {
 public:
  [[nodiscard]] std::string glsl() const override { return {}; }
  std::size_t upload(std::span<const std::uint32_t> patches) override {
    EXPECT_TRUE(std::ranges::is_sorted(patches));
    handed.insert(handed.end(), patches.begin(), patches.end());
    return 10 * patches.size();
  }
  void bind() const override {}

  std::vector<std::uint32_t> handed;
};

std::vector<std::uint32_t> range(std::uint32_t first, std::uint32_t end) {
  std::vector<std::uint32_t> patches;
  for (std::uint32_t i = first; i < end; ++i) patches.push_back(i);
  return patches;
}

// A piece is 64 patches of 10 bytes: a budget of 1000 bytes is used up by two pieces.
TEST(BudgetedUpload, KeepsToItsBudgetAndForgetsNothing) {
  NotingShader shader;
  BudgetedUpload upload(shader, 500);
  upload.add(range(0, 500));
  EXPECT_EQ(upload.waiting(), 500u);
  std::size_t redraws = 0;
  for (; upload.waiting() > 0; ++redraws) EXPECT_LE(upload.send(1000), 1280u);
  EXPECT_EQ(redraws, 4u);  // 500 patches, 128 a redraw
  EXPECT_EQ(shader.handed, range(0, 500));
  EXPECT_EQ(upload.send(1000), 0u);
}

TEST(BudgetedUpload, SendsTheNewestFirst) {
  NotingShader shader;
  BudgetedUpload upload(shader, 500);
  upload.add(range(0, 400));
  upload.send(640);  // patches 0 to 63
  upload.add(range(300, 340));
  upload.send(1);
  EXPECT_EQ(std::vector(shader.handed.begin() + 64, shader.handed.end()), range(300, 340));
  upload.send(1);
  // Then the others in turn; 0 to 63 are not sent again.
  EXPECT_EQ(std::vector(shader.handed.begin() + 104, shader.handed.end()), range(64, 128));
}

// Whatever comes while it sends: every changed patch is handed over after its last change, once per
// wait.
TEST(BudgetedUpload, NoChangeIsLostUnderAStreamOfChanges) {
  std::mt19937 random(7);
  NotingShader shader;
  BudgetedUpload upload(shader, 1000);
  std::vector<bool> stale(1000, false);
  for (int frame = 0; frame < 300; ++frame) {
    std::vector<std::uint32_t> changed;
    for (std::uint32_t i = 0; i < 1000; ++i) {
      if (random() % 10 == 0) changed.push_back(i);
    }
    if (frame < 200) {
      upload.add(changed);
      for (const std::uint32_t patch : changed) stale[patch] = true;
    }
    shader.handed.clear();
    upload.send(500);
    for (const std::uint32_t patch : shader.handed) {
      EXPECT_TRUE(stale[patch]);
      stale[patch] = false;
    }
    EXPECT_EQ(upload.waiting(), static_cast<std::size_t>(std::ranges::count(stale, true)));
  }
  EXPECT_EQ(upload.waiting(), 0u);
}

}  // namespace
}  // namespace sheen::render
