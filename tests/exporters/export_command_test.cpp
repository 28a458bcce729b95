// SPDX-License-Identifier: MIT
#include "capture/source/video_source.h"
#include "exporters/format.h"
#include "tests/app/program.h"
#include "tests/fitting/models_for_tests.h"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

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
  expect_refused({"-o", folder_ / "m.html", "--poster", folder_ / "none.png"}, "none.png");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "m.html"));
}

TEST(FormatOf, GoesByTheEndingWhateverItsCase) {
  EXPECT_EQ(exporters::format_of("a/b.HTML").name, "web viewer");
}

}  // namespace
}  // namespace sheen::tests
