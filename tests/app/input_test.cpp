// SPDX-License-Identifier: MIT
// Inputs whose numbers are of another unit or lie far away: read right, or refused with the cause
// before anything is written.
#include "core/mesh/read_mesh.h"
#include "tests/app/copied_session.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iomanip>
#include <regex>
#include <sstream>

namespace sheen::tests {
namespace {

namespace fs = std::filesystem;

class Input : public CopiedSession {
 protected:
  /// Sizes and places of the tags in another unit.
  void scale_board(double factor) const {
    const std::string text = read_file(session_ / "board.yaml");
    const std::regex number(R"((size|x|y): (-?[0-9.]+))");
    std::ostringstream scaled;
    auto rest = text.cbegin();
    for (std::sregex_iterator match(text.begin(), text.end(), number), end; match != end; ++match) {
      scaled << std::string(rest, (*match)[0].first) << (*match)[1] << ": "
             << factor * std::stod((*match)[2]);
      rest = (*match)[0].second;
    }
    write_file(session_ / "board.yaml", scaled.str() + std::string(rest, text.cend()));
  }

  using Pose = std::array<double, 7>;  ///< tx ty tz qx qy qz qw

  /// The true poses in place of the tags, each as `change` gives it, and its stamp.
  template <typename Change, typename Stamp>
  void use_poses(const Change& change, const Stamp& stamp) const {
    std::istringstream in(read_file(sample_session() / "truth_poses.txt"));
    std::ostringstream out;
    out << std::setprecision(12);
    for (std::string line; std::getline(in, line);) {
      std::istringstream words(line);
      int frame = 0;
      Pose pose{};
      if (!(words >> frame)) continue;
      for (double& value : pose) words >> value;
      out << stamp(frame);
      for (const double value : change(pose)) out << ' ' << value;
      out << '\n';
    }
    write_file(session_ / "poses.txt", out.str());
    replace("session.json", "\"board\": *\"board.yaml\"", "\"poses\": \"poses.txt\"");
  }

  /// Their positions in another unit.
  void use_poses(double factor) const {
    use_poses(
        [factor](Pose pose) {
          for (std::size_t i = 0; i < 3; ++i) pose[i] *= factor;
          return pose;
        },
        [](int frame) { return frame; });
  }

  [[nodiscard]] ProgramRun replay() const {
    return run_sheen(
        {"replay", session_, "-o", model_, "--quiet", "--representation", "mean", "--end", "40"});
  }

  [[nodiscard]] ProgramRun replay_all() const {
    return run_sheen({"replay", session_, "-o", model_, "--quiet", "--representation", "mean"});
  }

  [[nodiscard]] double psnr() const {
    const ProgramRun run =
        run_sheen({"evaluate", model_, sample_session() / "held_out", "--quiet", "--json"});
    EXPECT_EQ(run.exit_code, 0) << run.standard_error;
    return run.json()["mean"]["psnr"].get<double>();
  }

  static void expect_refused(const ProgramRun& run, const std::string& file,
                             const std::string& cause) {
    EXPECT_EQ(run.exit_code, 2) << run.standard_error;
    EXPECT_EQ(std::count(run.standard_error.begin(), run.standard_error.end(), '\n'), 1)
        << run.standard_error;
    EXPECT_NE(run.standard_error.find(file), std::string::npos) << run.standard_error;
    EXPECT_NE(run.standard_error.find(cause), std::string::npos) << run.standard_error;
  }
};

TEST_F(Input, NoCommandWritesFromABoardInAnotherUnit) {
  scale_board(1 / 0.0254);
  const std::string before = read_file(session_ / "session.json");
  expect_refused(replay(), "board.yaml", "inches");
  expect_refused(run_sheen({"survey", session_, "--quiet"}), "board.yaml", "inches");
  expect_refused(run_sheen({"register", session_, "--quiet"}), "board.yaml", "inches");
  EXPECT_EQ(read_file(session_ / "session.json"), before);
  EXPECT_FALSE(fs::exists(session_ / "board.surveyed.yaml"));
  EXPECT_FALSE(fs::exists(model_));
}

// Most tags of the board fit a pose one tag off: the model came out wrong, with a note on its
// place.
TEST_F(Input, ABoardWhoseIdsAreShiftedIsRefusedWithTheNumber) {
  const std::string text = read_file(session_ / "board.yaml");
  const std::regex id(R"(id: ([0-9]+))");
  std::string shifted;
  auto rest = text.cbegin();
  for (std::sregex_iterator match(text.begin(), text.end(), id), end; match != end; ++match) {
    shifted +=
        std::string(rest, (*match)[0].first) + "id: " + std::to_string(std::stoi((*match)[1]) + 1);
    rest = (*match)[0].second;
  }
  write_file(session_ / "board.yaml", shifted + std::string(rest, text.cend()));
  expect_refused(replay(), "board.yaml", "1 too high");
  EXPECT_FALSE(fs::exists(model_));
  const std::string before = read_file(session_ / "session.json");
  expect_refused(run_sheen({"register", session_, "--quiet"}), "board.yaml", "1 too high");
  expect_refused(run_sheen({"mesh", session_, "--force", "--quiet"}), "board.yaml", "1 too high");
  expect_refused(run_sheen({"survey", session_, "--quiet"}), "board.yaml", "1 too high");
  EXPECT_EQ(read_file(session_ / "session.json"), before);
  EXPECT_FALSE(fs::exists(session_ / "board.surveyed.yaml"));
}

TEST_F(Input, PosesInAnotherUnitAreRefusedByReplayAndEvaluate) {
  use_poses(100);
  expect_refused(replay(), "poses.txt", "centimetres");
  EXPECT_FALSE(fs::exists(model_));
  // A model that was made rightly is not measured against them either.
  const TemporaryFolder other;
  const fs::path good = other / "good.glb";
  ASSERT_EQ(run_sheen({"replay", sample_session(), "-o", good, "--quiet", "--representation",
                       "mean", "--end", "10"})
                .exit_code,
            0);
  expect_refused(run_sheen({"evaluate", good, session_, "--quiet"}), "poses.txt", "centimetres");
}

// The object's middle stays in a tenth of the images then, in one of seventeen where the poses are
// inverted: enough to fit something.
TEST_F(Input, QuaternionsThatBeginWithWAreRefusedThoughSomeImagesShowTheObject) {
  use_poses([](const Pose& p) { return Pose{p[0], p[1], p[2], p[6], p[3], p[4], p[5]}; },
            [](int frame) { return frame; });
  expect_refused(replay_all(), "poses.txt", "quaternions begin with w");
  EXPECT_FALSE(fs::exists(model_));
}

TEST_F(Input, InvertedPosesAreRefusedThoughSomeImagesShowTheObject) {
  use_poses(
      [](const Pose& p) {
        const Eigen::Quaterniond q = Eigen::Quaterniond(p[6], p[3], p[4], p[5]).conjugate();
        const Eigen::Vector3d t = -(q * Eigen::Vector3d(p[0], p[1], p[2]));
        return Pose{t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
      },
      [](int frame) { return frame; });
  expect_refused(replay_all(), "poses.txt", "invert them");
}

TEST_F(Input, StampsInMillisecondsAreRefusedAndNoFramesOfOtherPosesFitted) {
  // Whole numbers: 0, 33, 67 and 100 are frames of the 120 as well.
  use_poses([](const Pose& p) { return p; },
            [](int index) { return std::lround(index * 1000 / 30.0); });
  expect_refused(replay_all(), "poses.txt", "milliseconds");
  EXPECT_FALSE(fs::exists(model_));
}

TEST_F(Input, AMeshInSurveyCoordinatesGivesTheSameModelAtItsOwnPlace) {
  ASSERT_EQ(replay().exit_code, 0);
  const double as_it_was = psnr();

  // The same mesh 500 km east and 5000 km north, and a transform that brings it back.
  const core::Mesh mesh = core::read_mesh(session_ / "object.ply");
  const Eigen::Vector3d place(500'123.25, 5'000'456.5, 321.125);
  std::ostringstream text;
  text << std::setprecision(15);
  for (const auto& position : mesh.positions) {
    text << "v " << (position.cast<double>() + place).transpose() << '\n';
  }
  for (const auto& normal : mesh.normals) text << "vn " << normal.transpose() << '\n';
  for (const auto& t : mesh.triangles) {
    text << 'f';
    for (const std::uint32_t corner : t) text << ' ' << corner + 1 << "//" << corner + 1;
    text << '\n';
  }
  write_file(session_ / "object.obj", text.str());
  auto document = nlohmann::json::parse(read_file(session_ / "session.json"));
  auto& object = document["object"];
  object["mesh"] = "object.obj";
  auto& transform = object["T_stage_object"];
  for (std::size_t row = 0; row < 3; ++row) {
    double shift = 0;
    for (std::size_t column = 0; column < 3; ++column) {
      shift += transform[4 * row + column].get<double>() * place[static_cast<Eigen::Index>(column)];
    }
    transform[4 * row + 3] = transform[4 * row + 3].get<double>() - shift;
  }
  write_file(session_ / "session.json", document.dump());

  const ProgramRun run = replay();
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  // The node of the model stands where the user's data are.
  const std::string model = read_file(model_);
  const auto length = static_cast<std::size_t>(static_cast<unsigned char>(model[12])) |
                      static_cast<std::size_t>(static_cast<unsigned char>(model[13])) << 8U |
                      static_cast<std::size_t>(static_cast<unsigned char>(model[14])) << 16U;
  const auto scene = nlohmann::json::parse(model.substr(20, length));
  const auto& translation = scene["nodes"][0]["translation"];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(translation[axis].get<double>(), place[static_cast<Eigen::Index>(axis)], 1);
  }
  // Evaluated in its own session, whose mesh lies there too.
  const ProgramRun evaluated =
      run_sheen({"evaluate", model_, session_, "--quiet", "--json", "--end", "40"});
  ASSERT_EQ(evaluated.exit_code, 0) << evaluated.standard_error;
  EXPECT_GT(evaluated.json()["mean"]["psnr"].get<double>(), as_it_was - 1);
  EXPECT_EQ(evaluated.json()["covered_fraction"].get<double>() > 0.99, true);
}

TEST_F(Input, TextOfAnotherSystemIsReadEverywhere) {
  ASSERT_EQ(replay().exit_code, 0);
  const std::string usual = read_file(model_);
  for (const char* name : {"session.json", "camera.yaml", "board.yaml"}) {
    std::string text = "\xef\xbb\xbf" + read_file(session_ / name);
    text = std::regex_replace(text, std::regex("\n"), "\r\n");
    write_file(session_ / name, text);
  }
  ASSERT_EQ(replay().exit_code, 0);
  EXPECT_EQ(read_file(model_), usual);
}

}  // namespace
}  // namespace sheen::tests
