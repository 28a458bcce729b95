// SPDX-License-Identifier: MIT
#include "capture/synthetic/board_print.h"

#include "capture/board_print/tag_bitmap.h"
#include "capture/pose/apriltag_family.h"
#include "capture/synthetic/brdf.h"

#include <cassert>
#include <cmath>

namespace sheen::capture::synthetic {
namespace {

constexpr float kPaper = 0.78f;
constexpr float kInk = 0.035f;
constexpr float kTable = 0.115f;
constexpr double kTagOfRadius = 0.56;  // side of a tag over the radius of the object
constexpr double kPitchOfTag = 58.0 / 42.0;

}  // namespace

BoardPrint::BoardPrint(double object_radius_m) {
  // Round the tag to millimetres, as one would print it.
  const double tag_m = std::ceil(object_radius_m * kTagOfRadius * 1000 - 0.5) / 1000;
  const double pitch_m = std::round(tag_m * kPitchOfTag * 1000) / 1000;
  tag_m_ = static_cast<float>(tag_m);
  pitch_m_ = static_cast<float>(pitch_m);
  half_width_m_ = static_cast<float>(pitch_m * kCells / 2 + 0.2 * tag_m);

  // Number the tags row by row from the lower left, skip the free middle.
  board_.family = "tag36h11";
  const auto family = AprilTagFamily::find(board_.family);
  assert(family);
  constexpr int margin = (kCells - kFreeCells) / 2;
  for (int cell = 0; cell < kCells * kCells; ++cell) {
    const int column = cell % kCells;
    const int row = cell / kCells;
    const bool is_free =
        column >= margin && column < kCells - margin && row >= margin && row < kCells - margin;
    print_of_cell_[static_cast<std::size_t>(cell)] =
        is_free ? -1 : static_cast<int>(prints_.size());
    if (is_free) continue;

    // Take the bitmap of libapriltag itself, without the white module around it.
    const int id = static_cast<int>(prints_.size());
    const TagBitmap bitmap = draw_tag(*family, id);
    assert(bitmap.modules == kModules + 2 && bitmap.modules_across_tag == kModules);
    Print& print = prints_.emplace_back();
    for (int y = 0; y < kModules; ++y) {
      for (int x = 0; x < kModules; ++x) {
        print[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] =
            !bitmap.is_black(y + 1, x + 1);
      }
    }
    Board::Tag tag;
    tag.size_m = tag_m;
    tag.board_from_tag.translation() << (column - kCells / 2) * pitch_m,
        (row - kCells / 2) * pitch_m, 0;
    board_.tags.emplace(id, tag);
  }
}

float BoardPrint::reflectance(float x, float y) const {
  if (std::abs(x) < half_width_m_ && std::abs(y) < half_width_m_) return paper(x, y);
  // Slate with a slight grain.
  return kTable * (1 + 0.22f * smooth_noise({x * 60, y * 22, 0.5f}) +
                   0.12f * smooth_noise({x * 210, y * 150, 3.5f}));
}

float BoardPrint::paper(float x, float y) const {
  // Find the cell and the module inside its tag.
  const float column = std::floor(x / pitch_m_ + kCells / 2.0f);
  const float row = std::floor(y / pitch_m_ + kCells / 2.0f);
  if (column < 0 || row < 0 || column >= kCells || row >= kCells) return kPaper;
  const int print =
      print_of_cell_[static_cast<std::size_t>(row) * kCells + static_cast<std::size_t>(column)];
  if (print < 0) return kPaper;
  const float right = (x - (column - kCells / 2) * pitch_m_) / tag_m_ + 0.5f;
  const float down = 0.5f - (y - (row - kCells / 2) * pitch_m_) / tag_m_;
  if (!(right >= 0 && right < 1 && down >= 0 && down < 1)) return kPaper;
  const bool white =
      prints_[static_cast<std::size_t>(print)][static_cast<std::size_t>(down * kModules)]
             [static_cast<std::size_t>(right * kModules)];
  return white ? kPaper : kInk;
}

}  // namespace sheen::capture::synthetic
