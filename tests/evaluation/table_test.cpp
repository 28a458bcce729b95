// SPDX-License-Identifier: MIT
#include "evaluation/report/table.h"

#include "core/diagnostics/error.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace sheen::evaluation {
namespace {

const Table kTable{"Numbers", {"name", "value"}, {{"a, b", "1.50"}, {"c", "10.25"}}};

TEST(Table, MarkdownIsAligned) {
  EXPECT_EQ(markdown(kTable),
            "### Numbers\n\n"
            "| name | value |\n"
            "|------|------:|\n"
            "| a, b |  1.50 |\n"
            "| c    | 10.25 |\n");
}

TEST(Table, CsvQuotesCommas) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "bench_table";
  std::filesystem::remove_all(folder);
  write_csv(folder / "numbers.csv", kTable);
  std::ifstream file(folder / "numbers.csv");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), "name,value\n\"a, b\",1.50\nc,10.25\n");
  std::filesystem::remove_all(folder);
}

TEST(Table, SaysWhichFileCannotBeWritten) {
  EXPECT_THROW(write_csv("/proc/no/such/folder/numbers.csv", kTable), core::Error);
}

}  // namespace
}  // namespace sheen::evaluation
