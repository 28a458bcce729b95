// SPDX-License-Identifier: MIT
#include "exporters/viewer/packed_arrays.h"

#include <zlib.h>

#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace sheen::exporters::viewer {
namespace {

using Column = std::vector<std::uint32_t>;

/// How a number of a column is foretold; what is kept is how far it is off. The page counts them
/// from 0 in this order.
enum class Prediction : std::uint8_t {
  none,             ///< kept as it is
  zero,             ///< kept with its sign
  previous_row,     ///< of the same column
  previous_column,  ///< of the same row
};
constexpr std::array kPredictions{Prediction::none, Prediction::zero, Prediction::previous_row,
                                  Prediction::previous_column};

/// Small numbers of either sign become small ones without: 0, -1, 1, -2, ... -> 0, 1, 2, 3, ...
/// Numbers have `bits` bits and wrap round.
std::uint32_t folded(std::uint32_t number, int bits) {
  const std::uint32_t mask = bits == 32 ? ~0u : (1u << bits) - 1;
  number &= mask;
  const bool negative = (number >> (bits - 1)) != 0;
  return (negative ? ~(number << 1) : number << 1) & mask;
}

Column residuals(Prediction prediction, const Column& column, const Column& left, int bits) {
  Column result(column.size());
  for (std::size_t row = 0; row < column.size(); ++row) {
    switch (prediction) {
      case Prediction::none:
        result[row] = column[row];
        break;
      case Prediction::zero:
        result[row] = folded(column[row], bits);
        break;
      case Prediction::previous_row:
        result[row] = folded(column[row] - (row > 0 ? column[row - 1] : 0), bits);
        break;
      case Prediction::previous_column:
        result[row] = folded(column[row] - left[row], bits);
        break;
    }
  }
  return result;
}

std::string planes_of(const Column& column, int bytes) {
  std::string planes;
  for (int byte = 0; byte < bytes; ++byte) {
    for (const std::uint32_t number : column)
      planes.push_back(static_cast<char>((number >> (8 * byte)) & 255));
  }
  return planes;
}

/// Bits that an ideal coder of single bytes would need, plane by plane.
double entropy(std::string_view planes, int bytes) {
  const std::size_t rows = planes.size() / static_cast<std::size_t>(bytes);
  double bits = 0;
  for (std::size_t begin = 0; begin < planes.size(); begin += rows) {
    std::array<std::size_t, 256> counts{};
    for (const char byte : planes.substr(begin, rows)) ++counts[static_cast<unsigned char>(byte)];
    for (const std::size_t count : counts) {
      if (count > 0) {
        bits -= static_cast<double>(count) *
                std::log2(static_cast<double>(count) / static_cast<double>(rows));
      }
    }
  }
  return bits;
}

}  // namespace

void PackedArrays::add(const std::string& name, std::span<const std::int32_t> rows,
                       std::size_t columns, int bytes) {
  assert(columns > 0 && rows.size() % columns == 0);
  const std::size_t row_count = rows.size() / columns;
  const std::uint32_t mask = bytes == 4 ? ~0u : (1u << (8 * bytes)) - 1;
  nlohmann::json predictions = nlohmann::json::array();
  Column left(row_count, 0);
  Column column(row_count);
  for (std::size_t c = 0; c < columns; ++c) {
    for (std::size_t row = 0; row < row_count; ++row) {
      column[row] = static_cast<std::uint32_t>(rows[row * columns + c]) & mask;
    }
    // Keep the prediction that leaves least to be told.
    double least = std::numeric_limits<double>::infinity();
    std::string best;
    Prediction chosen = Prediction::none;
    for (const Prediction prediction : kPredictions) {
      std::string planes = planes_of(residuals(prediction, column, left, 8 * bytes), bytes);
      const double bits = row_count > 0 ? entropy(planes, bytes) : 0;
      if (!(bits < least)) continue;
      least = bits;
      best = std::move(planes);
      chosen = prediction;
    }
    planes_ += best;
    predictions.push_back(static_cast<int>(chosen));
    std::swap(left, column);
  }
  tables_.push_back({{"name", name},
                     {"columns", columns},
                     {"rows", row_count},
                     {"bytes", bytes},
                     {"predictions", std::move(predictions)}});
}

std::string PackedArrays::compressed() const {
  uLongf size = compressBound(planes_.size());
  std::string bytes(size, '\0');
  const int status =
      compress2(reinterpret_cast<Bytef*>(bytes.data()), &size,
                reinterpret_cast<const Bytef*>(planes_.data()), planes_.size(), Z_BEST_COMPRESSION);
  if (status != Z_OK) throw std::bad_alloc();  // its only fault with such a buffer
  bytes.resize(size);
  return bytes;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text.push_back(i + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63]);
    }
  }
  return text;
}

}  // namespace sheen::exporters::viewer
