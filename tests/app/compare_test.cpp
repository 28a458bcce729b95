// SPDX-License-Identifier: MIT
// What `sheen compare` measures is complete and obeys the laws of what it compares, its fronts are
// the points nobody beats, and its advice follows from its figures.
#include "evaluation/comparison/advice.h"
#include "evaluation/comparison/pareto.h"
#include "tests/app/program.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <sstream>

namespace sheen::tests {
namespace {

using evaluation::CostBenefit;
namespace fs = std::filesystem;

std::vector<std::uint8_t> front(const std::vector<CostBenefit>& points) {
  return evaluation::pareto_front(points);
}

TEST(ParetoFront, HoldsExactlyThePointsNobodyBeats) {
  // By hand: (1,1), (2,3), (4,4) rise together. (2,2) costs as much as (2,3) and is worth less,
  // (3,3) is worth as much and costs more, (5,1) is beaten by all.
  const std::vector<CostBenefit> points{{1, 1}, {2, 3}, {4, 4}, {2, 2}, {3, 3}, {5, 1}};
  EXPECT_EQ(front(points), (std::vector<std::uint8_t>{1, 1, 1, 0, 0, 0}));
}

TEST(ParetoFront, KeepsEqualPointsAndRefusesNumbersThatAreNone) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  // Neither twin is better in anything. NaN compares to nobody; a point of infinite worth must not
  // drive the others off.
  const std::vector<CostBenefit> points{{1, 1}, {1, 1}, {kNan, 9}, {0, kNan}, {0, kInfinite}};
  EXPECT_EQ(front(points), (std::vector<std::uint8_t>{1, 1, 0, 0, 0}));
  EXPECT_TRUE(front({}).empty());
}

TEST(ParetoFront, OfRandomPointsRisesAndLeavesNobodyOutWithoutCause) {
  constexpr unsigned kSeed = 7;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::uniform_int_distribution<int> coordinate(0, 20);  // coarse, so that ties happen
  std::vector<CostBenefit> points(60);
  for (auto& point : points) {
    point = {static_cast<double>(coordinate(random)), static_cast<double>(coordinate(random))};
  }
  // Sorted by cost and, at equal cost, by falling benefit, a point is on the front if and only if
  // it is worth more than everything before it, or equals the last point of the front.
  std::map<std::pair<double, double>, bool> expected;
  for (const auto& point : points) expected[{point.cost, -point.benefit}] = false;
  double best = -1;
  for (auto& [key, on_front] : expected) {
    on_front = -key.second > best;
    best = std::max(best, -key.second);
  }
  const auto flags = front(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(flags[i] != 0, (expected[{points[i].cost, -points[i].benefit}]))
        << points[i].cost << ", " << points[i].benefit;
  }
}

evaluation::ComparedCandidate figures(const char* name, double psnr_db, std::uintmax_t bytes) {
  evaluation::ComparedCandidate row{{}, {name, name, "", ""}, {}, {}};
  row.measured.error.psnr_db = psnr_db;
  row.measured.model_bytes = bytes;
  row.measured.fit_ms = 10;
  return row;
}

TEST(Advice, IsTheSmallestModelWithinHalfADecibelOfTheBest) {
  // 0.4 dB below the best at 80 of its 1000 bytes; 0.6 dB below does not count, however small.
  const std::vector<evaluation::ComparedCandidate> rows{
      figures("tiny", 29.4, 10), figures("small", 29.6, 80), figures("large", 30.0, 1000),
      figures("bulky", 29.9, 500)};
  const auto advice = evaluation::advise(rows, 1);
  ASSERT_TRUE(advice);
  EXPECT_EQ(advice->candidate, "small");
  EXPECT_NE(advice->sentence.find("0.4 dB below the best, \"large\", at 8 % of its bytes and "
                                  "1.0 times its fitting time"),
            std::string::npos)
      << advice->sentence;
  EXPECT_FALSE(evaluation::advise({}, 1));
}

// What jumps or has holes is passed over for what does not, and named where there is nothing else.
TEST(Advice, NamesWhatPsnrDoesNotShow) {
  std::vector<evaluation::ComparedCandidate> rows{
      figures("jumping", 30.0, 10), figures("leaky", 29.9, 20), figures("sound", 29.8, 80)};
  rows[0].measured.pop_ratio = 54;
  rows[1].measured.outline.hole_fraction = 0.012;
  EXPECT_EQ(evaluation::advise(rows, 1)->candidate, "sound");
  rows.pop_back();
  const auto jumping = evaluation::advise(rows, 1);
  EXPECT_EQ(jumping->candidate, "jumping");
  EXPECT_NE(jumping->sentence.find("; but it jumps while the viewer moves (changes of 54 times"),
            std::string::npos)
      << jumping->sentence;
  rows.erase(rows.begin());
  const auto leaky = evaluation::advise(rows, 1);
  EXPECT_NE(leaky->sentence.find("; but it leaves 1.2 % of the object uncovered."),
            std::string::npos)
      << leaky->sentence;
}

TEST(Advice, SaysWhereAnotherOneIsBetter) {
  std::vector<evaluation::ComparedCandidate> rows{figures("pick", 30.0, 10),
                                                  figures("other", 29.4, 100)};
  evaluation::CandidateMeasurement& pick = rows[0].measured;
  evaluation::CandidateMeasurement& other = rows[1].measured;
  pick.worst_psnr_db = 21;
  other.worst_psnr_db = 24;
  pick.outline = {.box_psnr_db = 20, .edge_difference = 14, .hole_fraction = 0};
  other.outline = {.box_psnr_db = 27, .edge_difference = 8, .hole_fraction = 0};
  pick.drawing_bytes = 66'000'000;
  other.drawing_bytes = 13'000'000;
  const auto advice = evaluation::advise(rows, 1);
  EXPECT_EQ(advice->candidate, "pick");
  EXPECT_NE(advice->sentence.find("; but its worst view has 21.0 dB (\"other\": 24.0), its edges "
                                  "differ by 14 grey levels (\"other\": 8), it draws beside the "
                                  "object (20.0 dB over its box, \"other\": 27.0), it takes 66 MB "
                                  "while drawn (\"other\": 13)."),
            std::string::npos)
      << advice->sentence;
  // Little differences and figures that nobody has are not worth a word.
  other = pick;
  other.error.psnr_db = 29.4;
  other.worst_psnr_db = 22.9;
  other.drawing_bytes = 0;
  EXPECT_EQ(evaluation::advise(rows, 1)->sentence.find("; but"), std::string::npos);
}

TEST(SessionNames, AreTheFoldersOwnUnlessTheyClash) {
  EXPECT_EQ(evaluation::session_names({"a/box", "b/stone/"}),
            (std::vector<std::string>{"box", "stone"}));
  EXPECT_EQ(evaluation::session_names({"a/box", "b/box"}),
            (std::vector<std::string>{"a/box", "b/box"}));
}

/// Good for the first fields of a line: session and candidate hold no comma here, labels do.
std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream text(line);
  for (std::string field; std::getline(text, field, ',');) fields.push_back(field);
  return fields;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// A short recording of few pixels and patches, and the folder that receives its comparison.
class Compare : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    recordings_ = std::make_unique<TemporaryFolder>();
    const ProgramRun synth = run_sheen({"synth", "glossy", "-o", session(), "--size", "320x180",
                                        "--frames", "12", "--vertices", "600", "--quiet"});
    ASSERT_EQ(synth.exit_code, 0) << synth.standard_error;
  }
  static void TearDownTestSuite() { recordings_.reset(); }

  Compare() : output_(folder_.path() / "out") {}

  static fs::path session() { return recordings_->path() / "session"; }

  void expect_refused(const std::vector<std::string>& arguments, const std::string& subject) const {
    const ProgramRun run = run_sheen(arguments);
    EXPECT_EQ(run.exit_code, 2) << run.standard_error;
    EXPECT_EQ(std::count(run.standard_error.begin(), run.standard_error.end(), '\n'), 1)
        << run.standard_error;
    EXPECT_NE(run.standard_error.find(subject), std::string::npos) << run.standard_error;
  }

  static inline std::unique_ptr<TemporaryFolder> recordings_;
  TemporaryFolder folder_;
  fs::path output_;
};

void expect_finite_figures(const nlohmann::json& row) {
  for (const char* name :
       {"psnr", "live_psnr", "worst_psnr", "box_psnr", "edge_difference", "pop_ratio", "ssim",
        "rmse", "fit_ms", "fit_ms_per_frame", "render_ms_per_view", "coefficients_per_patch",
        "model_bytes", "light_field_bytes"}) {
    // Photographs are no patches.
    if (name == std::string("coefficients_per_patch") && row.at("patches") == 0) continue;
    ASSERT_TRUE(row.at(name).is_number()) << name;  // NaN and infinity are null in JSON
    EXPECT_GT(row.at(name).get<double>(), 0) << name;
  }
}

/// Results by candidate.
std::map<std::string, nlohmann::json> by_name(const nlohmann::json& rows) {
  std::map<std::string, nlohmann::json> results;
  for (const auto& row : rows) results[row.at("candidate").get<std::string>()] = row;
  return results;
}

// Three numbers per term and patch, two bytes each; what else is in the file is the mesh, which all
// have in common, and text: 16 centres for IWLS.
void expect_sizes(const nlohmann::json& rows) {
  const std::map<std::string, int> terms{{"mean", 1},      {"sh1", 4},
                                         {"sh2", 9},       {"sh3", 16},
                                         {"batch", 48},    {"paper-quadtree", 48},
                                         {"quadtree", 48}, {"paper-adaptive", 48}};
  const auto results = by_name(rows);
  const int patches = results.at("mean").at("patches");
  const auto bytes_besides_numbers = [](const nlohmann::json& row) {
    return row.at("model_bytes").get<double>() - 2 * row.at("coefficients").get<double>();
  };
  for (const auto& [name, count] : terms) {
    EXPECT_EQ(results.at(name).at("coefficients"), 3 * count * patches) << name;
    EXPECT_EQ(results.at(name).at("coefficients_per_patch"), 3 * count) << name;
    EXPECT_NEAR(bytes_besides_numbers(results.at(name)), bytes_besides_numbers(results.at("mean")),
                500)
        << name;
  }
  // Every sample is kept, as five numbers.
  EXPECT_GE(results.at("nearest-views").at("coefficients"),
            5 * results.at("nearest-views").at("samples").get<int>());
  // What is minded more finely takes more numbers.
  const char* const finer[] = {"sparse-0.04", "sparse", "sparse-0.01", "sparse-0.005"};
  for (std::size_t i = 1; i < std::size(finer); ++i) {
    EXPECT_LT(results.at(finer[i - 1]).at("coefficients"), results.at(finer[i]).at("coefficients"));
    EXPECT_LT(results.at(finer[i - 1]).at("model_bytes"), results.at(finer[i]).at("model_bytes"));
  }
}

// What every view shows of a glossy object depends on the direction: whatever knows directions
// beats one colour per patch, and among harmonics the higher degree beats the lower. The ridge
// holds what a dozen views leave open. Measured: mean 20.35 dB, then 20.67 (adaptive) to 22.05
// (nearest views); harmonics 21.35, 21.88, 22.03; quadtree 21.39 without and 21.97 with ridge.
void expect_ranking(const nlohmann::json& rows) {
  const auto results = by_name(rows);
  const auto psnr_of = [&](const char* name) { return results.at(name).at("psnr").get<double>(); };
  for (const auto& [name, row] : results) {
    // But for whole pictures that are blended without moving anything (docs/systems.md).
    if (name != "mean" && name != "multi-eigenspace") {
      EXPECT_GT(row.at("psnr"), psnr_of("mean")) << name;
    }
    // The mean of a view's decibels is not that of its errors, but near: views differ by less than
    // a factor of two. Not those of photographs: some views have one near by, others none.
    if (row.at("patches") == 0) continue;
    EXPECT_NEAR(-20 * std::log10(row.at("rmse").get<double>()), row.at("psnr"), 0.2) << name;
  }
  EXPECT_GT(psnr_of("sh2"), psnr_of("sh1"));
  EXPECT_GT(psnr_of("sh3"), psnr_of("sh2"));
  EXPECT_GT(psnr_of("quadtree"), psnr_of("paper-quadtree"));
  EXPECT_GT(psnr_of("sparse"), psnr_of("mean") + 0.5);  // 1.6 were measured
}

/// The flags of a document agree with the law of the front.
void expect_fronts(const nlohmann::json& rows, const char* cost, const char* flag) {
  std::vector<CostBenefit> points;
  for (const auto& row : rows) points.push_back({row.at(cost), row.at("psnr")});
  const auto expected = front(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(rows[i].at(flag).get<bool>(), expected[i] != 0) << rows[i].at("candidate");
  }
}

/// The page holds the data and asks for nothing else.
void expect_self_contained(const std::string& page) {
  EXPECT_NE(page.find("\"candidate\":\"mean\""), std::string::npos);
  for (const char* mark : {"{{", " src=", "<link", "@import", "url("}) {
    EXPECT_EQ(page.find(mark), std::string::npos) << mark;
  }
}

TEST_F(Compare, MeasuresEveryCandidateOnTheSameSamplesAndViews) {
  fs::create_directories(output_);
  write_file(output_ / "notes.txt", "mine");
  write_file(output_ / "compare.csv", "of an earlier run");
  const ProgramRun run = run_sheen({"compare", session(), "-o", output_, "--json", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  const auto document = run.json();
  const auto& rows = document.at("results");
  EXPECT_TRUE(document.at("left_out").empty()) << document.at("left_out");

  // Everything registered is measured, on one set of samples and views.
  std::vector<std::string> measured;
  for (const auto& row : rows) {
    measured.push_back(row.at("candidate"));
    SCOPED_TRACE(measured.back());
    expect_finite_figures(row);
    EXPECT_EQ(row.at("samples"), rows[0].at("samples"));
    EXPECT_EQ(row.at("views"), rows[0].at("views"));
  }
  EXPECT_EQ(measured, evaluation::candidate_names());
  expect_sizes(rows);
  expect_ranking(rows);
  expect_fronts(rows, "fit_ms_per_frame", "front_fit_time");
  expect_fronts(rows, "render_ms_per_view", "front_render_time");
  expect_fronts(rows, "model_bytes", "front_bytes");

  // The CSV has a line for each, with as many names as values.
  const auto lines = lines_of(read_file(output_ / "compare.csv"));
  ASSERT_EQ(lines.size(), measured.size() + 1);
  EXPECT_EQ(split(lines[0])[0], "session");
  for (std::size_t i = 0; i < measured.size(); ++i) {
    EXPECT_EQ(split(lines[i + 1])[1], measured[i]);
    EXPECT_EQ(lines[i + 1].find("nan"), std::string::npos);
    EXPECT_EQ(lines[i + 1].find("null"), std::string::npos);
  }

  // Charts and page are there, from the packages every build has.
  for (const char* name : {"bytes", "fit-time", "render-time"}) {
    for (const char* ending : {".png", ".svg"}) {
      EXPECT_TRUE(fs::exists(output_ / (name + std::string(ending)))) << name << ending;
    }
  }
  expect_self_contained(read_file(output_ / "compare.html"));

  // What lay in the folder and is not ours is still there; nothing half-written is.
  EXPECT_EQ(read_file(output_ / "notes.txt"), "mine");
  for (const auto& entry : fs::directory_iterator(output_)) {
    EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
  }
}

TEST_F(Compare, HoldsFramesOutOfSessionsWithoutViewsOfTheirOwn) {
  const auto session_folder = folder_.path() / "session";
  fs::copy(session(), session_folder, fs::copy_options::recursive);
  fs::remove_all(session_folder / "held_out");
  // Frames 2 and 7 of 0 .. 11 are held out: index % 5 == 2.
  const ProgramRun run = run_sheen({"compare", session_folder, "-o", output_, "--only",
                                    "mean,quadtree", "--json", "--quiet", "--threads", "1"});
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  const auto used = run.json().at("sessions").at(0);
  EXPECT_EQ(used.at("held_out_views"), 2);
  EXPECT_EQ(used.at("fitted_frames"), 10);
  EXPECT_EQ(used.at("has_own_held_out"), false);
  const auto results = by_name(run.json().at("results"));
  ASSERT_EQ(results.size(), 2U);
  EXPECT_EQ(results.at("mean").at("views"), 2);
  // Views between those of the fit; 1.2 dB were measured.
  EXPECT_GT(results.at("quadtree").at("psnr"), results.at("mean").at("psnr"));
}

TEST_F(Compare, RefusesBadInputWithOneLine) {
  expect_refused({"compare", folder_.path() / "nowhere", "-o", output_, "--quiet"}, "nowhere");
  expect_refused({"compare", "-o", output_}, "sessions");
  expect_refused({"compare", sample_session()}, "--output");
  expect_refused({"compare", sample_session(), "-o", output_, "--only", "mean,best"}, "--only");
  expect_refused({"compare", sample_session(), "-o", output_, "--hold-out", "0"}, "--hold-out");
  expect_refused({"compare", sample_session(), sample_session(), "-o", output_, "--quiet"},
                 "given twice");
  write_file(output_, "a file");
  expect_refused({"compare", sample_session(), "-o", output_, "--quiet"}, "out");
  EXPECT_EQ(read_file(output_), "a file");
}

}  // namespace
}  // namespace sheen::tests
