// SPDX-License-Identifier: MIT
#include "core/mesh/ply_header.h"

#include "core/diagnostics/error.h"

#include <charconv>
#include <sstream>
#include <utility>

namespace sheen::core {
namespace {

std::optional<PlyScalar> scalar_named(std::string_view name) {
  constexpr std::pair<std::string_view, PlyScalar> names[] = {
      {"char", PlyScalar::int8},      {"int8", PlyScalar::int8},
      {"uchar", PlyScalar::uint8},    {"uint8", PlyScalar::uint8},
      {"short", PlyScalar::int16},    {"int16", PlyScalar::int16},
      {"ushort", PlyScalar::uint16},  {"uint16", PlyScalar::uint16},
      {"int", PlyScalar::int32},      {"int32", PlyScalar::int32},
      {"uint", PlyScalar::uint32},    {"uint32", PlyScalar::uint32},
      {"float", PlyScalar::float32},  {"float32", PlyScalar::float32},
      {"double", PlyScalar::float64}, {"float64", PlyScalar::float64}};
  for (const auto& [known, type] : names) {
    if (known == name) return type;
  }
  return std::nullopt;
}

std::optional<PlyFormat> format_named(std::string_view name) {
  if (name == "ascii") return PlyFormat::ascii;
  if (name == "binary_little_endian") return PlyFormat::little_endian;
  if (name == "binary_big_endian") return PlyFormat::big_endian;
  return std::nullopt;
}

std::vector<std::string> words_of(std::string_view line) {
  std::istringstream stream{std::string(line)};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::optional<PlyElement> element_of(const std::vector<std::string>& words) {
  if (words.size() != 3) return std::nullopt;
  PlyElement element{.name = words[1], .rows = 0, .properties = {}};
  const char* end = words[2].data() + words[2].size();
  const auto parsed = std::from_chars(words[2].data(), end, element.rows);
  if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
  return element;
}

std::optional<PlyProperty> property_of(const std::vector<std::string>& words) {
  const bool is_list = words.size() == 5 && words[1] == "list";
  if (!is_list && words.size() != 3) return std::nullopt;
  const auto type = scalar_named(words[is_list ? 3 : 1]);
  const auto count = is_list ? scalar_named(words[2]) : std::nullopt;
  if (!type || (is_list && !count)) return std::nullopt;
  return PlyProperty{words.back(), *type, count};
}

/// Takes one line into the header; false when it makes no sense.
bool integrate(const std::vector<std::string>& words, PlyHeader& header, bool& has_format) {
  if (words.empty() || words[0] == "comment" || words[0] == "obj_info") return true;
  if (words[0] == "format" && words.size() == 3) {
    const auto format = format_named(words[1]);
    has_format = format.has_value();
    header.format = format.value_or(PlyFormat::ascii);
    return has_format;
  }
  if (words[0] == "element") {
    const auto element = element_of(words);
    if (element) header.elements.push_back(*element);
    return element.has_value();
  }
  if (words[0] == "property" && !header.elements.empty()) {
    const auto property = property_of(words);
    if (property) header.elements.back().properties.push_back(*property);
    return property.has_value();
  }
  return false;
}

}  // namespace

PlyHeader parse_ply_header(std::string_view bytes, const std::filesystem::path& path) {
  const auto broken = [&path](const std::string& fault) {
    return bad_input(path, fault, "it may be cut short; write it again");
  };
  // Lines end with \n, as the first one shows, or with \r alone.
  const std::size_t mark = bytes.starts_with("\xef\xbb\xbf") ? 3 : 0;
  const std::size_t first_end = bytes.find_first_of("\r\n", mark);
  if (first_end == std::string_view::npos ||
      words_of(bytes.substr(mark, first_end - mark)) != std::vector<std::string>{"ply"}) {
    throw broken("does not begin like a PLY file");
  }
  const bool has_returns_only =
      bytes[first_end] == '\r' && !bytes.substr(first_end).starts_with("\r\n");
  const char line_end = has_returns_only ? '\r' : '\n';
  PlyHeader header;
  bool has_format = false;
  std::size_t begin = bytes.find(line_end, mark) + 1;
  while (true) {
    const std::size_t end = bytes.find(line_end, begin);
    if (end == std::string_view::npos) throw broken("has a header without an end");
    const std::vector<std::string> words = words_of(bytes.substr(begin, end - begin));
    begin = end + 1;
    if (words.size() == 1 && words[0] == "end_header") break;
    if (!integrate(words, header, has_format))
      throw broken("has a header line that makes no sense");
  }
  if (!has_format) throw broken("does not name its format");
  header.size_bytes = begin;
  // Every row of an element takes at least one byte.
  for (const PlyElement& element : header.elements) {
    if (!element.properties.empty() && element.rows > bytes.size() - begin) {
      throw broken("is shorter than its header says");
    }
  }
  return header;
}

}  // namespace sheen::core
