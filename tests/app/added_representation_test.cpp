// SPDX-License-Identifier: MIT
// A representation that the library does not know, added from outside by one descriptor: everything
// that takes light fields takes it.
#include "app/commands/representation_options.h"
#include "app/preview/live_session.h"
#include "core/diagnostics/error.h"
#include "evaluation/comparison/comparison_tables.h"
#include "evaluation/comparison/measure_candidate.h"
#include "evaluation/study/methods.h"
#include "evaluation/views/evaluate_views.h"
#include "fitting/descriptor.h"
#include "fitting/model_file/model_file.h"
#include "fitting/model_file/model_part.h"
#include "fitting/patch_fitter.h"
#include "pipeline/reconstruct.h"
#include "pipeline/session_parts.h"
#include "render/gl/functions.h"
#include "render/gl/offscreen_target.h"
#include "render/renderer.h"
#include "render/surface/object_mask.h"
#include "tests/app/program.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>

namespace sheen::tests {
namespace {

constexpr const char* kName = "frame-colours";

// ---- the representation ----

/// What one frame leaves behind; six numbers.
struct FrameColour {
  Eigen::Vector3f eye;  ///< object frame, metres
  Eigen::Vector3f rgb;  ///< sRGB, [0, 1]
};

struct FrameColourOptions {
  double gain = 1;  ///< on every colour
  void check() const {}
};

fitting::OptionTable option_table(FrameColourOptions& options) {
  return {fitting::number_option("gain", options.gain, 0.0, 1.0, "Factor on every colour")};
}

/// One colour per frame, shown all over the object from that side: no patches, and as many elements
/// as frames.
class FrameColours final : public fitting::LightField {
 public:
  FrameColours() = default;
  explicit FrameColours(std::vector<FrameColour> frames) : frames_(std::move(frames)) {}

  [[nodiscard]] std::string_view representation() const override { return kName; }
  [[nodiscard]] std::size_t coefficient_count() const override { return 6 * frames_.size(); }
  [[nodiscard]] std::size_t element_count() const override { return frames_.size(); }
  [[nodiscard]] std::vector<Eigen::Vector3f> vertex_colours(const core::Mesh& mesh) const override {
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (const FrameColour& frame : frames_) mean += frame.rgb;
    if (!frames_.empty()) mean /= static_cast<float>(frames_.size());
    return std::vector<Eigen::Vector3f>(mesh.positions.size(), mean);
  }

  [[nodiscard]] const std::vector<FrameColour>& frames() const { return frames_; }
  void add(const FrameColour& frame) { frames_.push_back(frame); }

 private:
  std::vector<FrameColour> frames_;
};

/// Looks at the image itself: the mean of the pixels at which vertices are seen.
class FrameColourFitter final : public fitting::Fitter {
 public:
  explicit FrameColourFitter(float gain) : gain_(gain) {}

  const fitting::ModelUpdate& integrate(const core::Observation& observation) override {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    int seen = 0;
    for (std::size_t i = 0; i < observation.view.rejection.size(); ++i) {
      if (observation.view.rejection[i] != core::VertexRejection::none) continue;
      const auto bgr =
          observation.image.at<cv::Vec3b>(static_cast<int>(std::lround(observation.view.y_px[i])),
                                          static_cast<int>(std::lround(observation.view.x_px[i])));
      sum += Eigen::Vector3f(bgr[2], bgr[1], bgr[0]) / 255.0f;
      ++seen;
    }
    const auto element = static_cast<std::uint32_t>(colours_.element_count());
    update_.elements = {element};
    samples_ += observation.samples.size();
    colours_.add({core::eye_in_object(observation.camera_from_object),
                  gain_ * sum / static_cast<float>(std::max(1, seen))});
    return update_;
  }
  const fitting::ModelUpdate& finish() override {
    update_.elements.clear();
    return update_;
  }
  [[nodiscard]] const fitting::LightField& light_field() const override { return colours_; }
  [[nodiscard]] fitting::FitStatistics statistics() const override { return {.samples = samples_}; }

 private:
  float gain_;
  FrameColours colours_;
  fitting::ModelUpdate update_;
  std::size_t samples_ = 0;
};

/// The object all in the colour of the frame nearest by direction. Colours are taken over by
/// `upload`, as from a GPU's memory.
class FrameColourRenderer final : public render::Renderer {
 public:
  FrameColourRenderer(render::Context& context, const core::Mesh& mesh, const FrameColours& colours)
      : colours_(colours), uploaded_(colours.frames()), object_(context, mesh) {}

  std::size_t upload(std::span<const std::uint32_t> elements) override {
    for (const std::uint32_t element : elements) {
      uploaded_.resize(std::max<std::size_t>(uploaded_.size(), element + 1));
      uploaded_[element] = colours_.frames()[element];
    }
    return elements.size() * sizeof(FrameColour);
  }

  render::RenderedView render(const core::CameraModel& camera,
                              const Eigen::Isometry3d& camera_from_object) override {
    const cv::Mat mask = object_.seen_by(camera, camera_from_object);
    cv::Mat image(mask.size(), CV_8UC3, cv::Scalar::all(0));
    const Eigen::Vector3f eye = core::eye_in_object(camera_from_object).normalized();
    const auto nearest = std::ranges::max_element(
        uploaded_, {}, [&](const FrameColour& frame) { return frame.eye.normalized().dot(eye); });
    if (nearest != uploaded_.end()) {
      const Eigen::Vector3f& rgb = nearest->rgb;
      image.setTo(255 * cv::Scalar(rgb.z(), rgb.y(), rgb.x()), mask);
    }
    return {image, mask, mask.clone()};
  }

  [[nodiscard]] bool reads_light_field() const override { return false; }

 private:
  const FrameColours& colours_;
  std::vector<FrameColour> uploaded_;
  render::ObjectMask object_;
};

fitting::ModelPart encode(const fitting::LightField& light_field) {
  const auto& frames = dynamic_cast<const FrameColours&>(light_field).frames();
  fitting::ModelPart part;
  part.parameters = {{"frames", frames.size()}};
  part.arrays["frames"] = std::as_bytes(std::span(frames));
  return part;
}

std::unique_ptr<const fitting::LightField> decode(const fitting::ModelPart& part,
                                                  const core::Mesh& /*mesh*/) {
  const std::size_t count = fitting::required_size(part.parameters, "frames");
  std::vector<FrameColour> frames(count);
  const auto bytes = fitting::required_bytes(part, "frames", count * sizeof(FrameColour));
  if (count > 0) std::memcpy(static_cast<void*>(frames.data()), bytes.data(), bytes.size());
  return std::make_unique<FrameColours>(std::move(frames));
}

constinit const fitting::Descriptor kFrameColours{
    .name = kName,
    .sentence = "one colour per frame",
    .default_options = fitting::new_options<FrameColourOptions>,
    .make = [](const core::Mesh& /*mesh*/, const fitting::FitOptions& options,
               int /*threads*/) -> std::unique_ptr<fitting::Fitter> {
      return std::make_unique<FrameColourFitter>(
          static_cast<float>(fitting::options_as<FrameColourOptions>(options).gain));
    },
    .encode = encode,
    .decode = decode,
    .make_renderer = [](render::Context& context, const core::Mesh& mesh,
                        const fitting::LightField& light_field,
                        int /*threads*/) -> std::unique_ptr<render::Renderer> {
      return std::make_unique<FrameColourRenderer>(context, mesh,
                                                   dynamic_cast<const FrameColours&>(light_field));
    }};

// ---- what takes it ----

std::string bits_of(const fitting::LightField& light_field) {
  const auto bytes =
      std::as_bytes(std::span(dynamic_cast<const FrameColours&>(light_field).frames()));
  EXPECT_FALSE(bytes.empty());
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Keeps out what it is told to, and asks for something after a frame.
class Listener final : public pipeline::FrameListener {
 public:
  std::function<bool(int frame, const core::SampleBatch&)> admit_;
  bool admit(const core::SampleBatch& batch) override { return !admit_ || admit_(frame_, batch); }
  void on_frame(const pipeline::TrackedFrame& /*tracked*/,
                const pipeline::FrameStatistics& /*frames*/) override {
    ++frame_;
  }

 private:
  int frame_ = 0;
};

/// Over the first 12 frames of the sample recording; frames 2, 6 and 10 are held out
/// (index % 4 == 2).
class AddedRepresentation : public testing::Test {
 protected:
  static void SetUpTestSuite() { fitting::register_representation(kFrameColours); }

  static pipeline::ReconstructionOptions options() {
    return {.representation = kName, .frames = {.end = 12, .hold_out = 4}};
  }
  pipeline::Reconstruction reconstruct(const pipeline::ReconstructionOptions& wanted = options(),
                                       pipeline::FrameListener* listener = nullptr) {
    pipeline::Reconstruction fitted({.session = capture::open_session(sample_session())}, wanted,
                                    sink_);
    fitted.run(sink_, listener);
    return fitted;
  }

  pipeline::ProgressSink sink_;
};

TEST_F(AddedRepresentation, IsListedOnceWithItsOptions) {
  EXPECT_EQ(fitting::representations().back(), &kFrameColours);
  EXPECT_EQ(&fitting::representation_named(kName), &kFrameColours);
  EXPECT_THROW(fitting::register_representation(kFrameColours), std::invalid_argument);
  // The command line has its option, which implies it and applies to it only.
  EXPECT_EQ(app::resolve_representation("", {{"gain", "0.5"}}).representation, kName);
  EXPECT_THROW(app::resolve_representation("sparse", {{"gain", "0.5"}}), app::UsageError);
  EXPECT_THROW(app::resolve_representation(kName, {{"gain", "2"}}), std::invalid_argument);
  // Comparisons of whole recordings have it, studies of single patches cannot.
  const auto candidates = evaluation::all_candidates();
  EXPECT_EQ(candidates.back().name, kName);
  EXPECT_EQ(candidates.back().representation, kName);
  for (const evaluation::Method& method : evaluation::all_methods()) {
    EXPECT_NE(method.representation, kName);
  }
  EXPECT_THROW(fitting::make_isolated_patches(kName, 3), std::invalid_argument);
}

// Every fitted frame gives one colour: that of its samples, which are interpolated between pixels
// where the fitter takes the nearest one.
TEST_F(AddedRepresentation, IsReconstructedFromTheImages) {
  std::vector<Eigen::Vector3f> sampled;
  Listener listener;
  listener.admit_ = [&](int /*frame*/, const core::SampleBatch& batch) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < batch.size(); ++i) {
      sum += Eigen::Vector3f(batch.r[i], batch.g[i], batch.b[i]).cast<double>();
    }
    sampled.push_back((sum / static_cast<double>(batch.size())).cast<float>());
    return true;
  };
  const auto fitted = reconstruct(options(), &listener);
  const auto& frames = dynamic_cast<const FrameColours&>(fitted.light_field()).frames();
  ASSERT_EQ(frames.size(), 9u);
  ASSERT_EQ(sampled.size(), 9u);
  EXPECT_EQ(fitted.frames().frames_fitted, 9);
  double worst = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    worst =
        std::max(worst, static_cast<double>((frames[i].rgb - sampled[i]).cwiseAbs().maxCoeff()));
    EXPECT_GT(sampled[i].minCoeff(), 0.05f);
  }
  EXPECT_LT(worst, 0.01);

  // Its option arrives.
  auto half = options();
  half.fit = {{"gain", "0.5"}};
  const auto darker = reconstruct(half);
  const auto& dark = dynamic_cast<const FrameColours&>(darker.light_field()).frames();
  for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_EQ(dark[i].rgb, 0.5f * frames[i].rgb);
}

TEST_F(AddedRepresentation, IsReadBackBitByBit) {
  const TemporaryFolder folder;
  const auto fitted = reconstruct();
  fitting::write_model(folder / "a.glb", fitted.mesh(), fitted.light_field());
  const fitting::Model read = fitting::read_model(folder / "a.glb");
  EXPECT_EQ(read.light_field->representation(), kName);
  EXPECT_EQ(bits_of(*read.light_field), bits_of(fitted.light_field()));
  EXPECT_EQ(fitting::byte_size(*read.light_field), 9 * sizeof(FrameColour));
  fitting::write_model(folder / "b.glb", read.mesh, *read.light_field);
  EXPECT_TRUE(read_file(folder / "a.glb") == read_file(folder / "b.glb"));
}

/// What `upload` has not taken over is not shown, and a window's target shows what an image does.
TEST_F(AddedRepresentation, IsDrawnByItsOwnRenderer) {
  const auto fitted = reconstruct();
  FrameColours colours;
  const auto context = render::make_osmesa_context();
  const auto renderer = render::make_renderer(*context, fitted.mesh(), colours);
  const core::CameraModel& camera = fitted.session().camera;
  const Eigen::Isometry3d pose =
      fitted.frames().posed.front().camera_from_board * fitted.session().board_from_object;
  const cv::Mat mask = render::ObjectMask(*context, fitted.mesh()).seen_by(camera, pose);
  const auto expect_colour = [&](const Eigen::Vector3f& rgb) {
    const render::RenderedView view = renderer->render(camera, pose);
    cv::Mat expected(mask.size(), CV_8UC3, cv::Scalar::all(0));
    expected.setTo(255 * cv::Scalar(rgb.z(), rgb.y(), rgb.x()), mask);
    EXPECT_EQ(cv::norm(view.image, expected, cv::NORM_INF), 0);
    return view.image;
  };
  colours.add({{0, 0, 1}, {0.25f, 0.5f, 0.75f}});
  expect_colour({0, 0, 0});
  EXPECT_EQ(renderer->upload(std::array<std::uint32_t, 1>{0}), sizeof(FrameColour));
  const cv::Mat image = expect_colour({0.25f, 0.5f, 0.75f});

  context->make_current();
  const render::gl::Functions gl = render::gl::load_functions(*context);
  render::gl::OffscreenTarget target(gl, render::gl::Colour::bytes);
  renderer->draw(target, camera, pose);
  gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer(camera.width_px(), camera.height_px()));
  cv::Mat drawn(mask.size(), CV_8UC4);
  gl.ReadPixels(0, 0, drawn.cols, drawn.rows, GL_BGRA, GL_UNSIGNED_BYTE, drawn.data);
  std::array<cv::Mat, 2> planes{cv::Mat(mask.size(), CV_8UC3), cv::Mat(mask.size(), CV_8UC1)};
  cv::mixChannels(&drawn, 1, planes.data(), 2, std::array<int, 8>{0, 0, 1, 1, 2, 2, 3, 3}.data(),
                  4);
  EXPECT_EQ(cv::norm(planes[0], image, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(planes[1], mask, cv::NORM_INF), 0);  // everything shown is supported
}

/// A model that shows nothing in the left half of the image.
class HalfRenderer final : public render::Renderer {
 public:
  explicit HalfRenderer(render::Renderer& inner) : inner_(inner) {}
  std::size_t upload(std::span<const std::uint32_t> elements) override {
    return inner_.upload(elements);
  }
  render::RenderedView render(const core::CameraModel& camera,
                              const Eigen::Isometry3d& camera_from_object) override {
    render::RenderedView view = inner_.render(camera, camera_from_object);
    const cv::Rect left(0, 0, view.image.cols / 2, view.image.rows);
    for (cv::Mat* plane : {&view.image, &view.mask, &view.support}) (*plane)(left).setTo(0);
    return view;
  }

 private:
  render::Renderer& inner_;
};

/// -10 log10 of the mean squared error over the mask, pixel by pixel.
double psnr_by_hand(const cv::Mat& image, const cv::Mat& photograph, const cv::Mat& mask) {
  double squared = 0;
  double values = 0;
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      if (mask.at<std::uint8_t>(y, x) == 0) continue;
      for (int channel = 0; channel < 3; ++channel) {
        const double difference =
            (image.at<cv::Vec3b>(y, x)[channel] - photograph.at<cv::Vec3b>(y, x)[channel]) / 255.0;
        squared += difference * difference;
        ++values;
      }
    }
  }
  return -10 * std::log10(squared / values);
}

// Both are measured over all of the object, whatever they cover themselves.
TEST_F(AddedRepresentation, IsEvaluatedOverTheWholeObject) {
  const auto fitted = reconstruct();
  ASSERT_EQ(fitted.frames().held_out.size(), 3u);
  const auto context = render::make_osmesa_context();
  const auto whole = render::make_renderer(*context, fitted.mesh(), fitted.light_field());
  HalfRenderer half(*whole);
  render::Renderer* const renderers[] = {whole.get(), &half};
  render::ObjectMask object(*context, fitted.mesh());
  std::vector<double> expected[2];
  const auto summaries = evaluation::evaluate_views(
      *context, {fitted.session(), fitted.mesh(), fitted.frames().held_out}, renderers,
      [&](const evaluation::ComparedView& view) {
        const auto& posed = fitted.frames().held_out[expected[0].size()];
        const core::CameraModel& camera = fitted.session().camera;
        const auto pose = posed.camera_from_board * fitted.session().board_from_object;
        const cv::Mat counted = core::eroded(object.seen_by(camera, pose), 2);
        render::RenderedView drawn = whole->render(camera, pose);
        expected[0].push_back(psnr_by_hand(drawn.image, view.photograph.image, counted));
        drawn.image.colRange(0, drawn.image.cols / 2).setTo(0);
        expected[1].push_back(psnr_by_hand(drawn.image, view.photograph.image, counted));
      });
  ASSERT_EQ(summaries.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_EQ(summaries[i].views.size(), 3u);
    for (std::size_t view = 0; view < 3; ++view) {
      EXPECT_NEAR(summaries[i].views[view].error.psnr_db, expected[i][view], 1e-6);
    }
  }
  EXPECT_EQ(summaries[0].covered_fraction, 1);
  EXPECT_LT(summaries[1].covered_fraction, 0.9);
  EXPECT_EQ(summaries[0].mean.pixels, summaries[1].mean.pixels);
  // A colour from the frame beside is nearer to the object than black.
  EXPECT_GT(summaries[0].mean.psnr_db, summaries[1].mean.psnr_db + 1);
}

TEST_F(AddedRepresentation, IsComparedWithTheOthers) {
  const TemporaryFolder folder;
  // A session without held_out/ views of its own, so that frames 2, 6 and 10 are held out again.
  const auto session = folder / "session";
  std::filesystem::copy(sample_session(), session);
  const auto observations =
      evaluation::observe_session(session, {.end = 12, .hold_out = 4}, false, 1, sink_);
  const auto context = render::make_osmesa_context();
  evaluation::Comparison comparison;
  comparison.sessions.push_back({"session", session, 9, 3, false});
  for (const evaluation::Candidate& candidate : evaluation::candidates_named({"mean", kName})) {
    const auto measured = evaluation::measure_candidate(candidate, observations, *context,
                                                        folder / "scratch.glb", 1, sink_);
    comparison.rows.push_back({"session", candidate, measured, {}});
  }
  ASSERT_EQ(comparison.rows.size(), 2u);
  const evaluation::CandidateMeasurement& mean = comparison.rows[0].measured;
  const evaluation::CandidateMeasurement& colours = comparison.rows[1].measured;
  EXPECT_EQ(comparison.rows[1].candidate.name, kName);
  EXPECT_EQ(colours.views, 3u);
  EXPECT_EQ(colours.samples, mean.samples);
  EXPECT_EQ(colours.patches, 0u);
  EXPECT_EQ(colours.coefficients, 9u * 6u);
  // Colours of patches against one for the whole object.
  EXPECT_GT(mean.error.psnr_db, colours.error.psnr_db);
  EXPECT_FALSE(std::filesystem::exists(folder / "scratch.glb"));

  // The same figures as an evaluation of the same fit.
  const auto fitted = reconstruct();
  const auto renderer = render::make_renderer(*context, fitted.mesh(), fitted.light_field());
  render::Renderer* const renderers[] = {renderer.get()};
  const auto evaluated = evaluation::evaluate_views(
      *context, {fitted.session(), fitted.mesh(), fitted.frames().held_out}, renderers,
      [](const evaluation::ComparedView&) {});
  EXPECT_DOUBLE_EQ(colours.error.psnr_db, evaluated.front().mean.psnr_db);

  // Tables hold numbers, with no patches to share them among.
  const auto document = evaluation::to_json(comparison, {});
  for (const auto& [name, value] : document.at("results").at(1).items()) {
    EXPECT_FALSE(value.is_number_float() && !std::isfinite(value.get<double>())) << name;
  }
  const std::string text = evaluation::to_text(comparison) + evaluation::to_csv(comparison);
  EXPECT_NE(text.find(kName), std::string::npos);
  EXPECT_EQ(text.find("inf"), std::string::npos) << text;
  EXPECT_EQ(text.find("nan"), std::string::npos) << text;
  EXPECT_EQ(text.find("null"), std::string::npos) << text;
}

// Nothing of a view is kept but its frame's number: undo reads the frames again.
TEST_F(AddedRepresentation, ForgetsViewsByObservingTheOthersAgain) {
  auto undoable = options();
  undoable.undoable = true;
  auto fitted = reconstruct(undoable);
  ASSERT_TRUE(fitted.history()->can_undo());
  std::size_t looked = 0;
  fitted.history()->undo(4, [&](const core::SampleBatch& batch, const fitting::LightField& before) {
    EXPECT_GT(batch.size(), 0u);
    EXPECT_EQ(before.element_count(), looked++);
  });
  EXPECT_EQ(looked, 5u);

  // Frames 0, 1, 3, 4, 5 stay of 0, 1, 3, 4, 5, 7, 8, 9, 11.
  Listener first_five;
  first_five.admit_ = [](int frame, const core::SampleBatch&) { return frame < 6; };
  const auto never_saw = reconstruct(options(), &first_five);
  EXPECT_EQ(never_saw.light_field().element_count(), 5u);
  EXPECT_EQ(bits_of(fitted.light_field()), bits_of(never_saw.light_field()));
  EXPECT_EQ(fitted.fit_statistics().samples, never_saw.fit_statistics().samples);
}

TEST_F(AddedRepresentation, IsRefusedByWhatNeedsPatches) {
  const auto expect_refused = [&](const std::string& purpose, const auto& demand) {
    auto demanding = options();
    demand(demanding);
    try {
      reconstruct(demanding);
      ADD_FAILURE() << purpose << " was accepted";
    } catch (const core::Error& error) {
      EXPECT_EQ(error.kind(), core::Error::Kind::bad_input);
      EXPECT_EQ(std::string(error.what()),
                "representation frame-colours: " + purpose +
                    " needs a light field of patches; choose another --representation, such as "
                    "sparse");
    }
  };
  expect_refused("--refuse-mismatches",
                 [](auto& demanding) { demanding.refuse_mismatches = true; });
  expect_refused("--refine-poses",
                 [](auto& demanding) { demanding.photometric.refine_poses = true; });
  expect_refused("--exposure", [](auto& demanding) { demanding.photometric.exposure = true; });
}

}  // namespace
}  // namespace sheen::tests
