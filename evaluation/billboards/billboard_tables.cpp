// SPDX-License-Identifier: MIT
#include "evaluation/billboards/billboard_tables.h"

#include "evaluation/billboards/paper_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

namespace sheen::evaluation {
namespace {

constexpr int kAntialiasedSamples = 4;
constexpr std::size_t kBakes = kBakeFields_deg.size();

std::string bake_name(double field_deg) {
  return field_deg > 0 ? fmt::format("{:.0f} deg", field_deg) : "ortho";
}

/// Errors reach from tens to hundreds.
std::string error_text(double value) {
  return decimals(value, value < 99.95 ? 1 : 0);
}

std::size_t bake_at(double field_deg) {
  return static_cast<std::size_t>(std::ranges::find(kBakeFields_deg, field_deg) -
                                  kBakeFields_deg.begin());
}

std::size_t distance_at(double distance) {
  return static_cast<std::size_t>(std::ranges::find(kDistances, distance) - kDistances.begin());
}

double least_at(const BillboardErrors& errors) {
  const auto& averages = errors.average;
  return kDistances[static_cast<std::size_t>(std::ranges::min_element(averages) -
                                             averages.begin())];
}

/// From the first to the last of two distances no average is above the one before.
bool falls(const BillboardErrors& errors, double first, double last) {
  for (std::size_t i = distance_at(first) + 1; i <= distance_at(last); ++i) {
    if (errors.average[i] > errors.average[i - 1]) return false;
  }
  return true;
}

/// Of orthographic frames, over the views; `stride` is from one view's figures to the next one's.
BillboardErrors mean_of(const std::vector<BillboardErrors>& all, std::size_t stride) {
  BillboardErrors mean{0, 0, {}, {}};
  for (std::size_t view = 0; view < kViewFields_deg.size(); ++view) {
    for (std::size_t d = 0; d < kDistances.size(); ++d) {
      mean.average[d] +=
          all[view * stride].average[d] / static_cast<double>(kViewFields_deg.size());
    }
  }
  return mean;
}

/// Orthographic before the narrow and the wide perspectives, in one view at some distances.
bool is_ordered(std::span<const BillboardErrors> of_view, double first, double last) {
  for (std::size_t i = distance_at(first); i <= distance_at(last); ++i) {
    for (std::size_t b = 1; b < of_view.size(); ++b) {
      if (of_view[b].average[i] <= of_view[b - 1].average[i]) return false;
    }
  }
  return true;
}

std::span<const BillboardErrors> of_view(const std::vector<BillboardErrors>& all,
                                         std::size_t view) {
  return std::span(all).subspan(view * kBakes, kBakes);
}

std::vector<std::string> rule(const std::string& text, const std::string& found, bool holds) {
  return {text, found, verdict(holds)};
}

std::vector<std::string> rule_of_least(const BillboardStudy& study) {
  std::string found;
  bool holds = true;
  for (std::size_t view = 0; view < kViewFields_deg.size(); ++view) {
    const double at = least_at(of_view(study.hard, view)[0]);
    found += fmt::format("{}{:g}", found.empty() ? "" : ", ", at);
    holds = holds && (at == 4 || at == 8);
  }
  return rule("hard outlines, orthographic: least average at distance 4 or 8 (views of 40, 60, 90)",
              found, holds);
}

std::vector<std::string> rule_of_size(const BillboardStudy& study) {
  const double ratio = fit_law(mean_of(study.hard_twice, 1)).best_distance() /
                       fit_law(mean_of(study.hard, kBakes)).best_distance();
  return rule("images twice as large: the law's least moves by 1.41 +- .15",
              fmt::format("{:.2f}", ratio), std::abs(ratio - std::sqrt(2.0)) <= 0.15);
}

std::vector<std::string> rule_of_smooth_outlines(const BillboardStudy& study) {
  int count = 0;
  for (std::size_t view = 0; view < kViewFields_deg.size(); ++view) {
    count += falls(of_view(study.antialiased, view)[0], 1, 16) ? 1 : 0;
  }
  return rule("antialiased, orthographic: the average falls from distance 1 to 16",
              fmt::format("{} of 3 views", count), count == 3);
}

std::vector<std::string> rule_of_order(const BillboardStudy& study) {
  int count = 0;
  for (std::size_t view = 0; view < kViewFields_deg.size(); ++view) {
    // In the widest view the narrowest perspective frame ties at 4: its camera is half as far.
    const double first = kViewFields_deg[view] < 90 ? 4 : 8;
    count += is_ordered(of_view(study.hard, view), first, 16) ? 1 : 0;
  }
  return rule("distances 4 (view of 90: 8) to 16: orthographic < 40 < 60 < 90",
              fmt::format("{} of 3 views", count), count == 3);
}

std::vector<std::string> rule_of_totals(const BillboardStudy& study) {
  int count = 0;
  for (std::size_t view = 0; view < kViewFields_deg.size(); ++view) {
    count +=
        std::ranges::is_sorted(of_view(study.hard, view)[0].total, std::ranges::greater()) ? 1 : 0;
  }
  return rule("orthographic: totals fall at every doubling", fmt::format("{} of 3 views", count),
              count == 3);
}

/// The error at the distance from which a frame was baked, beside the paper's.
std::vector<std::string> rule_of_bake_distance(const BillboardStudy& study) {
  std::string found;
  bool holds = true;
  for (std::size_t view = 0; view < kViewFields_deg.size(); ++view) {
    const std::size_t bake = bake_at(kViewFields_deg[view]);
    const auto at = distance_at(1);
    const double own = of_view(study.hard, view)[bake].average[at];
    const double orthographic = of_view(study.hard, view)[0].average[at];
    found += fmt::format("{}{} < {} (paper {})", found.empty() ? "" : ", ", error_text(own),
                         error_text(orthographic), kPaperAverages[view][at][bake]);
    holds = holds && own < orthographic;
  }
  return rule("distance 1, same field of view: the perspective frame beats the orthographic one",
              found, holds);
}

}  // namespace

BillboardStudy run_billboard_study(const core::Mesh& mesh, int side_px, int threads,
                                   const Progress& progress) {
  const std::vector<double> views(kViewFields_deg.begin(), kViewFields_deg.end());
  const std::vector<double> bakes(kBakeFields_deg.begin(), kBakeFields_deg.end());
  BillboardStudy study;
  study.side_px = side_px;
  study.hard = billboard_errors(mesh, {side_px, 1}, views, bakes, threads, progress);
  study.hard_twice = billboard_errors(mesh, {2 * side_px, 1}, views, {0.0}, threads, progress);
  study.antialiased =
      billboard_errors(mesh, {side_px, kAntialiasedSamples}, views, bakes, threads, progress);
  return study;
}

std::vector<Table> average_tables(const BillboardStudy& study) {
  std::vector<Table> tables;
  for (std::size_t view = 0; view < kViewFields_deg.size(); ++view) {
    Table table{fmt::format("Average error in a view of {:.0f} degrees, {} pixels: hard outlines, "
                            "antialiased, the paper's",
                            kViewFields_deg[view], study.side_px),
                {"distance"},
                {}};
    for (const double bake : kBakeFields_deg) {
      table.columns.insert(table.columns.end(), {bake_name(bake), "antialiased", "paper"});
    }
    for (std::size_t d = 0; d < kDistances.size(); ++d) {
      std::vector<std::string> row{fmt::format("{:g}", kDistances[d])};
      for (std::size_t b = 0; b < kBakes; ++b) {
        row.insert(row.end(), {error_text(of_view(study.hard, view)[b].average[d]),
                               error_text(of_view(study.antialiased, view)[b].average[d]),
                               error_text(kPaperAverages[view][d][b])});
      }
      table.rows.push_back(std::move(row));
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

Table all_figures(const BillboardStudy& study) {
  Table table{"Billboards",
              {"pixels", "view_fov", "bake_fov", "outlines", "distance", "total", "average",
               "paper_total", "paper_average"},
              {}};
  const auto add = [&](const BillboardErrors& errors, int side_px, const char* outlines) {
    const auto view = static_cast<std::size_t>(
        std::ranges::find(kViewFields_deg, errors.view_field_deg) - kViewFields_deg.begin());
    const std::size_t bake = bake_at(errors.bake_field_deg);
    for (std::size_t d = 0; d < kDistances.size(); ++d) {
      table.rows.push_back({std::to_string(side_px), fmt::format("{:g}", errors.view_field_deg),
                            fmt::format("{:g}", errors.bake_field_deg), outlines,
                            fmt::format("{:g}", kDistances[d]), decimals(errors.total[d], 0),
                            decimals(errors.average[d], 2),
                            fmt::format("{:g}", kPaperTotals[view][d][bake]),
                            fmt::format("{:g}", kPaperAverages[view][d][bake])});
    }
  };
  for (const auto& errors : study.hard) add(errors, study.side_px, "hard");
  for (const auto& errors : study.antialiased) add(errors, study.side_px, "antialiased");
  for (const auto& errors : study.hard_twice) add(errors, 2 * study.side_px, "hard");
  return table;
}

Table law_table(const BillboardStudy& study) {
  Table table{
      "Averages of orthographic frames at distance d follow A / d + C + B d (hard outlines)",
      {"view, pixels", "A parallax", "C constant", "B outline", "least at"},
      {}};
  const auto add = [&](const BillboardErrors& errors, const std::string& view, int side_px) {
    const ErrorLaw law = fit_law(errors);
    table.rows.push_back({fmt::format("{}, {}", view, side_px), decimals(law.parallax, 1),
                          decimals(law.constant, 1), decimals(law.outline, 2),
                          decimals(law.best_distance(), 1)});
  };
  for (std::size_t view = 0; view < kViewFields_deg.size(); ++view) {
    const std::string name = fmt::format("{:.0f} deg", kViewFields_deg[view]);
    add(of_view(study.hard, view)[0], name, study.side_px);
    add(study.hard_twice[view], name, 2 * study.side_px);
  }
  add(mean_of(study.hard, kBakes), "mean", study.side_px);
  add(mean_of(study.hard_twice, 1), "mean", 2 * study.side_px);
  return table;
}

Table rule_table(const BillboardStudy& study) {
  return {"What a correct implementation shows",
          {"rule", "found", "holds"},
          {rule_of_least(study), rule_of_size(study), rule_of_smooth_outlines(study),
           rule_of_order(study), rule_of_totals(study), rule_of_bake_distance(study)}};
}

}  // namespace sheen::evaluation
