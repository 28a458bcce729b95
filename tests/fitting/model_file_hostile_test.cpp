// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"
#include "core/text/nesting.h"
#include "fitting/model_file/checksum.h"
#include "fitting/model_file/document.h"
#include "fitting/model_file/glb.h"
#include "tests/fitting/models_for_tests.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>

namespace sheen::fitting {
namespace {

using nlohmann::json;
using tests::read_file;
using tests::write_file;

class HostileModelFile : public ::testing::Test {
 protected:
  HostileModelFile() {
    const core::Mesh mesh = testing::octahedron();
    write_good(mesh, testing::fitted("iwls", mesh)->light_field());
  }

  void write_good(const core::Mesh& mesh, const LightField& light_field) {
    write_model(folder_ / "good.glb", mesh, light_field);
    good_ = read_file(folder_ / "good.glb");
  }

  // Whether the bytes are refused as bad input with one line that names the file.
  bool refused(const std::string& bytes) {
    write_file(folder_ / "bad.glb", bytes);
    try {
      read_model(folder_ / "bad.glb");
      return false;
    } catch (const core::Error& error) {
      const std::string line = error.what();
      EXPECT_EQ(error.kind(), core::Error::Kind::bad_input);
      EXPECT_NE(line.find("bad.glb"), std::string::npos);
      EXPECT_EQ(line.find('\n'), std::string::npos);
      message_ = line;
      return true;
    }
  }

  // The good file after a change by someone who knows how to compute the checksum.
  std::string with_new_checksum(const std::function<void(json&, std::string&)>& change) {
    const Glb glb = parse_glb(good_);
    json document = glb.document;
    std::string binary(reinterpret_cast<const char*>(glb.binary.data()), glb.binary.size());
    document["extensions"][kExtension]["checksum"] = kChecksumPlaceholder;
    change(document, binary);
    std::string file = *glb_bytes(document, binary);
    if (file.find(kChecksumPlaceholder) != std::string::npos) write_checksum(file);
    return file;
  }

  tests::TemporaryFolder folder_;
  std::string good_;
  std::string message_;
};

TEST_F(HostileModelFile, NewChecksumAloneIsAccepted) {
  EXPECT_FALSE(refused(with_new_checksum([](json&, std::string&) {})));
}

TEST_F(HostileModelFile, EveryTruncationIsRefused) {
  for (std::size_t length = 0; length < good_.size(); ++length) {
    ASSERT_TRUE(refused(good_.substr(0, length))) << length;
  }
  EXPECT_TRUE(refused(good_ + "x"));
}

// FNV-1a notices any single byte; what comes before it in the reader must not crash. Every bit of
// the text, every byte of a sample of the rest.
TEST_F(HostileModelFile, EveryFlippedBitIsRefused) {
  const std::size_t text = good_.size() - parse_glb(good_).binary.size();
  for (std::size_t at = 0; at < good_.size(); at += at < text ? 1 : 7) {
    std::string bytes = good_;
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << (at % 8)));
    ASSERT_TRUE(refused(bytes)) << at;
  }
}

TEST_F(HostileModelFile, ForeignFilesAreRefused) {
  EXPECT_TRUE(refused(""));
  EXPECT_TRUE(refused(std::string(1000, '\0')));
  EXPECT_TRUE(refused("ply\nformat binary_little_endian 1.0\n"));
  EXPECT_TRUE(refused(
      with_new_checksum([](json& document, std::string&) { document.erase("extensions"); })));
  EXPECT_NE(message_.find(kExtension), std::string::npos);
  EXPECT_THROW(read_model(folder_ / "absent.glb"), core::Error);
  std::filesystem::create_directories(folder_ / "folder.glb");
  EXPECT_THROW(read_model(folder_ / "folder.glb"), core::Error);
}

// Each change leaves a correct checksum: the structure itself must be checked.
TEST_F(HostileModelFile, BrokenStructureIsRefused) {
  const json big = 9007199254740992u;
  const std::vector<std::function<void(json&)>> changes{
      [](json& d) { d["extensions"][kExtension]["version"] = 2; },
      [](json& d) { d["extensions"][kExtension]["representation"] = "nonsense"; },
      [](json& d) { d["extensions"][kExtension]["representation"] = "mean"; },
      [](json& d) { d["extensions"][kExtension]["representation"] = 7; },
      [](json& d) { d["extensions"][kExtension]["directionMap"] = "octahedral"; },
      [](json& d) { d["extensions"][kExtension]["seen"] = 0; },  // 72 bytes instead of 48
      [](json& d) { d["extensions"][kExtension]["seen"] = 1000; },
      [](json& d) { d["extensions"][kExtension]["seen"] = -1; },
      [](json& d) { d["extensions"][kExtension]["seen"] = "all"; },
      [](json& d) { d["extensions"][kExtension]["parameters"]["terms"] = 4; },
      [](json& d) { d["extensions"][kExtension]["parameters"]["terms"] = 6; },
      [](json& d) { d["extensions"][kExtension]["parameters"]["terms"] = -3; },
      [](json& d) { d["extensions"][kExtension]["parameters"]["supportRadius"] = 0; },
      [](json& d) { d["extensions"][kExtension]["parameters"]["supportRadius"] = 1e300; },
      // Sixteen cells of 1/2: supports below half a diagonal, .354, leave holes between them.
      [](json& d) { d["extensions"][kExtension]["parameters"]["supportRadius"] = 0.35; },
      // All centres in one corner reach no further than .707 from it.
      [](json& d) {
        json& centers = d["extensions"][kExtension]["parameters"]["centers"];
        for (json& center : centers) center = centers[0];
      },
      [](json& d) { d["extensions"][kExtension]["parameters"]["centers"] = json::array(); },
      [](json& d) {
        d["extensions"][kExtension]["parameters"]["centers"].push_back({0, 0});
      },
      [](json& d) {
        d["extensions"][kExtension]["parameters"]["centers"][3] = {0, 1e9};
      },
      [](json& d) {
        d["extensions"][kExtension]["parameters"]["centers"][3] = {"a", 0};
      },
      [](json& d) { d["extensions"][kExtension]["parameters"]["layout"] = "hexagons"; },
      [](json& d) { d["extensions"][kExtension]["parameters"] = json::array(); },
      [](json& d) { d["extensions"][kExtension]["arrays"]["coefficients"] = 99; },
      [](json& d) { d["extensions"][kExtension]["arrays"] = 5; },
      [](json& d) { d["extensions"][kExtension]["arrays"].clear(); },
      [](json& d) { d["extensions"][kExtension]["observed"] = 0; },
      [](json& d) { d["extensions"][kExtension].erase("observed"); },
      [&](json& d) { d["accessors"][0]["count"] = big; },
      [](json& d) { d["accessors"][0]["count"] = 0; },
      [](json& d) { d["accessors"][0]["count"] = -1; },
      [](json& d) { d["accessors"][0]["componentType"] = 5123; },
      [](json& d) { d["accessors"][3]["count"] = 23; },
      [&](json& d) { d["bufferViews"][0]["byteLength"] = big; },
      [&](json& d) { d["bufferViews"][0]["byteOffset"] = big; },
      [](json& d) { d["bufferViews"][0]["buffer"] = 1; },
      [](json& d) { d["bufferViews"][1]["byteOffset"] = 1; },
      [](json& d) { d["bufferViews"] = json::object(); },
      [](json& d) { d["meshes"] = json::array(); },
      [](json& d) { d["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL"); },
      [](json& d) { d["meshes"][0]["primitives"][0]["indices"] = 1e30; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    EXPECT_TRUE(refused(with_new_checksum([&](json& document, std::string&) {
      changes[i](document);
    }))) << i;
  }
}

/// The same with a texture; each of the octahedron's faces is a chart, so vertices are repeated.
class HostileTexture : public HostileModelFile {
 protected:
  HostileTexture() {
    const core::Mesh mesh = testing::octahedron();
    const auto fitter = make_fitter("detail", mesh, {{"texel-mm", "20"}});
    write_good(mesh, fitter->light_field());
  }
};

TEST_F(HostileTexture, NewChecksumAloneIsAccepted) {
  EXPECT_FALSE(refused(with_new_checksum([](json&, std::string&) {})));
}

TEST_F(HostileTexture, EveryTruncationIsRefused) {
  for (std::size_t length = 0; length < good_.size(); length += 3) {
    ASSERT_TRUE(refused(good_.substr(0, length))) << length;
  }
}

// Whatever the image holds, reading ends with a model or a refusal.
TEST_F(HostileTexture, BrokenImagesAreRefusedOrRead) {
  const Glb glb = parse_glb(good_);
  const json& view =
      glb.document["bufferViews"][glb.document["images"][0]["bufferView"].get<int>()];
  const auto begin = view["byteOffset"].get<std::size_t>();
  const auto size = view["byteLength"].get<std::size_t>();
  for (std::size_t at = 0; at < size; ++at) {
    const bool was_refused = refused(with_new_checksum([&](json&, std::string& binary) {
      binary[begin + at] = static_cast<char>(binary[begin + at] ^ (1 << (at % 8)));
    }));
    // Signature, sizes, depth and kind of colour.
    if (at < 26) {
      EXPECT_TRUE(was_refused) << at;
    }
  }
  // An image that claims to be 65536 texels wide, and one that ends early.
  EXPECT_TRUE(
      refused(with_new_checksum([&](json&, std::string& binary) { binary[begin + 17] = 1; })));
  EXPECT_TRUE(refused(with_new_checksum([&](json& document, std::string&) {
    document["bufferViews"][document["images"][0]["bufferView"].get<int>()]["byteLength"] = 40;
  })));
}

TEST_F(HostileTexture, BrokenStructureIsRefused) {
  const auto image_view = [](json& d) -> json& {
    return d["bufferViews"][d["images"][0]["bufferView"].get<int>()];
  };
  const auto attributes = [](json& d) -> json& {
    return d["meshes"][0]["primitives"][0]["attributes"];
  };
  const std::vector<std::function<void(json&)>> changes{
      [](json& d) { d["extensions"][kExtension].erase("image"); },
      [](json& d) { d["extensions"][kExtension]["image"] = 1; },
      [](json& d) { d["extensions"][kExtension]["image"] = "a"; },
      [](json& d) { d.erase("images"); },
      [](json& d) { d["images"][0]["bufferView"] = 99; },
      [&](json& d) { image_view(d)["byteLength"] = 0; },
      [&](json& d) { image_view(d)["byteOffset"] = 0; },
      [&](json& d) { attributes(d).erase("TEXCOORD_0"); },
      [&](json& d) { attributes(d)["TEXCOORD_0"] = attributes(d)["POSITION"]; },
      [&](json& d) { d["accessors"][attributes(d)["TEXCOORD_0"].get<int>()]["count"] = 7; },
      [](json& d) { d["extensions"][kExtension].erase("copies"); },
      [](json& d) { d["extensions"][kExtension]["copies"] = 0; },
      [](json& d) { d["extensions"][kExtension]["representation"] = "sparse"; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    EXPECT_TRUE(refused(with_new_checksum([&](json& document, std::string&) {
      changes[i](document);
    }))) << i;
  }
}

// A parser that recurses would overflow its stack here.
TEST_F(HostileModelFile, DeepNestingDoesNotCrash) {
  std::string file = good_;
  const std::string deep(1000000, '[');
  const std::size_t text_at = 20;
  file.insert(text_at, deep);
  const auto put = [&](std::size_t at, std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    std::memcpy(file.data() + at, &word, 4);
  };
  std::uint32_t text_size = 0;
  std::memcpy(&text_size, good_.data() + 12, 4);
  put(8, file.size());
  put(12, text_size + deep.size());
  EXPECT_TRUE(refused(file));
}

// So would a copy of what it made of balanced brackets.
TEST_F(HostileModelFile, DeepExtensionsDoNotCrash) {
  const std::string deep = std::string(1000000, '[') + std::string(1000000, ']');
  std::uint32_t text_size = 0;
  std::memcpy(&text_size, good_.data() + 12, 4);
  std::string text = json{{"asset", {{"version", "2.0"}}}}.dump();
  text.insert(text.size() - 1, ",\"extensions\":" + deep);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string file = good_.substr(0, 20) + text + good_.substr(20 + text_size);
  const auto put = [&](std::size_t at, std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    std::memcpy(file.data() + at, &word, 4);
  };
  put(8, file.size());
  put(12, text.size());
  EXPECT_TRUE(refused(file));
}

// Nor may the checksum, which anybody can compute, open the way: copying 10,000 levels would need a
// megabyte of stack, a hundred are refused already.
TEST_F(HostileModelFile, NestedParametersAreRefused) {
  EXPECT_TRUE(refused(with_new_checksum([](json& document, std::string&) {
    json nest = json::array();
    for (int level = 0; level < 100; ++level) nest = json::array({std::move(nest)});
    document["extensions"][kExtension]["parameters"]["terms"] = std::move(nest);
  })));
  EXPECT_NE(message_.find("nests"), std::string::npos) << message_;
  EXPECT_EQ(core::json_depth(R"({"a": "[[[", "b": [{}, "\\"], "\"[": []})"), 3u);
  EXPECT_EQ(core::bracket_depth(R"(# 12" [[[ ]]] ] {})"), 3u);
}

// The same for what the arrays hold. View 3 is the triangles, the last-but-one the coefficients.
TEST_F(HostileModelFile, BrokenNumbersAreRefused) {
  const auto refuses_in_view = [&](const std::function<std::size_t(const json&)>& view_of,
                                   const std::string& bytes) {
    return refused(with_new_checksum([&](json& document, std::string& binary) {
      const json& view = document["bufferViews"][view_of(document)];
      binary.replace(view["byteOffset"].get<std::size_t>(), bytes.size(), bytes);
    }));
  };
  const auto attribute = [](const char* name) {
    return [name](const json& document) -> std::size_t {
      return document["meshes"][0]["primitives"][0]["attributes"][name].get<std::size_t>();
    };
  };
  const auto coefficients = [](const json& document) {
    return document["extensions"][kExtension]["arrays"]["coefficients"].get<std::size_t>();
  };
  const std::string float_nan("\x00\x00\xc0\x7f", 4);
  EXPECT_TRUE(refuses_in_view(attribute("POSITION"), float_nan));
  EXPECT_TRUE(refuses_in_view(attribute("NORMAL"), float_nan));
  EXPECT_TRUE(refuses_in_view(attribute("NORMAL"), std::string(4, '\0')));
  EXPECT_TRUE(refuses_in_view([](const json&) -> std::size_t { return 3; }, "\x06\x01\x01\x01"));
  EXPECT_TRUE(refuses_in_view(coefficients, std::string("\x00\x7e", 2)));  // NaN
  EXPECT_TRUE(refuses_in_view(coefficients, std::string("\x00\xfc", 2)));  // -infinity
  EXPECT_TRUE(refuses_in_view(
      [](const json& document) {
        return document["extensions"][kExtension]["observed"].get<std::size_t>();
      },
      "\x02"));
}

}  // namespace
}  // namespace sheen::fitting
