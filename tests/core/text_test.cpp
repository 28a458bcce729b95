// SPDX-License-Identifier: MIT
#include "core/diagnostics/error.h"
#include "core/text/number.h"
#include "core/text/text_form.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <random>

namespace sheen::core {
namespace {

TEST(ParseNumber, ReadsWhatPrintfWrites) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> exponent(-300, 300);
  for (int i = 0; i < 1000; ++i) {
    const double value = (i % 2 == 0 ? 1 : -1) * std::pow(10.0, exponent(random));
    char text[64];
    std::snprintf(text, sizeof(text), i % 3 == 0 ? "%.17e" : "%+.17g", value);
    EXPECT_EQ(parse_number(text), value) << text;
  }
}

TEST(ParseNumber, TooSmallIsZeroTooLargeIsNothing) {
  EXPECT_EQ(parse_number("1e-400"), 0.0);
  EXPECT_EQ(parse_number("-1e-400"), 0.0);
  EXPECT_EQ(parse_number("1e-320"), 1e-320);
  EXPECT_EQ(parse_number("1e400"), std::nullopt);
  EXPECT_TRUE(std::isnan(*parse_number("nan")));
  EXPECT_EQ(parse_number("-inf"), -std::numeric_limits<double>::infinity());
}

TEST(ParseNumber, TakesNothingButTheWholeWord) {
  for (const char* word : {"", "0,5", "1.5m", "5D-1", "0x10", "1 2", "--1", "1e", ".", "1_000"}) {
    EXPECT_EQ(parse_number(word), std::nullopt) << word;
  }
  EXPECT_NE(why_no_number("0,5").find("decimal comma"), std::string::npos);
  EXPECT_TRUE(has_decimal_comma("-12,25"));
  EXPECT_FALSE(has_decimal_comma("1.5"));
}

TEST(ParseNumber, IgnoresTheLocale) {
  const std::string before = std::setlocale(LC_NUMERIC, nullptr);
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C"}) std::setlocale(LC_NUMERIC, name);
  EXPECT_EQ(parse_number("0.25"), 0.25);
  std::setlocale(LC_NUMERIC, before.c_str());
}

TEST(ParseWholeNumber, LeadingZerosAreNoOctalNumbers) {
  EXPECT_EQ(parse_whole_number("010"), 10);
  EXPECT_EQ(parse_whole_number("008"), 8);
  EXPECT_EQ(parse_whole_number("-7"), -7);
  EXPECT_EQ(parse_whole_number("7.5"), std::nullopt);
  EXPECT_EQ(parse_whole_number("99999999999999999999"), std::nullopt);
}

TEST(Quotable, LeavesNothingThatATerminalObeys) {
  const std::string text = quotable("\x1b[31mred\n\x07" + std::string(500, 'x'), 40);
  EXPECT_LE(text.size(), 44u);
  for (const char c : text) EXPECT_GE(c, ' ');
}

TEST(NormaliseText, BringsEveryFormToOne) {
  for (const std::string mark : {"", "\xef\xbb\xbf"}) {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
      std::string text = mark + "a b" + end + end + "c" + end;
      normalise_text(text, "file.txt");
      EXPECT_EQ(text, "a b\n\nc\n");
    }
  }
}

TEST(NormaliseText, NamesUtf16) {
  for (const std::string mark : {"\xff\xfe", "\xfe\xff"}) {
    std::string text = mark + std::string("a\0", 2);
    try {
      normalise_text(text, "file.txt");
      ADD_FAILURE() << "was accepted";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("UTF-16"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace sheen::core
