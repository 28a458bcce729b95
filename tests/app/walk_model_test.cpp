// SPDX-License-Identifier: MIT
// The light field that begins before a walk has ended.
#include "app/walk/walk_model.h"

#include "capture/session/session.h"
#include "core/mesh/read_mesh.h"
#include "reconstruction/live/view_directions.h"
#include "tests/app/program.h"

#include <gtest/gtest.h>

#include <atomic>
#include <semaphore>
#include <utility>

namespace sheen::tests {
namespace {

using reconstruction::kViewDirections;
using reconstruction::kViewPlaces;

reconstruction::GrowingHull::News settled() {
  reconstruction::GrowingHull::News news;
  news.is_settled = true;
  news.hull = std::make_shared<const core::Mesh>();
  return news;
}

TEST(WalkIsGoodEnough, OnceEveryPlaceWasLookedFromAtSomeHeightAndTheHullSaysEnough) {
  reconstruction::WalkSight sight;
  // Two of three rings are missing: every place is seen from the lowest.
  for (std::size_t i = kViewPlaces; i < kViewDirections; ++i) sight.missing.push_back(i);
  EXPECT_TRUE(app::is_good_enough(sight, settled()));
  EXPECT_FALSE(app::is_good_enough(sight, {}));
  // 16 views are known; a hull of 12 of them is made of three quarters.
  reconstruction::GrowingHull::News made;
  made.hull = std::make_shared<const core::Mesh>();
  made.views = 12;
  EXPECT_TRUE(app::is_good_enough(sight, made));
  made.views = 11;
  EXPECT_FALSE(app::is_good_enough(sight, made));
  auto doubted = settled();
  doubted.doubt = "more than one object stands on the sheet";
  EXPECT_FALSE(app::is_good_enough(sight, doubted));
  sight.missing.push_back(5);  // now nobody has stood at place 5
  EXPECT_FALSE(app::is_good_enough(sight, settled()));
}

/// Frames at 30 a second.
class ThirtyASecond : public capture::FrameSource {
 public:
  explicit ThirtyASecond(int count) : count_(count) {}
  std::optional<capture::Frame> next() override {
    if (next_ == count_) return std::nullopt;
    capture::Frame frame;
    frame.index = next_++;
    frame.time_s = frame.index / 30.0;
    return frame;
  }
  [[nodiscard]] std::optional<int> frame_count() const override { return count_; }

 private:
  int count_;
  int next_ = 0;
};

TEST(ThinnedInTime, TakesFramesThatLieApart) {
  const auto thinned = app::thinned_in_time(std::make_unique<ThirtyASecond>(10), 0.09);
  std::vector<int> taken;
  while (const auto frame = thinned->next()) taken.push_back(frame->index);
  EXPECT_EQ(taken, (std::vector<int>{0, 3, 6, 9}));
}

/// The sample's frames, which end where the source says so.
class WalkModelOfSample : public testing::Test {
 protected:
  WalkModelOfSample()
      : session_(capture::open_session(sample_session())),
        walk_({.session = sample_session(),
               .board = capture::read_board(*session_.board),
               .camera = session_.camera}) {}

  void look_at_all() {
    const auto frames = capture::open_frames(session_);
    while (auto frame = frames->next()) {
      frame->time_s = frame->index;  // so slowly that the walk looks at every one
      walk_.look_at(*frame);
    }
  }

  app::WalkModel::Parts parts(std::function<std::unique_ptr<capture::FrameSource>()> frames) {
    return {.session = sample_session(),
            .walk = walk_,
            .hull = [this] { return on_the_board(); },
            .frames = std::move(frames),
            .options = {}};
  }

  /// The sample's own mesh in place of a hull.
  [[nodiscard]] reconstruction::GrowingHull::News on_the_board() const {
    core::Mesh mesh = core::read_mesh(session_.mesh);
    const Eigen::Isometry3f placed = session_.board_from_object.cast<float>();
    for (auto& position : mesh.positions) position = placed * position;
    for (auto& normal : mesh.normals) normal = placed.linear() * normal;
    auto news = settled();
    news.hull = std::make_shared<const core::Mesh>(std::move(mesh));
    return news;
  }

  capture::Session session_;
  reconstruction::LiveWalk walk_;
};

/// Tells when its last frame was asked for.
class ToldAtItsEnd : public capture::FrameSource {
 public:
  ToldAtItsEnd(std::unique_ptr<capture::FrameSource> inner, std::binary_semaphore& has_ended)
      : inner_(std::move(inner)), has_ended_(has_ended) {}
  std::optional<capture::Frame> next() override {
    auto frame = inner_->next();
    if (!frame) has_ended_.release();
    return frame;
  }
  [[nodiscard]] std::optional<int> frame_count() const override { return inner_->frame_count(); }

 private:
  std::unique_ptr<capture::FrameSource> inner_;
  std::binary_semaphore& has_ended_;
};

/// The recording from its first frame on, every third of 30 a second: a third of what the camera
/// took, whatever the walk had seen when it began.
TEST_F(WalkModelOfSample, FitsTheRecordingFromItsFirstFrameOn) {
  look_at_all();
  ASSERT_TRUE(app::is_good_enough(walk_.sight(), settled()));
  std::binary_semaphore has_ended(0);
  app::WalkModel model(parts(
      [&] { return std::make_unique<ToldAtItsEnd>(capture::open_frames(session_), has_ended); }));
  has_ended.acquire();
  const auto growth = model.growth();
  ASSERT_NE(growth, nullptr) << model.doubt();
  const int all = *capture::open_frames(session_)->frame_count();
  const auto status = growth->live->status();
  EXPECT_NEAR(status.frames_read, all / 3.0, 2);
  EXPECT_GT(status.frames_fitted, 0.8 * status.frames_read);
  EXPECT_EQ(model.doubt(), "");
}

/// Counts the frames that were asked for, in all.
class Counted : public capture::FrameSource {
 public:
  Counted(std::unique_ptr<capture::FrameSource> inner, std::atomic<int>& count)
      : inner_(std::move(inner)), count_(count) {}
  std::optional<capture::Frame> next() override {
    ++count_;
    return inner_->next();
  }
  [[nodiscard]] std::optional<int> frame_count() const override { return inner_->frame_count(); }

 private:
  std::unique_ptr<capture::FrameSource> inner_;
  std::atomic<int>& count_;
};

/// Whoever closes the window waits for no light field: not before it begins, when no frame is read,
/// and not while it fits, when fewer are read than there are.
TEST_F(WalkModelOfSample, EndsWithoutTheRestOfTheRecording) {
  constexpr int runs = 4;
  std::atomic<int> read = 0;
  const auto frames = [&] {
    return std::make_unique<Counted>(capture::open_frames(session_), read);
  };
  for (int i = 0; i < runs; ++i) const app::WalkModel model(parts(frames));
  EXPECT_EQ(read, 0);
  look_at_all();
  for (int i = 0; i < runs; ++i) const app::WalkModel model(parts(frames));
  EXPECT_LT(read, runs * *capture::open_frames(session_)->frame_count());
}

}  // namespace
}  // namespace sheen::tests
