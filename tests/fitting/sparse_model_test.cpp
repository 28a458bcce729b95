// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"
#include "fitting/sparse/light_field_model.h"
#include "fitting/sparse/model_codec.h"
#include "tests/fitting/models_for_tests.h"
#include "tests/fitting/sparse_models_for_tests.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <thread>

namespace sheen::fitting::sparse {
namespace {

using fitting::testing::random_patch;
using fitting::testing::random_sparse;
using fitting::testing::text_of;

constexpr unsigned kSeed = 4711;

// The formula of patch_model.h in double, for directions on the disc.
Eigen::Vector3d formula(const PatchModel& patch, double u, double v) {
  const auto c = [&](std::size_t term) {
    return Eigen::Vector3d(patch.coefficient[term].cast<double>());
  };
  Eigen::Vector3d colour = c(0);
  if (patch.base_terms == 4) {
    colour += u * c(1) + v * c(2) + std::sqrt(std::max(0.0, 1 - u * u - v * v)) * c(3);
  }
  for (std::size_t i = 0; i < patch.rbf_count; ++i) {
    const Atom& atom = atoms()[patch.atom[i]];
    const double d = std::hypot(u - static_cast<double>(atom.center.x()),
                                v - static_cast<double>(atom.center.y())) /
                     static_cast<double>(atom.support);
    if (d < 1) colour += std::pow(1 - d, 4) * (4 * d + 1) * c(patch.base_terms + i);
  }
  return colour;
}

bool same(const PatchModel& a, const PatchModel& b) {
  return a.base_terms == b.base_terms && a.rbf_count == b.rbf_count && a.atom == b.atom &&
         std::equal(a.coefficient.begin(),
                    a.coefficient.begin() + static_cast<std::ptrdiff_t>(a.term_count()),
                    b.coefficient.begin());
}

// Cells of width 1, 1/2, 1/4 and 1/8 that meet the unit disc. Of the 8x8 grid only the four corner
// cells do not, their nearest corner being (3/4, 3/4). Of the 16x16 grid, in units of 1/8 from the
// middle, a cell with nearest corner (x, y) is outside when x^2 + y^2 >= 64: (7, 4), (7, 5), (7,
// 6), (7, 7), (6, 6), and the three first mirrored, in each quadrant: 32. 4 + 16 + 60 + 224 = 304.
TEST(SparseAtoms, AreTheQuadtreesCells) {
  ASSERT_EQ(atoms().size(), 304u);
  ASSERT_EQ(atoms().size(), kMaxAtoms);
  EXPECT_EQ(atoms()[0].center, Eigen::Vector2f(-0.5f, -0.5f));
  EXPECT_EQ(atoms()[0].support, 3.5f);
  EXPECT_EQ(atoms()[4].center, Eigen::Vector2f(-0.75f, -0.75f));
  EXPECT_EQ(atoms()[4].support, 1.75f);
  EXPECT_EQ(atoms()[20].center, Eigen::Vector2f(-0.625f, -0.875f));
  EXPECT_EQ(atoms()[79].center, Eigen::Vector2f(0.625f, 0.875f));
  EXPECT_EQ(atoms()[79].support, 0.875f);
  EXPECT_EQ(atoms()[303].center, Eigen::Vector2f(0.4375f, 0.9375f));
  EXPECT_EQ(atoms()[303].support, 0.625f);
  std::set<std::array<float, 3>> distinct;
  for (const Atom& atom : atoms()) {
    distinct.insert({atom.center.x(), atom.center.y(), atom.support});
  }
  EXPECT_EQ(distinct.size(), 304u);
}

// An atom inside the disc: over the plane its RBF has the integral
// 2 pi h^2 int_0^1 (1-d)^4 (4d+1) d dd = 2 pi h^2 (4 B(3,5) + B(2,5)) = 2 pi h^2 (4/105 + 1/30)
// = pi h^2 / 7, and the disc has the area pi: the mean is h^2 / 7. Atoms of the finest level,
// h = 5/8, lie inside when their centre is within 3/8 of the middle: in units of 1/16 (1, 1), (1,
// 3), (1, 5), (3, 1), (3, 3), (3, 5), (5, 1), (5, 3) in each quadrant, 32.
TEST(SparseAtoms, MeanIsTheIntegral) {
  int inside = 0;
  for (std::size_t i = 0; i < atoms().size(); ++i) {
    const Atom& atom = atoms()[i];
    if (atom.center.norm() + atom.support > 1.0f) continue;
    ++inside;
    EXPECT_NEAR(atom_means()[i], atom.support * atom.support / 7, 2e-5f) << i;
  }
  EXPECT_GE(inside, 32);
}

// The mean against a sum over rings of equal area, and the linear base's 2/3.
TEST(SparsePatch, MeanIsTheMeanOverTheDisc) {
  std::mt19937 random(kSeed);
  for (int repeat = 0; repeat < 5; ++repeat) {
    const PatchModel patch = random_patch(random, kMaxRbfs);
    constexpr int rings = 300;
    constexpr int spokes = 300;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int ring = 0; ring < rings; ++ring) {
      const double radius = std::sqrt((ring + 0.5) / rings);
      for (int spoke = 0; spoke < spokes; ++spoke) {
        const double angle = 2 * 3.14159265358979 * (spoke + 0.5) / spokes;
        sum += formula(patch, radius * std::cos(angle), radius * std::sin(angle));
      }
    }
    const Eigen::Vector3d mean = sum / (rings * spokes);
    EXPECT_LT((disc_mean(patch).cast<double>() - mean).cwiseAbs().maxCoeff(), 1e-3) << repeat;
  }
}

// Floats against doubles: at most 28 terms of size below 1, each off by a few 2^-24; near the rim
// z = sqrt(1 - r^2) turns an error of 2^-24 in r^2 into 2^-12 = 2.4e-4 of a coefficient of 0.2.
TEST(SparseModel, EvaluatesTheFormula) {
  const LightFieldModel model = random_sparse(200, kMaxRbfs, 0, kSeed);
  for (std::size_t i = 0; i < model.patch_count(); ++i) {
    for (const Eigen::Vector2f& uv : fitting::testing::disc_grid(6, 12)) {
      const WeightedColour value = model.evaluate(i, uv);
      const Eigen::Vector3d expected =
          formula(model.patch(i), static_cast<double>(uv.x()), static_cast<double>(uv.y()));
      EXPECT_EQ(value.weight_sum, 1.0f);
      ASSERT_LT((value.colour_sum.cast<double>() - expected).cwiseAbs().maxCoeff(), 1e-4)
          << "patch " << i << " seed " << kSeed;
    }
  }
}

// Behind the horizon counts as on it: (1.8, -2.4) = 3 (0.6, -0.8). Rounding may leave the second
// 2^-24 inside the rim, so that z is up to 3.5e-4 of a coefficient of 0.2.
TEST(SparseModel, DirectionsOutsideAreOnTheRim) {
  const LightFieldModel model = random_sparse(50, kMaxRbfs, 0, kSeed);
  for (std::size_t i = 0; i < model.patch_count(); ++i) {
    EXPECT_LT(
        (model.evaluate(i, {1.8f, -2.4f}).colour_sum - model.evaluate(i, {0.6f, -0.8f}).colour_sum)
            .cwiseAbs()
            .maxCoeff(),
        1e-3f);
  }
}

TEST(SparseModel, UnseenPatchesWeighLittle) {
  LightFieldModel model = random_sparse(1, 4, 0, kSeed);
  const WeightedColour seen = model.evaluate(0, {0.1f, 0.2f});
  EXPECT_TRUE(model.store_observed(0, false));
  EXPECT_FALSE(model.store_observed(0, false));
  const WeightedColour unseen = model.evaluate(0, {0.1f, 0.2f});
  EXPECT_EQ(unseen.weight_sum, kUnseenWeight);
  // A power of two: exact.
  EXPECT_EQ(unseen.colour_sum, kUnseenWeight * seen.colour_sum);
}

// `store` says exactly whether what `patch` returns changes, however patches grow and shrink.
TEST(SparseModel, StoreTellsWhetherAnythingChanged) {
  std::mt19937 random(kSeed);
  LightFieldModel model(1);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const PatchModel next = random_patch(random, kMaxRbfs);
    const PatchModel before = model.patch(0);
    const bool changed = model.store(0, next);
    const PatchModel after = model.patch(0);
    EXPECT_EQ(changed, !same(before, after));
    EXPECT_FALSE(model.store(0, next));
    // Rounding to 11 bits is below 2^-12 for values below 1, and rounding twice is rounding once.
    for (std::size_t term = 0; term < next.term_count(); ++term) {
      EXPECT_LE((after.coefficient[term] - next.coefficient[term]).cwiseAbs().maxCoeff(),
                1.0f / 4096.0f);
    }
    EXPECT_FALSE(model.store(0, after));
    EXPECT_EQ(std::vector(after.atom.begin(), after.atom.end()),
              std::vector(next.atom.begin(), next.atom.end()));
  }
}

// A change far below half precision is none.
TEST(SparseModel, TinyChangesAreNone) {
  PatchModel patch;
  patch.coefficient[0] = {0.5f, 0.25f, 0.125f};
  LightFieldModel model(1);
  EXPECT_TRUE(model.store(0, patch));
  patch.coefficient[0] += Eigen::Vector3f::Constant(1e-6f);
  EXPECT_FALSE(model.store(0, patch));
  // Beyond what a half holds it is cut, not infinite.
  patch.coefficient[0] = {1e9f, -1e9f, 0.0f};
  EXPECT_TRUE(model.store(0, patch));
  EXPECT_EQ(model.patch(0).coefficient[0], Eigen::Vector3f(65504.0f, -65504.0f, 0.0f));
}

// 3 per term, 1 per RBF: 3 for a constant, 3 * 4 + 4 * 2 for a linear base and two RBFs.
TEST(SparseModel, CountsEveryStoredNumber) {
  LightFieldModel model(2);
  EXPECT_EQ(model.coefficient_count(), 6u);
  PatchModel patch;
  patch.base_terms = kLinearBase;
  patch.rbf_count = 2;
  patch.atom[0] = 7;
  patch.atom[1] = 70;
  patch.coefficient.fill(Eigen::Vector3f::Zero());
  model.store(1, patch);
  EXPECT_EQ(model.coefficient_count(), 3u + 12u + 8u);
}

TEST(SparseModel, PatchesMayBeWrittenByThreads) {
  constexpr std::size_t patches = 4000;
  LightFieldModel together(patches);
  const auto write = [&](std::size_t begin) {
    for (std::size_t i = begin; i < patches; i += 4) {
      for (unsigned repeat = 0; repeat < 3; ++repeat) {
        std::mt19937 random(static_cast<unsigned>(3 * i) + repeat);
        together.store(i, random_patch(random, kMaxRbfs));
        together.store_observed(i, i % 3 != 0);
      }
    }
  };
  {
    std::vector<std::jthread> threads;
    for (std::size_t begin = 0; begin < 4; ++begin) threads.emplace_back(write, begin);
  }
  LightFieldModel alone(patches);
  for (std::size_t i = 0; i < patches; ++i) {
    std::mt19937 random(static_cast<unsigned>(3 * i) + 2);
    alone.store(i, random_patch(random, kMaxRbfs));
    alone.store_observed(i, i % 3 != 0);
  }
  EXPECT_EQ(together.observed(), alone.observed());
  const ModelPart a = encode_model(together);
  const ModelPart b = encode_model(alone);
  for (const auto& [name, bytes] : a.arrays) {
    EXPECT_TRUE(text_of(bytes) == text_of(b.arrays.at(name))) << name;
  }
}

// ---- the model file's part ----

// Decodes arrays that may have been tampered with; nothing when they are refused. What is accepted
// must be exactly what its model encodes to.
std::optional<std::string> decoded(const std::map<std::string, std::string>& arrays,
                                   const nlohmann::json& parameters, std::size_t patches) {
  ModelPart part;
  part.parameters = parameters;
  const std::vector<std::uint8_t> observed(patches, 1);
  part.observed = std::as_bytes(std::span(observed));
  for (const auto& [name, bytes] : arrays) part.arrays[name] = std::as_bytes(std::span(bytes));
  std::unique_ptr<const LightField> model;
  try {
    model = decode_model(part, fitting::testing::points(patches));
  } catch (const ModelFault& fault) {
    EXPECT_GT(std::string(fault.what()).size(), 10u);
    return std::nullopt;
  }
  const ModelPart again = encode_model(*model);
  std::string all;
  for (const auto& [name, bytes] : again.arrays) {
    EXPECT_EQ(text_of(bytes), arrays.at(name)) << name;
    all += text_of(bytes);
  }
  return all;
}

class SparseCodec : public ::testing::Test {
 protected:
  SparseCodec() : model_(random_sparse(kPatches, 6, 0, kSeed)) {
    const ModelPart part = encode_model(model_);
    parameters_ = part.parameters;
    for (const auto& [name, bytes] : part.arrays) arrays_[name] = text_of(bytes);
  }

  static constexpr std::size_t kPatches = 30;
  LightFieldModel model_;
  nlohmann::json parameters_;
  std::map<std::string, std::string> arrays_;
};

TEST_F(SparseCodec, HasThreeArraysOfTheRightSize) {
  std::size_t terms = 0;
  for (std::size_t i = 0; i < kPatches; ++i) terms += model_.term_count(i);
  ASSERT_EQ(arrays_.size(), 3u);
  EXPECT_EQ(arrays_["shapes"].size(), kPatches);
  EXPECT_EQ(arrays_["coefficients"].size(), 6 * terms);
  // Every number of the model is there once, in two bytes.
  EXPECT_EQ(arrays_["coefficients"].size() / 2 + arrays_["bumps"].size() / 2,
            model_.coefficient_count());
}

TEST_F(SparseCodec, DecodesWhatItEncodes) {
  EXPECT_TRUE(decoded(arrays_, parameters_, kPatches));
}

TEST_F(SparseCodec, EveryFlippedBitIsRefusedOrKept) {
  int refusals = 0;
  for (auto& [name, bytes] : arrays_) {
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
      const char mask = static_cast<char>(1 << (bit % 8));
      bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ mask);
      const auto result = decoded(arrays_, parameters_, kPatches);
      refusals += result ? 0 : 1;
      // Any other shape asks for arrays of other sizes.
      if (name == "shapes") {
        EXPECT_FALSE(result) << bit;
      }
      bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ mask);
    }
  }
  EXPECT_GT(refusals, 8 * static_cast<int>(kPatches));
}

TEST_F(SparseCodec, EveryOtherLengthIsRefused) {
  for (const auto& [name, bytes] : arrays_) {
    auto shorter = arrays_;
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      shorter[name] = bytes.substr(0, length);
      EXPECT_FALSE(decoded(shorter, parameters_, kPatches)) << name << " " << length;
    }
    auto longer = arrays_;
    longer[name] += '\0';
    EXPECT_FALSE(decoded(longer, parameters_, kPatches)) << name;
    auto absent = arrays_;
    absent.erase(name);
    EXPECT_FALSE(decoded(absent, parameters_, kPatches)) << name;
  }
  EXPECT_FALSE(decoded(arrays_, parameters_, kPatches + 1));
}

TEST(SparseCodecLimits, BrokenPatchesAreRefused) {
  const nlohmann::json parameters = encode_model(LightFieldModel(1)).parameters;
  const auto accepted = [&](const std::string& shape, const std::string& rbfs,
                            std::size_t coefficient_bytes) {
    return decoded({{"shapes", shape},
                    {"bumps", rbfs},
                    {"coefficients", std::string(coefficient_bytes, '\0')}},
                   parameters, 1)
        .has_value();
  };
  const auto ids = [](std::initializer_list<unsigned> list) {
    std::string bytes;
    for (const unsigned id : list) {
      bytes += static_cast<char>(id & 0xff);
      bytes += static_cast<char>(id >> 8);
    }
    return bytes;
  };
  // Two RBFs on a constant: 3 terms of 6 bytes.
  EXPECT_TRUE(accepted("\x02", ids({5, 6}), 18));
  EXPECT_TRUE(accepted("\x02", ids({44, 300}), 18));  // 300 mod 256 is 44: two atoms all the same
  EXPECT_TRUE(accepted("\x02", ids({5, 303}), 18));
  EXPECT_FALSE(accepted("\x02", ids({300, 300}), 18));  // the same atom twice
  EXPECT_FALSE(accepted("\x02", ids({5, 304}), 18));    // there is no atom 304
  EXPECT_FALSE(accepted("\x02", ids({5, 0xffff}), 18));
  EXPECT_FALSE(accepted("\x02", "\x05\x06", 18));  // one byte each, as before
  // 24 RBFs are allowed, 25 are not.
  std::string many;
  for (unsigned id = 0; id < 25; ++id) many += ids({10 * id});
  EXPECT_TRUE(accepted("\x18", many.substr(0, 48), 25 * 6));
  EXPECT_FALSE(accepted("\x19", many, 26 * 6));
}

TEST_F(SparseCodec, ForeignDictionariesAreRefused) {
  parameters_["atoms"][3][0] = 0.25;
  EXPECT_FALSE(decoded(arrays_, parameters_, kPatches));
  parameters_.erase("atoms");
  EXPECT_FALSE(decoded(arrays_, parameters_, kPatches));
}

// The whole file, with patches of one colour only (no RBF anywhere) and without.
TEST(SparseModelFile, ReadsBackBitByBit) {
  for (const std::size_t most_rbfs : {std::size_t{0}, kMaxRbfs}) {
    const tests::TemporaryFolder folder;
    const core::Mesh mesh = fitting::testing::octahedron();
    const LightFieldModel model = random_sparse(mesh.positions.size(), most_rbfs, 3, kSeed);
    write_model(folder / "a.glb", mesh, model);
    const Model read = read_model(folder / "a.glb");
    EXPECT_EQ(read.light_field->representation(), "sparse");
    const auto& copy = dynamic_cast<const LightFieldModel&>(*read.light_field);
    EXPECT_EQ(copy.observed(), model.observed());
    for (std::size_t i = 0; i < model.patch_count(); ++i) {
      EXPECT_TRUE(same(copy.patch(i), model.patch(i))) << i;
    }
    write_model(folder / "b.glb", read.mesh, *read.light_field);
    EXPECT_TRUE(tests::read_file(folder / "a.glb") == tests::read_file(folder / "b.glb"));
  }
}

TEST(SparseModelFile, EveryFlippedByteIsRefused) {
  const tests::TemporaryFolder folder;
  const core::Mesh mesh = fitting::testing::octahedron();
  write_model(folder / "a.glb", mesh, random_sparse(mesh.positions.size(), 5, 3, kSeed));
  const std::string good = tests::read_file(folder / "a.glb");
  for (std::size_t at = 0; at < good.size(); at += 5) {
    std::string bytes = good;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
    tests::write_file(folder / "bad.glb", bytes);
    EXPECT_THROW(read_model(folder / "bad.glb"), core::Error) << at;
  }
}

}  // namespace
}  // namespace sheen::fitting::sparse
