// SPDX-License-Identifier: MIT
#include "exporters/format.h"
#include "tests/app/program.h"
#include "tests/fitting/models_for_tests.h"

#include <gtest/gtest.h>

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
