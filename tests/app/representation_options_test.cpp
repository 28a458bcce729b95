// SPDX-License-Identifier: MIT
// Which representation runs, and which options it takes.
#include "app/commands/representation_options.h"

#include "fitting/descriptor.h"
#include "fitting/iwls/light_field_model.h"
#include "fitting/model_file/model_file.h"
#include "tests/app/program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace sheen::tests {
namespace {

using app::resolve_representation;
using fitting::OptionValues;

/// Every option of every representation, with a value that is allowed.
std::map<std::string, OptionValues> options_by_representation() {
  std::map<std::string, OptionValues> all;
  for (const fitting::Descriptor* descriptor : fitting::representations()) {
    OptionValues& values = all[std::string(descriptor->name)];
    const auto options = descriptor->default_options();
    for (const fitting::FitOption& option : options->table()) {
      const std::string text = option.get();
      values[option.name] = text.empty() ? "0.02" : text;  // those that the fit decides are numbers
    }
  }
  return all;
}

// A representation takes an option if and only if it stands in its table.
TEST(RepresentationOptions, ApplyToThoseThatHaveThem) {
  const auto all = options_by_representation();
  for (const auto& [representation, own] : all) {
    EXPECT_EQ(resolve_representation(representation, own).representation, representation);
    EXPECT_EQ(resolve_representation(representation, own).values, own);
    for (const auto& [owner, values] : all) {
      for (const auto& [name, value] : values) {
        if (own.contains(name)) continue;
        EXPECT_THROW(resolve_representation(representation, {{name, value}}), app::UsageError)
            << representation << " --" << name;
      }
    }
  }
}

TEST(RepresentationOptions, ImplyTheFirstThatHasThemAll) {
  EXPECT_EQ(resolve_representation("", {}).representation, "detail");  // the default
  const auto all = options_by_representation();
  const auto first_with = [&](const std::string& name) {
    const auto registry = fitting::representations();
    const auto found = std::ranges::find_if(registry, [&](const fitting::Descriptor* descriptor) {
      return all.at(std::string(descriptor->name)).contains(name);
    });
    return std::string((*found)->name);
  };
  for (const auto& [owner, values] : all) {
    for (const auto& [name, value] : values) {
      EXPECT_EQ(resolve_representation("", {{name, value}}).representation, first_with(name))
          << name;
    }
  }
  EXPECT_THROW(resolve_representation("", {{"tolerance", "0.02"}, {"degree", "2"}}),
               app::UsageError);
}

TEST(RepresentationOptions, RefuseValuesBeforeTheLongWork) {
  EXPECT_THROW(resolve_representation("", {{"centers", "17"}}), std::invalid_argument);
  EXPECT_THROW(resolve_representation("", {{"faithful", "true"}, {"terms", "6"}}),
               std::invalid_argument);
  EXPECT_THROW(resolve_representation("", {{"tolerance", "two"}}), std::invalid_argument);
}

/// The real program on the first frames of the sample.
class ReplayChoice : public testing::Test {
 protected:
  [[nodiscard]] ProgramRun replay(const std::vector<std::string>& choice) const {
    std::vector<std::string> arguments{"replay", sample_session(), "-o",     model(), "--end",
                                       "8",      "--json",         "--quiet"};
    arguments.insert(arguments.end(), choice.begin(), choice.end());
    return run_sheen(arguments);
  }
  [[nodiscard]] std::filesystem::path model() const { return folder_ / "model.glb"; }

  /// Exit code 2, one line that holds `words`, and no model.
  void expect_refused(const std::vector<std::string>& choice,
                      const std::vector<std::string>& words) const {
    const ProgramRun run = replay(choice);
    const std::string& said = run.standard_error;
    EXPECT_EQ(run.exit_code, 2) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    for (const std::string& word : words) EXPECT_NE(said.find(word), std::string::npos) << said;
    EXPECT_EQ(run.standard_output, "");
    EXPECT_FALSE(std::filesystem::exists(model()));
  }

  /// Runs, and report and file name what ran. Returns the report's options.
  [[nodiscard]] nlohmann::json expect_fits(const std::vector<std::string>& choice,
                                           const std::string& representation) const {
    const ProgramRun run = replay(choice);
    EXPECT_EQ(run.exit_code, 0) << run.standard_error;
    if (run.exit_code != 0) return {};
    EXPECT_EQ(run.json().at("representation"), representation);
    EXPECT_EQ(run.json().at("options").at("representation"), representation);
    EXPECT_EQ(fitting::read_model(model()).light_field->representation(), representation);
    return run.json().at("options");
  }

  TemporaryFolder folder_;
};

TEST_F(ReplayChoice, ContradictionsAreRefused) {
  expect_refused({"--representation", "sparse", "--fitter", "quadtree"},
                 {"--fitter", "--representation sparse", "iwls"});
  expect_refused({"--tolerance", "0.02", "--fitter", "quadtree"}, {"--tolerance", "--fitter"});
  expect_refused({"--representation", "sh", "--layout", "disk"},
                 {"--layout", "--representation sh", "iwls"});
  expect_refused({"--representation", "iwls", "--fitter", "sparse"}, {"--fitter sparse", "iwls"});
  expect_refused({"--representation", "mean", "--faithful"}, {"--faithful", "mean"});
  expect_refused({"--faithful", "--terms", "6"}, {"terms", "6"});
  expect_refused({"--fitter", "octree"}, {"octree", "quadtree"});
  expect_refused({"--patches", "detail", "--fitter", "quadtree"}, {"--patches detail", "iwls"});
  expect_refused({"--patches", "texel", "--representation", "detail"}, {"--patches texel"});
  expect_refused({"--patches", "vertex", "--representation", "detail"}, {"--patches vertex"});
  expect_refused({"--patches", "vertex", "--texel-mm", "2"}, {"--texel-mm", "sparse"});
  expect_refused({"--patches", "vertex", "--offsets", "anchors"}, {"--offsets", "sparse"});
  expect_refused({"--representation", "wavelets"}, {"wavelets", "sparse"});
}

TEST_F(ReplayChoice, ReportAndModelNameWhatRan) {
  EXPECT_FALSE(expect_fits({}, "detail").contains("layout"));
  EXPECT_TRUE(expect_fits({"--fitter", "sparse"}, "sparse").contains("tolerance"));
  EXPECT_EQ(expect_fits({"--fitter", "quadtree"}, "iwls").at("fitter"), "quadtree");
  EXPECT_EQ(expect_fits({"--representation", "iwls"}, "iwls").at("fitter"), "quadtree");
  EXPECT_EQ(expect_fits({"--fitter", "batch", "--layout", "disk"}, "iwls").at("layout"), "disk");
  EXPECT_EQ(expect_fits({"--representation", "sh", "--degree", "2"}, "sh").at("degree"), 2);
  EXPECT_EQ(expect_fits({"--tolerance", "0.02"}, "detail").at("tolerance").get<float>(), 0.02f);
  EXPECT_EQ(expect_fits({"--patches", "detail"}, "detail").at("patches"), "detail");
  EXPECT_EQ(expect_fits({"--patches", "vertex"}, "sparse").at("patches"), "vertex");
  EXPECT_EQ(expect_fits({"--representation", "mean"}, "mean").at("patches"), "vertex");
  EXPECT_EQ(expect_fits({"--representation", "detail"}, "detail").at("patches"), "detail");
  static_cast<void>(expect_fits({"--texel-mm", "2"}, "detail"));
  EXPECT_EQ(expect_fits({"--offsets", "anchors"}, "detail").at("patches"), "detail");
}

// Faithful fits have three terms and no ridge, so they are another model than those with it.
TEST_F(ReplayChoice, FaithfulIsThePapersIwls) {
  const auto bits = [&] {
    const auto read = fitting::read_model(model());
    const auto& iwls = dynamic_cast<const fitting::iwls::LightFieldModel&>(*read.light_field);
    EXPECT_EQ(iwls.shape().terms, 3);
    return iwls.coefficients_by_center();
  };
  EXPECT_EQ(expect_fits({"--faithful"}, "iwls").at("faithful"), true);
  const auto faithful = bits();
  EXPECT_EQ(expect_fits({"--fitter", "quadtree", "--faithful"}, "iwls").at("faithful"), true);
  EXPECT_EQ(bits(), faithful);
  EXPECT_EQ(expect_fits({"--fitter", "quadtree"}, "iwls").at("faithful"), false);
  EXPECT_NE(bits(), faithful);
}

}  // namespace
}  // namespace sheen::tests
