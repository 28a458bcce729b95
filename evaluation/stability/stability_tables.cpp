// SPDX-License-Identifier: MIT
#include "evaluation/stability/stability_tables.h"

#include "evaluation/report/distinct.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace sheen::evaluation {
namespace {

constexpr std::size_t kSamplesShown = 64;

std::vector<std::string> methods_of(std::span<const StabilityRow> rows) {
  return distinct(rows, [](const StabilityRow& row) { return row.method; });
}

std::vector<ViewSet> view_sets_of(std::span<const StabilityRow> rows) {
  return distinct(rows, [](const StabilityRow& row) { return row.views; });
}

const StabilityRow* find(std::span<const StabilityRow> rows, ViewSet views,
                         const std::string& setting, std::size_t samples,
                         const std::string& method) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const StabilityRow& row) {
    return row.views == views && row.samples == samples && row.setting == setting &&
           row.method == method;
  });
  return found == rows.end() ? nullptr : &*found;
}

std::string cell(const StabilityRow* row, double StabilityRow::*value, int count) {
  return row == nullptr ? "-" : decimals(row->*value, count);
}

// Largest relative increase over the best so far, and at how many samples.
struct Increase {
  double part = 0;
  std::size_t samples = 0;
  std::string setting;
};

// Rows of one series come with rising numbers of samples.
Increase worst_increase(std::span<const StabilityRow> rows, ViewSet views,
                        const std::string& setting, const std::string& method) {
  std::optional<double> best;
  Increase worst{-1.0, 0, setting};
  for (const StabilityRow& row : rows) {
    if (row.views != views || row.setting != setting || row.method != method) continue;
    if (best && row.rms / *best - 1.0 > worst.part) {
      worst = {row.rms / *best - 1.0, row.samples, setting};
    }
    best = std::min(best.value_or(row.rms), row.rms);
  }
  return worst;
}

std::string increase_cell(const Increase& increase) {
  return fmt::format("{:+.1f} % @{}", 100.0 * increase.part, increase.samples);
}

}  // namespace

Table all_rows(std::span<const StabilityRow> rows) {
  Table table{"Stability: every row",
              {"views", "setting", "samples", "method", "rms", "rms_glossy", "rms_in_gap",
               "worst95", "numbers"},
              {}};
  for (const StabilityRow& row : rows) {
    table.rows.push_back({std::string(name_of(row.views)), row.setting, std::to_string(row.samples),
                          row.method, decimals(row.rms, 5), decimals(row.rms_glossy, 5),
                          decimals(row.rms_in_gap, 5), decimals(row.worst95, 3),
                          decimals(row.numbers, 1)});
  }
  return table;
}

std::vector<Table> error_against_samples(std::span<const StabilityRow> rows) {
  std::vector<Table> tables;
  for (const ViewSet views : view_sets_of(rows)) {
    Table table{fmt::format("RMS against samples, {}", name_of(views)), {"method"}, {}};
    std::vector<std::size_t> counts;
    for (const StabilityRow& row : rows) {
      if (row.views != views || row.setting != "base") continue;
      if (std::find(counts.begin(), counts.end(), row.samples) == counts.end()) {
        counts.push_back(row.samples);
      }
    }
    for (const std::size_t count : counts) table.columns.push_back(std::to_string(count));
    table.columns.emplace_back("numbers");
    for (const std::string& method : methods_of(rows)) {
      std::vector<std::string> line{method};
      for (const std::size_t count : counts) {
        line.push_back(cell(find(rows, views, "base", count, method), &StabilityRow::rms, 4));
      }
      line.push_back(
          cell(find(rows, views, "base", counts.back(), method), &StabilityRow::numbers, 1));
      table.rows.push_back(std::move(line));
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

Table error_against_settings(std::span<const StabilityRow> rows, ViewSet views) {
  Table table{
      fmt::format("RMS with {} samples, {}", kSamplesShown, name_of(views)), {"method"}, {}};
  std::vector<StabilityRow> of_views;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(of_views),
               [&](const StabilityRow& row) { return row.views == views; });
  const auto settings = distinct(std::span<const StabilityRow>(of_views),
                                 [](const StabilityRow& row) { return row.setting; });
  table.columns.insert(table.columns.end(), settings.begin(), settings.end());
  for (const std::string& method : methods_of(rows)) {
    std::vector<std::string> line{method};
    for (const std::string& setting : settings) {
      line.push_back(
          cell(find(rows, views, setting, kSamplesShown, method), &StabilityRow::rms, 4));
    }
    table.rows.push_back(std::move(line));
  }
  return table;
}

Table extrapolation(std::span<const StabilityRow> rows) {
  Table table{fmt::format("Worst error before clamping with {} samples (95th percentile of points)",
                          kSamplesShown),
              {"method"},
              {}};
  const std::vector<ViewSet> sets = view_sets_of(rows);
  for (const ViewSet views : sets) table.columns.emplace_back(name_of(views));
  table.columns.emplace_back("RMS in gap");
  for (const std::string& method : methods_of(rows)) {
    std::vector<std::string> line{method};
    for (const ViewSet views : sets) {
      line.push_back(
          cell(find(rows, views, "base", kSamplesShown, method), &StabilityRow::worst95, 2));
    }
    line.push_back(cell(find(rows, ViewSet::gap, "base", kSamplesShown, method),
                        &StabilityRow::rms_in_gap, 4));
    table.rows.push_back(std::move(line));
  }
  return table;
}

Table monotonicity(std::span<const StabilityRow> rows) {
  Table table{"Largest increase of the RMS by more samples", {"method"}, {}};
  const std::vector<ViewSet> sets = view_sets_of(rows);
  for (const ViewSet views : sets) table.columns.emplace_back(name_of(views));
  table.columns.emplace_back("any other setting");
  const auto settings = distinct(rows, [](const StabilityRow& row) { return row.setting; });
  for (const std::string& method : methods_of(rows)) {
    std::vector<std::string> line{method};
    Increase other{-1.0, 0, ""};
    for (const ViewSet views : sets) {
      line.push_back(increase_cell(worst_increase(rows, views, "base", method)));
      for (const std::string& setting : settings) {
        const Increase increase = worst_increase(rows, views, setting, method);
        if (setting == "base" || increase.part <= other.part) continue;
        other = increase;
        other.setting = fmt::format("{} {}", name_of(views), setting);
      }
    }
    line.push_back(fmt::format("{} {}", increase_cell(other), other.setting));
    table.rows.push_back(std::move(line));
  }
  return table;
}

Table monotonicity_of(std::span<const StabilityRow> rows, const std::string& method) {
  Table table{fmt::format("Largest increase of the RMS by more samples: {}", method),
              {"views", "setting", "increase"},
              {}};
  const auto settings = distinct(rows, [](const StabilityRow& row) { return row.setting; });
  for (const ViewSet views : view_sets_of(rows)) {
    for (const std::string& setting : settings) {
      const Increase increase = worst_increase(rows, views, setting, method);
      if (increase.samples == 0) continue;
      table.rows.push_back({std::string(name_of(views)), setting, increase_cell(increase)});
    }
  }
  return table;
}

Table stability_targets(std::span<const StabilityRow> rows, const std::string& method) {
  Table table{fmt::format("Targets of {} in the stability suite", method),
              {"target", "wanted", "measured", "verdict"},
              {}};
  const auto on_arc = [&](const std::string& name) {
    return find(rows, ViewSet::arc, "base", kSamplesShown, name);
  };
  const StabilityRow* ours = on_arc(method);
  for (const char* rival : {"sh 3", "sh 3 ridge .01"}) {
    const StabilityRow* harmonics = on_arc(rival);
    if (ours == nullptr || harmonics == nullptr) continue;
    const double better_db = 20.0 * std::log10(harmonics->rms_glossy / ours->rms_glossy);
    table.rows.push_back({fmt::format("glossy patches on arcs, better than {}", rival), "3 dB",
                          fmt::format("{:.2f} dB", better_db), verdict(better_db >= 3.0)});
  }
  // Worst value: over all view sets and settings.
  double ratio = 0;
  std::string where;
  Increase increase{-1.0, 0, ""};
  for (const StabilityRow& row : rows) {
    if (row.method != method) continue;
    const StabilityRow* mean = find(rows, row.views, row.setting, row.samples, "mean");
    const std::string label =
        fmt::format("{} {} @{}", name_of(row.views), row.setting, row.samples);
    if (mean != nullptr && row.worst95 / mean->worst95 > ratio) {
      ratio = row.worst95 / mean->worst95;
      where = label;
    }
    const Increase here = worst_increase(rows, row.views, row.setting, method);
    if (here.part <= increase.part) continue;
    increase = here;
    increase.setting = fmt::format("{} {}", name_of(row.views), row.setting);
  }
  table.rows.push_back({"worst unclamped error over the mean colour's, any row", "1.10",
                        fmt::format("{:.2f} ({})", ratio, where), verdict(ratio <= 1.10)});
  table.rows.push_back({"increase of the RMS by more samples, any row", "+2.0 %",
                        fmt::format("{} {}", increase_cell(increase), increase.setting),
                        verdict(increase.part <= 0.02)});
  return table;
}

}  // namespace sheen::evaluation
