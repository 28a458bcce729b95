// SPDX-License-Identifier: MIT
#include "capture/source/video_source.h"
#include "core/geometry/tangent_frame.h"
#include "core/mesh/read_mesh.h"
#include "exporters/format.h"
#include "exporters/viewer/first_view.h"
#include "fitting/detail/detail_light_field.h"
#include "tests/app/program.h"
#include "tests/fitting/models_for_tests.h"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include <memory>
#include <string>

namespace sheen::tests {
namespace {

class Export : public ::testing::Test {
 protected:
  void write(const std::string& representation) {
    const core::Mesh mesh = fitting::testing::octahedron();
    const auto fitter = fitting::testing::fitted(representation, mesh);
    fitting::write_model(folder_ / "model.glb", mesh, fitter->light_field(), seen_);
  }

  /// Whether the program refuses with exit code 2 and one line that holds a word.
  void expect_refused(const std::vector<std::string>& options, const std::string& word) {
    std::vector<std::string> arguments{"export", folder_ / "model.glb", "--quiet"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProgramRun run = run_sheen(arguments);
    EXPECT_EQ(run.exit_code, 2) << run.standard_error;
    EXPECT_NE(run.standard_error.find(word), std::string::npos) << run.standard_error;
    EXPECT_EQ(std::count(run.standard_error.begin(), run.standard_error.end(), '\n'), 1);
  }

  TemporaryFolder folder_;
  fitting::SeenDirections seen_;
};

TEST_F(Export, EveryRepresentationThatThePageDrawsBecomesOne) {
  for (const char* name : {"sparse", "iwls", "mean", "sh"}) {
    write(name);
    const ProgramRun run = run_sheen({"export", folder_ / "model.glb", "-o", folder_ / "m.html",
                                      "--title", "</script><b>", "--json", "--quiet"});
    ASSERT_EQ(run.exit_code, 0) << run.standard_error;
    EXPECT_GT(run.json()["cost"]["difference_db"].get<double>(), 50.0) << name;
    const std::string page = read_file(folder_ / "m.html");
    EXPECT_NE(page.find("&lt;/script&gt;&lt;b&gt;"), std::string::npos);
    EXPECT_EQ(page.find("<b>"), std::string::npos);
    EXPECT_EQ(page.find("http"), std::string::npos) << "the page must not reach out";
  }
}

// The page blends anchors as the renderer does; only coefficients are rounded. The other formats
// ask the model.
TEST_F(Export, DirectionsAtAnchorsArePartOfThePage) {
  namespace detail = fitting::detail;
  const core::Mesh mesh = fitting::testing::octahedron();
  detail::DetailLightField model(mesh, core::make_atlas(mesh, 0.01f, std::size_t{1} << 20));
  fitting::sparse::LightFieldModel said = detail::no_offsets(std::vector<std::uint8_t>(1, 1));
  fitting::sparse::PatchModel brighter_above;
  brighter_above.base_terms = fitting::sparse::kLinearBase;
  brighter_above.coefficient.fill(Eigen::Vector3f::Zero());
  brighter_above.coefficient[3].setConstant(0.3f);
  said.store(0, brighter_above);
  model.set_anchors(std::make_shared<const detail::AnchoredOffsets>(
      mesh, std::vector<detail::AnchorLevel>{{{0}, 10.0f}}, detail::AskedDirection::same,
      std::move(said)));
  fitting::write_model(folder_ / "model.glb", mesh, model, seen_);
  for (const char* file : {"m.html", "m.ply"}) {
    const ProgramRun run =
        run_sheen({"export", folder_ / "model.glb", "-o", folder_ / file, "--json", "--quiet"});
    ASSERT_EQ(run.exit_code, 0) << run.standard_error;
    const auto difference_db = run.json()["cost"]["difference_db"].get<double>();
    EXPECT_EQ(difference_db > 50, std::string(file) == "m.html") << difference_db;
  }
  EXPECT_NE(read_file(folder_ / "m.html").find("blendWeights"), std::string::npos);
}

// What is lost is said.
TEST_F(Export, EveryFormatTakesEveryRepresentation) {
  for (const char* name : {"sparse", "mean", "nearest-views"}) {
    write(name);
    for (const char* file : {"m.ply", "m.obj", "m.usda", "m.glb", "m.splat.ply", "m.spz"}) {
      const ProgramRun run =
          run_sheen({"export", folder_ / "model.glb", "-o", folder_ / file, "--json", "--quiet"});
      ASSERT_EQ(run.exit_code, 0) << name << " " << file << run.standard_error;
      // Six patches, so that edges are as long as the object. Colours that are the same in all
      // directions survive but where the patch that nobody saw stands: the model lets its
      // neighbours decide there, whoever reads a file weighs all alike. Measured: 36 to 39 dB.
      const auto difference_db = run.json()["cost"]["difference_db"].get<double>();
      EXPECT_GT(difference_db, std::string(name) == "mean" ? 33 : 10) << name << " " << file;
    }
  }
}

// The names of the files beside it have no space, which OBJ cannot say.
TEST_F(Export, ObjNamesItsMaterialAndPicture) {
  write("mean");
  const ProgramRun run =
      run_sheen({"export", folder_ / "model.glb", "-o", folder_ / "my vase.obj", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  EXPECT_NE(read_file(folder_ / "my vase.obj").find("mtllib my_vase.mtl\n"), std::string::npos);
  EXPECT_NE(read_file(folder_ / "my_vase.mtl").find("map_Kd my_vase.png\n"), std::string::npos);
  EXPECT_TRUE(read_file(folder_ / "my_vase.png").starts_with("\x89PNG"));
}

TEST_F(Export, NeverReplacesTheModelItself) {
  write("mean");
  const std::string before = read_file(folder_ / "model.glb");
  expect_refused({"-o", folder_ / "." / "model.glb"}, "is the model itself");
  EXPECT_EQ(read_file(folder_ / "model.glb"), before);
}

class Turntable : public Export {};

TEST_F(Turntable, DrawsTheObjectInTheMiddleOfNothing) {
  write("mean");
  const ProgramRun run = run_sheen({"render", folder_ / "model.glb", "--turntable", "3", "--size",
                                    "64x48", "-o", folder_ / "pictures", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  for (const char* name : {"pictures/0000.png", "pictures/0001.png", "pictures/0002.png"}) {
    const cv::Mat picture = cv::imread((folder_ / name).string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(picture.size(), cv::Size(64, 48));
    ASSERT_EQ(picture.type(), CV_8UC4);
    EXPECT_EQ(picture.at<cv::Vec4b>(24, 32)[3], 255);
    EXPECT_EQ(picture.at<cv::Vec4b>(0, 0), cv::Vec4b(0, 0, 0, 0));
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "pictures" / "0003.png"));
}

TEST_F(Turntable, PutsABackgroundBehindIt) {
  write("mean");
  const ProgramRun run =
      run_sheen({"render", folder_ / "model.glb", "--turntable", "1", "--size", "64x48", "-o",
                 folder_ / "pictures", "--background", "#204060", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  const cv::Mat picture =
      cv::imread((folder_ / "pictures" / "0000.png").string(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(picture.type(), CV_8UC3);
  EXPECT_EQ(picture.at<cv::Vec3b>(0, 0), cv::Vec3b(0x60, 0x40, 0x20));
}

// Read by the program's own reader of videos, which is FFmpeg's decoder.
TEST_F(Turntable, BecomesAVideo) {
  write("mean");
  const ProgramRun run =
      run_sheen({"render", folder_ / "model.glb", "--turntable", "5", "--size", "64x48", "-o",
                 folder_ / "a:b 100%.mp4", "--background", "light", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  EXPECT_EQ(std::count(run.standard_error.begin(), run.standard_error.end(), '\n'), 0);
  const auto video = capture::open_video(folder_ / "a:b 100%.mp4", {64, 48}, {}, std::nullopt);
  int pictures = 0;
  while (const auto frame = video->next()) {
    ++pictures;
    // 0xf2f3f4 through 4:2:0 and quantisation.
    EXPECT_NEAR(frame->image.at<cv::Vec3b>(1, 1)[0], 0xf4, 4);
  }
  EXPECT_EQ(pictures, 5);
}

TEST_F(Export, RefusesWhatCannotBe) {
  write("nearest-views");
  expect_refused({"-o", folder_ / "m.html"}, "nearest-views");
  write("mean");
  expect_refused({"-o", folder_ / "m.docx"}, ".html");
  expect_refused({"-o", folder_ / "m.html", "--background", "url(x)"}, "--background");
  expect_refused({"-o", folder_ / "m.html", "--up", "-w"}, "--up");
  write_file(folder_ / "poster.png", "GIF89a");
  expect_refused({"-o", folder_ / "m.html", "--poster", folder_ / "poster.png"}, "PNG");
  const auto nowhere = folder_ / "poster.png" / "none.png";
  expect_refused({"-o", folder_ / "m.html", "--poster", nowhere}, "none.png");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "m.html"));
}

// An octahedron of radius 1 seen from a corner's axis: the sphere takes 0.86 of the picture, its
// middle is the object, its corners are not.
TEST_F(Export, DrawsAPosterThatDoesNotExist) {
  write("mean");
  const auto poster = folder_ / "poster.png";
  const std::vector<std::string> arguments{
      "export", folder_ / "model.glb", "-o", folder_ / "m.html", "--poster", poster, "--quiet"};
  ASSERT_EQ(run_sheen(arguments).exit_code, 0);
  const cv::Mat picture = cv::imread(poster.string(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(picture.type(), CV_8UC4);
  EXPECT_EQ(picture.at<cv::Vec4b>(picture.rows / 2, picture.cols / 2)[3], 255);
  EXPECT_EQ(picture.at<cv::Vec4b>(0, 0)[3], 0);
  EXPECT_NE(read_file(folder_ / "m.html").find("id=\"poster\""), std::string::npos);
  // What is there already is a user's picture and stays.
  write_file(poster, "\x89PNG\r\n\x1a\n");
  ASSERT_EQ(run_sheen(arguments).exit_code, 0);
  EXPECT_EQ(read_file(poster), "\x89PNG\r\n\x1a\n");
}

// Every patch was looked at from about where +x points to. Two cells of directions from there count
// as supported: 0.5 to 0.75 of the disc, up to 49 degrees.
TEST(FirstView, IsWherePhotographsWereTaken) {
  const core::Mesh mesh = fitting::testing::octahedron();
  fitting::SeenDirections seen;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const auto towards = core::direction_towards(core::tangent_frame(mesh.normals[i]),
                                                 mesh.positions[i], {10, 0, 0});
    const auto cell = fitting::guidance::cell_bit(fitting::guidance::cell_of(towards.uv));
    seen.push_back(fitting::guidance::dilated(cell));
  }
  const auto view = exporters::viewer::first_view(mesh, seen, "z");
  EXPECT_GT(view.towards_eye.x(), 0.65);
  EXPECT_NEAR(view.towards_eye.norm(), 1, 1e-9);
  EXPECT_DOUBLE_EQ(exporters::viewer::first_view(mesh, {}, "z").azimuth_rad, -1);
}

// The sets are kept bit for bit, in PLY and in glTF.
TEST_F(Export, TakesConfidenceAlong) {
  const core::Mesh mesh = fitting::testing::octahedron();
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) seen_.push_back(0x0123456789abcdefU << i);
  write("mean");
  for (const char* name : {"m.ply", "m.glb", "m.usda"}) {
    ASSERT_EQ(
        run_sheen({"export", folder_ / "model.glb", "-o", folder_ / name, "--quiet"}).exit_code, 0);
  }
  const std::string ply = read_file(folder_ / "m.ply");
  const std::string glb = read_file(folder_ / "m.glb");
  EXPECT_NE(ply.find("property float confidence\nproperty ushort seen_0\n"), std::string::npos);
  EXPECT_NE(glb.find("\"_CONFIDENCE\""), std::string::npos);
  EXPECT_NE(read_file(folder_ / "m.usda").find("primvars:confidence"), std::string::npos);
  for (const std::uint64_t set : seen_) {
    const std::string bytes(reinterpret_cast<const char*>(&set), sizeof set);
    EXPECT_NE(ply.find(bytes), std::string::npos);
    EXPECT_NE(glb.find(bytes), std::string::npos);
  }
  EXPECT_EQ(core::read_mesh(folder_ / "m.ply").positions, mesh.positions);
}

TEST(FormatOf, GoesByTheEndingWhateverItsCase) {
  EXPECT_EQ(exporters::format_of("a/b.HTML").name, "web viewer");
}

}  // namespace
}  // namespace sheen::tests
