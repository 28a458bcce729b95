// SPDX-License-Identifier: MIT
#include "app/preview/drawn_part.h"
#include "app/preview/live_session.h"
#include "app/preview/orbit_camera.h"
#include "app/preview/overlay.h"
#include "app/preview/reasons.h"
#include "app/preview/redraw_pace.h"
#include "capture/session/session.h"
#include "core/visibility/ray_visibility.h"
#include "fitting/model_file/model_file.h"
#include "pipeline/reconstruct.h"
#include "tests/app/program.h"
#include "tests/core/shapes.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <numbers>
#include <semaphore>
#include <set>
#include <thread>

namespace sheen::app {
namespace {

OrbitCamera camera_round_a_sphere() {
  return {core::testing::sphere(8, 16), Eigen::Vector3d::UnitZ()};
}

Eigen::Vector3d eye_of(const OrbitCamera& camera) {
  return camera.camera_from_object().inverse().translation();
}

TEST(OrbitCamera, PosesAreRigidAndUpright) {
  OrbitCamera camera = camera_round_a_sphere();
  for (int i = 0; i < 60; ++i) {
    camera.orbit({37.0 * i, 11.0 * (i % 7) - 30}, 500);
    const Eigen::Matrix3d axes = camera.camera_from_object().linear();
    EXPECT_LT((axes * axes.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
    EXPECT_NEAR(axes.determinant(), 1, 1e-9);
    EXPECT_NEAR((axes * Eigen::Vector3d::UnitZ()).x(), 0, 1e-9);  // the horizon is level
    EXPECT_LT((axes * Eigen::Vector3d::UnitZ()).y(), 0);          // and up is up
  }
}

TEST(OrbitCamera, DraggingByTheImagesHeightTurnsHalfRound) {
  OrbitCamera camera = camera_round_a_sphere();
  const Eigen::Vector3d before = eye_of(camera);
  camera.orbit({400, 0}, 400);
  // Half a turn about z: x and y change their signs, z stays.
  const Eigen::Vector3d after = eye_of(camera);
  EXPECT_LT((after - Eigen::Vector3d(-before.x(), -before.y(), before.z())).norm(), 1e-9);
}

TEST(OrbitCamera, PanKeepsThePointUnderTheCursor) {
  OrbitCamera camera = camera_round_a_sphere();
  const core::CameraModel lens = OrbitCamera::lens(800, 600);
  const Eigen::Vector3d centre = camera.object_centre();
  const auto before = lens.project(camera.camera_from_object() * centre);
  camera.pan({40, -25}, 600);
  const auto after = lens.project(camera.camera_from_object() * centre);
  EXPECT_LT((*after - *before - Eigen::Vector2d(40, -25)).norm(), 1e-6);
}

TEST(OrbitCamera, ZoomInAndOutCancel) {
  OrbitCamera camera = camera_round_a_sphere();
  const Eigen::Vector3d before = eye_of(camera);
  camera.zoom(3);
  EXPECT_LT(eye_of(camera).norm(), before.norm());
  camera.zoom(-3);
  EXPECT_LT((eye_of(camera) - before).norm(), 1e-9);
}

TEST(OrbitCamera, FramingShowsAllOfTheObject) {
  const core::Mesh mesh = core::testing::sphere(8, 16);
  OrbitCamera camera(mesh, Eigen::Vector3d::UnitX());
  camera.zoom(8);
  camera.pan({300, 200}, 600);
  camera.frame();
  const core::CameraModel lens = OrbitCamera::lens(600, 600);
  for (const Eigen::Vector3f& position : mesh.positions) {
    const auto pixel = lens.project(camera.camera_from_object() * position.cast<double>());
    ASSERT_TRUE(pixel);
    EXPECT_GT(pixel->minCoeff(), 0);
    EXPECT_LT(pixel->maxCoeff(), 599);
  }
}

TEST(OrbitCamera, StandsWhereItIsTold) {
  OrbitCamera camera = camera_round_a_sphere();
  const Eigen::Vector3d place(2, -3, 1.5);
  camera.stand_at(place);
  EXPECT_LT((eye_of(camera) - place).norm(), 1e-9);
}

TEST(DrawnPart, HoldsWhateverIsInTheBox) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-0.1, -0.05, -0.02),
                                Eigen::Vector3d(0.1, 0.05, 0.08));
  OrbitCamera camera(
      {{{-0.1f, -0.05f, -0.02f}, {0.1f, 0.05f, 0.08f}, {0.1f, -0.05f, 0.0f}},
       {Eigen::Vector3f::UnitZ(), Eigen::Vector3f::UnitZ(), Eigen::Vector3f::UnitZ()},
       {{0, 1, 2}}},
      Eigen::Vector3d::UnitZ());
  const core::CameraModel lens = OrbitCamera::lens(800, 500);
  for (int turn = 0; turn < 12; ++turn) {
    camera.orbit({60, turn % 3 == 0 ? 40.0 : -30.0}, 500);
    const Eigen::Isometry3d pose = camera.camera_from_object();
    const Eigen::AlignedBox2f part = drawn_part(box, lens, pose);
    EXPECT_LT(part.volume(), 0.9f);  // a framed object leaves room round it
    for (int i = 0; i < 125; ++i) {
      const Eigen::Vector3d share(0.25 * (i % 5), 0.25 * (i / 5 % 5), 0.25 * (i / 25));
      const auto pixel = lens.project(pose * (box.min() + share.cwiseProduct(box.sizes())));
      ASSERT_TRUE(pixel);
      const Eigen::Vector2f place((static_cast<float>(pixel->x()) + 0.5f) / 800,
                                  (static_cast<float>(pixel->y()) + 0.5f) / 500);
      EXPECT_TRUE(part.contains(place.cwiseMax(0).cwiseMin(1))) << place.transpose();
    }
  }
}

TEST(DrawnPart, IsEverythingWhenTheBoxReachesBehindTheCamera) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1));
  const auto part = drawn_part(box, OrbitCamera::lens(80, 50), Eigen::Isometry3d::Identity());
  EXPECT_EQ(part.min(), Eigen::Vector2f::Zero());
  EXPECT_EQ(part.max(), Eigen::Vector2f::Ones());
}

/// A clock that redraws tell how long they take.
class PaceOfRedraws : public ::testing::Test {
 protected:
  void redraw(int times, int work_ms, int rest_ms) {
    for (int i = 0; i < times; ++i) {
      pace_.begin(now_);
      pace_.end(now_ += std::chrono::milliseconds(work_ms));
      now_ += std::chrono::milliseconds(rest_ms);
    }
  }
  RedrawPace pace_;
  RedrawPace::Clock::time_point now_{};
};

TEST_F(PaceOfRedraws, RestIsNotWork) {
  redraw(50, 5, 200);
  EXPECT_NEAR(pace_.work_ms(), 5, 0.01);  // 5 ms each, the first, left out, forgotten: 0.8^49
  EXPECT_FALSE(pace_.is_slow());
}

TEST_F(PaceOfRedraws, StaysSlowUntilThereIsRoomForFourTimesThePixels) {
  redraw(50, 40, 0);  // 25 a second
  EXPECT_TRUE(pace_.is_slow());
  redraw(50, 15, 0);  // with a quarter of the pixels; all of them would take up to 60 ms
  EXPECT_TRUE(pace_.is_slow());
  redraw(50, 5, 0);
  EXPECT_FALSE(pace_.is_slow());
  redraw(50, 15, 0);  // with all of them
  EXPECT_FALSE(pace_.is_slow());
}

TEST(Overlay, ArcsKeepTheirDistance) {
  const Eigen::Vector3d centre(1, 2, 3);
  const Eigen::Vector3d from = centre + Eigen::Vector3d(4, 0, 0);
  const Eigen::Vector3d to = centre + Eigen::Vector3d(0, 0, 4);
  const auto arc = arc_between(from, to, centre);
  EXPECT_LT((arc.front() - from).norm(), 1e-9);
  EXPECT_LT((arc.back() - to).norm(), 1e-9);
  for (const Eigen::Vector3d& place : arc) EXPECT_NEAR((place - centre).norm(), 4, 1e-9);
}

TEST(Reasons, EveryRefusalHasWords) {
  using capture::PoseRejection;
  std::set<std::string> words;
  for (const auto rejection :
       {PoseRejection::no_tags, PoseRejection::too_few_tags, PoseRejection::reprojection,
        PoseRejection::blur, PoseRejection::no_pose_in_file}) {
    const std::string text = reason_in_words(name_of(rejection));
    EXPECT_NE(text, name_of(rejection));
    words.insert(text);
  }
  EXPECT_EQ(words.size(), 5u);
  EXPECT_EQ(reason_in_words("blur"), "moving too fast: blur");
}

/// The first frames of the sample recording through the real pipeline, with a live session that
/// nobody looks at.
class LivePipeline : private pipeline::FrameListener {
 public:
  explicit LivePipeline(int frames)
      : fitted_({.session = capture::open_session(tests::sample_session()),
                 .make_visibility = core::make_ray_visibility},
                options(frames), sink_),
        live_({.model = fitted_.model(),
               .history = fitted_.history(),
               .baseline = nullptr,
               .mesh = fitted_.mesh(),
               .camera = fitted_.session().camera,
               .board_from_object = fitted_.session().board_from_object,
               .limits = {},
               .save = [this](const fitting::LightField& light_field) {
                 fitting::write_model(folder_ / "early.glb", fitted_.mesh(), light_field);
                 return std::string("saved");
               }}) {}

  using Admit = std::function<bool(int frame)>;
  using OnFrame = std::function<void(int frame, LiveSession&)>;

  /// Runs to the end; `admit` may keep samples out, `on_frame` comes before the session's.
  void run(const Admit& admit, const OnFrame& on_frame) {
    admit_ = admit;
    on_frame_ = on_frame;
    fitted_.run(sink_, this);
  }

  /// The model as it is, on the thread that fits.
  [[nodiscard]] std::string model_bytes() {
    fitting::write_model(folder_ / "model.glb", fitted_.mesh(), fitted_.light_field());
    return tests::read_file(folder_ / "model.glb");
  }
  [[nodiscard]] std::string early_copy() const { return tests::read_file(folder_ / "early.glb"); }
  [[nodiscard]] LiveSession& live() { return live_; }

 private:
  static pipeline::ReconstructionOptions options(int frames) {
    return {.representation = "sh", .frames = {.end = frames}, .undoable = true};
  }
  bool admit(const core::SampleBatch& batch) override {
    return admit_(frame_) && live_.admit(batch);
  }
  void on_frame(const pipeline::TrackedFrame& tracked,
                const pipeline::FrameStatistics& frames) override {
    on_frame_(frame_++, live_);
    live_.on_frame(tracked, frames);
  }

  tests::TemporaryFolder folder_;
  pipeline::ProgressSink sink_;
  pipeline::Reconstruction fitted_;
  LiveSession live_;
  Admit admit_;
  OnFrame on_frame_;
  int frame_ = 0;
};

bool always(int /*frame*/) {
  return true;
}

TEST(LiveSession, UndoneFramesHaveNeverBeenSeen) {
  // At 30 frames a second, .3 s asked for after frame 19 are frames 11 to 19: 9 frames whose time
  // is later than that of frame 19 less .3 s.
  LivePipeline undone(30);
  undone.run(always, [](int frame, LiveSession& live) {
    if (frame == 19) live.request_undo(0.3 - 1e-3);
  });
  LivePipeline never_saw(30);
  never_saw.run([](int frame) { return frame < 11 || frame > 19; }, [](int, LiveSession&) {});
  EXPECT_EQ(undone.model_bytes(), never_saw.model_bytes());
  EXPECT_EQ(undone.live().status().frames_undone, 9);
  EXPECT_EQ(undone.live().status().frames_fitted, 21);
  EXPECT_EQ(undone.live().path_since(0, 0).poses.size(), 21u);
}

/// Somebody in front of the window, who looks whenever there is something new to see.
class Person {
 public:
  explicit Person(LiveSession& live) : live_(live) {
    live.set_wake([this] { news_.release(); });
  }
  ~Person() { live_.set_wake({}); }
  Person(const Person&) = delete;
  Person& operator=(const Person&) = delete;
  Person(Person&&) = delete;
  Person& operator=(Person&&) = delete;

  /// Waits until it sees something; false when it never does, which nobody should wait for.
  template <typename Condition>
  bool sees(const Condition& condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!condition(live_.status())) {
      if (!news_.try_acquire_until(deadline)) return false;
    }
    return true;
  }

 private:
  LiveSession& live_;
  std::counting_semaphore<> news_{0};
};

TEST(LiveSession, PausedRunsWaitAndSaveMeanwhile) {
  LivePipeline pipeline(6);
  Person person(pipeline.live());
  bool saw_all = false;
  // Asks for a copy and then lets it go on, once it is paused. A run that did not wait would be
  // further on, or over, when it is asked.
  std::jthread thread([&] {
    saw_all = person.sees(
        [](const LiveStatus& status) { return status.phase == LiveStatus::Phase::paused; });
    pipeline.live().request_save();
    saw_all &= person.sees([](const LiveStatus& status) { return status.note == "saved"; });
    pipeline.live().set_paused(false);
  });
  std::string after_four;
  pipeline.run(always, [&](int frame, LiveSession& live) {
    if (frame != 3) return;
    after_four = pipeline.model_bytes();
    live.set_paused(true);
  });
  thread.join();
  EXPECT_TRUE(saw_all);
  EXPECT_EQ(pipeline.live().status().frames_fitted, 6);
  // The copy holds four frames, the model six.
  EXPECT_TRUE(pipeline.early_copy() == after_four);
  EXPECT_FALSE(pipeline.model_bytes() == after_four);
}

}  // namespace
}  // namespace sheen::app
