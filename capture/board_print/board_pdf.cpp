// SPDX-License-Identifier: MIT
#include "capture/board_print/board_pdf.h"

#include "capture/board_print/tag_bitmap.h"
#include "core/files/write_file.h"

#include <fmt/format.h>
#include <hpdf.h>

#include <memory>
#include <new>
#include <string>
#include <type_traits>

namespace sheen::capture {
namespace {

constexpr double kPointsPerMm = 72 / 25.4;
constexpr double kTextMm = 3.2;
constexpr double kThinMm = 0.15;

/// One page, drawn in millimetres from its lower left corner. libhpdf remembers the first fault of
/// a document; it is looked at once, at the end.
class Page {
 public:
  Page(HPDF_Doc document, HPDF_Font font, const Paper& paper)
      : page_(HPDF_AddPage(document)), font_(font) {
    HPDF_Page_SetWidth(page_, points(paper.width_mm));
    HPDF_Page_SetHeight(page_, points(paper.height_mm));
    set_grey(0);
  }

  void set_grey(double level) {
    const auto value = static_cast<HPDF_REAL>(level);
    HPDF_Page_SetGrayFill(page_, value);
    HPDF_Page_SetGrayStroke(page_, value);
  }

  void line(double x0, double y0, double x1, double y1, double width_mm = kThinMm) {
    HPDF_Page_SetLineWidth(page_, points(width_mm));
    HPDF_Page_MoveTo(page_, points(x0), points(y0));
    HPDF_Page_LineTo(page_, points(x1), points(y1));
    HPDF_Page_Stroke(page_);
  }

  void text(double x, double y, const std::string& words, double size_mm = kTextMm) {
    HPDF_Page_BeginText(page_);
    HPDF_Page_SetFontAndSize(page_, font_, points(size_mm));
    HPDF_Page_TextOut(page_, points(x), points(y), words.c_str());
    HPDF_Page_EndText(page_);
  }

  void centred_text(double x, double y, const std::string& words, double size_mm = kTextMm) {
    HPDF_Page_SetFontAndSize(page_, font_, points(size_mm));
    const double width_mm =
        static_cast<double>(HPDF_Page_TextWidth(page_, words.c_str())) / kPointsPerMm;
    text(x - width_mm / 2, y, words, size_mm);
  }

  /// All black modules as one path: no hairline shows between two of them.
  void tag(const TagBitmap& bitmap, double centre_x, double centre_y, double tag_mm) {
    const double module_mm = tag_mm / bitmap.modules_across_tag;
    const double left = centre_x - module_mm * bitmap.modules / 2;
    const double top = centre_y + module_mm * bitmap.modules / 2;
    for (int row = 0; row < bitmap.modules; ++row) {
      for (int column = 0; column < bitmap.modules; ++column) {
        if (!bitmap.is_black(row, column)) continue;
        HPDF_Page_Rectangle(page_, points(left + column * module_mm),
                            points(top - (row + 1) * module_mm), points(module_mm),
                            points(module_mm));
      }
    }
    HPDF_Page_Fill(page_);
  }

 private:
  static HPDF_REAL points(double mm) { return static_cast<HPDF_REAL>(mm * kPointsPerMm); }

  HPDF_Page page_;
  HPDF_Font font_;
};

void draw_tags(Page& page, const BoardPlan& plan, const BoardSheet& sheet) {
  const auto family = AprilTagFamily::find(plan.design.family).value();
  const auto [left, bottom] = block_corner_mm(plan, sheet);
  for (int row = 0; row < sheet.rows; ++row) {
    for (int column = 0; column < sheet.columns; ++column) {
      const auto id = plan.tag_id(sheet.first_column + column, sheet.first_row + row);
      if (!id) continue;
      page.tag(draw_tag(family, *id), left + (column + 0.5) * plan.pitch_mm,
               bottom + (row + 0.5) * plan.pitch_mm, plan.design.tag_mm);
    }
  }
}

/// Origin and axes of the board, in a grey that no detector takes for an edge of a tag.
void draw_axes(Page& page, const BoardPlan& plan, const BoardSheet& sheet) {
  constexpr double length_mm = 12;
  constexpr double light = 0.7;
  if (!(plan.free_width_mm > 2 * length_mm && plan.free_height_mm > 2 * length_mm)) return;
  const double columns = plan.columns / 2.0 - sheet.first_column;
  const double rows = plan.rows / 2.0 - sheet.first_row;
  if (columns < 0 || columns > sheet.columns || rows < 0 || rows > sheet.rows) return;
  const auto [left, bottom] = block_corner_mm(plan, sheet);
  const double x = left + columns * plan.pitch_mm;
  const double y = bottom + rows * plan.pitch_mm;
  page.set_grey(light);
  page.line(x - length_mm / 3, y, x + length_mm, y);
  page.line(x, y - length_mm / 3, x, y + length_mm);
  page.text(x + length_mm + 1, y - 1, "x");
  page.text(x - 0.8, y + length_mm + 1.2, "y");
  page.set_grey(0);
}

/// Where to cut: short lines outside the corners of the sheet's cells.
void draw_cut_marks(Page& page, const BoardPlan& plan, const BoardSheet& sheet) {
  constexpr double gap_mm = 1;
  constexpr double length_mm = 4;
  const auto [left, bottom] = block_corner_mm(plan, sheet);
  const double right = left + sheet.columns * plan.pitch_mm;
  const double top = bottom + sheet.rows * plan.pitch_mm;
  for (const double x : {left, right}) {
    page.line(x, bottom - gap_mm, x, bottom - gap_mm - length_mm);
    page.line(x, top + gap_mm, x, top + gap_mm + length_mm);
  }
  for (const double y : {bottom, top}) {
    page.line(left - gap_mm, y, left - gap_mm - length_mm, y);
    page.line(right + gap_mm, y, right + gap_mm + length_mm, y);
  }
}

void draw_ruler(Page& page, const Paper& paper) {
  constexpr double height_mm = 12;
  const double left = (paper.width_mm - kRulerMm) / 2;
  page.line(left, height_mm, left + kRulerMm, height_mm);
  for (int mm = 0; mm <= static_cast<int>(kRulerMm); ++mm) {
    const double tick_mm = mm % 10 == 0 ? 4 : mm % 5 == 0 ? 2.6 : 1.6;
    page.line(left + mm, height_mm, left + mm, height_mm + tick_mm, 0.1);
    if (mm % 10 == 0) page.centred_text(left + mm, height_mm + 4.6, std::to_string(mm), 2.2);
  }
  page.centred_text(
      paper.width_mm / 2, 7.5,
      fmt::format("Print at 100 %, not fitted to the page. Measure this ruler: {} mm from 0 to {}.",
                  kRulerMm, kRulerMm));
}

/// What the sheet is, and what to do when the ruler is not as long as it says.
void draw_words(Page& page, const BoardPlan& plan, std::size_t sheet_number) {
  const auto& ids = plan.board.tags;
  std::string words =
      fmt::format("{}, ids {}-{}, {} mm; another length: sheen board --measured-mm",
                  plan.design.family, ids.begin()->first, ids.rbegin()->first, plan.design.tag_mm);
  if (plan.sheets.size() > 1) {
    words += fmt::format("; sheet {} of {}, cut at the marks", sheet_number, plan.sheets.size());
  }
  page.centred_text(plan.design.paper.width_mm / 2, 3.8, words, 2.6);
}

std::string bytes_of(HPDF_Doc document) {
  HPDF_SaveToStream(document);
  std::string bytes(HPDF_GetStreamSize(document), '\0');
  auto size = static_cast<HPDF_UINT32>(bytes.size());
  HPDF_ReadFromStream(document, reinterpret_cast<HPDF_BYTE*>(bytes.data()), &size);
  if (HPDF_GetError(document) != HPDF_OK) throw std::bad_alloc();  // nothing else can fail
  return bytes;
}

}  // namespace

void write_board_pdf(const std::filesystem::path& path, const BoardPlan& plan) {
  const std::unique_ptr<std::remove_pointer_t<HPDF_Doc>, decltype(&HPDF_Free)> document(
      HPDF_New(nullptr, nullptr), HPDF_Free);
  if (!document) throw std::bad_alloc();
  HPDF_SetCompressionMode(document.get(), HPDF_COMP_ALL);
  HPDF_Font font = HPDF_GetFont(document.get(), "Helvetica", nullptr);
  for (std::size_t i = 0; i < plan.sheets.size(); ++i) {
    const BoardSheet& sheet = plan.sheets[i];
    Page page(document.get(), font, plan.design.paper);
    draw_tags(page, plan, sheet);
    draw_axes(page, plan, sheet);
    if (plan.sheets.size() > 1) draw_cut_marks(page, plan, sheet);
    draw_ruler(page, plan.design.paper);
    draw_words(page, plan, i + 1);
  }
  core::write_file(path, bytes_of(document.get()));
}

}  // namespace sheen::capture
