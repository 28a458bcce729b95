// SPDX-License-Identifier: MIT
#include "exporters/viewer/packed_arrays.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <random>
#include <string>
#include <vector>

namespace sheen::exporters::viewer {
namespace {

/// As docs/exports.md says, written without a look at the packing: unpacked numbers, row by row.
std::vector<std::uint32_t> unpacked(const nlohmann::json& table, const std::string& planes,
                                    std::size_t& place) {
  const auto rows = table["rows"].get<std::size_t>();
  const auto columns = table["columns"].get<std::size_t>();
  const auto bytes = table["bytes"].get<std::size_t>();
  const std::uint64_t range = std::uint64_t{1} << (8 * bytes);
  std::vector<std::uint32_t> numbers(rows * columns);
  for (std::size_t c = 0; c < columns; ++c) {
    const int prediction = table["predictions"][c].get<int>();
    for (std::size_t row = 0; row < rows; ++row) {
      std::uint64_t kept = 0;
      for (std::size_t byte = 0; byte < bytes; ++byte) {
        kept |= std::uint64_t{static_cast<unsigned char>(planes[place + byte * rows + row])}
                << (8 * byte);
      }
      std::uint64_t foretold = 0;
      if (prediction == 2 && row > 0) foretold = numbers[(row - 1) * columns + c];
      if (prediction == 3 && c > 0) foretold = numbers[row * columns + c - 1];
      const std::uint64_t off = kept % 2 == 0 ? kept / 2 : range - (kept + 1) / 2;
      numbers[row * columns + c] =
          static_cast<std::uint32_t>(prediction == 0 ? kept : (foretold + off) % range);
    }
    place += rows * bytes;
  }
  return numbers;
}

TEST(PackedArrays, AreUnpackedAsTheDocumentSays) {
  // Smooth, random, equal and extreme columns, so that every prediction has its turn.
  constexpr unsigned seed = 7;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  PackedArrays packed;
  std::vector<std::vector<std::int32_t>> tables;
  for (const int bytes : {1, 2, 4}) {
    std::vector<std::int32_t> rows;
    for (int row = 0; row < 300; ++row) {
      const auto noise = static_cast<std::int32_t>(random());
      rows.insert(rows.end(), {100 * row, noise, noise + 3, row % 2 == 0 ? -1 : 1, -1 - 7 * row});
    }
    packed.add("table", rows, 5, bytes);
    tables.push_back(rows);
  }
  const std::string compressed = packed.compressed();
  std::string planes(packed.unpacked_bytes(), '\0');
  uLongf size = planes.size();
  ASSERT_EQ(uncompress(reinterpret_cast<Bytef*>(planes.data()), &size,
                       reinterpret_cast<const Bytef*>(compressed.data()), compressed.size()),
            Z_OK);
  std::size_t place = 0;
  for (std::size_t t = 0; t < tables.size(); ++t) {
    const auto numbers = unpacked(packed.tables()[t], planes, place);
    ASSERT_EQ(numbers.size(), tables[t].size());
    const std::uint32_t mask = t == 2 ? ~0u : t == 1 ? 0xffffu : 0xffu;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      ASSERT_EQ(numbers[i], static_cast<std::uint32_t>(tables[t][i]) & mask) << t << " " << i;
    }
  }
  EXPECT_EQ(place, planes.size());
}

TEST(PackedArrays, TakeATableWithoutRows) {
  PackedArrays packed;
  packed.add("nothing", {}, 2, 4);
  EXPECT_EQ(packed.unpacked_bytes(), 0u);
  EXPECT_EQ(packed.tables()[0]["rows"], 0);
}

TEST(Base64, IsThatOfRfc4648) {
  // Its section 10.
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace sheen::exporters::viewer
