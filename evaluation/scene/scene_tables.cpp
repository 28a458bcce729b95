// SPDX-License-Identifier: MIT
#include "evaluation/scene/scene_tables.h"

#include "evaluation/report/distinct.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace sheen::evaluation {
namespace {

constexpr std::size_t kShownSamples = 96;

std::optional<SceneRow> find(std::span<const SceneRow> rows, const std::string& environment,
                             const std::string& setting, std::size_t samples,
                             const std::string& method) {
  for (const SceneRow& row : rows) {
    if (row.environment == environment && row.setting == setting && row.samples == samples &&
        row.method == method) {
      return row;
    }
  }
  return std::nullopt;
}

std::vector<std::string> methods_of(std::span<const SceneRow> rows) {
  return distinct(rows, [](const SceneRow& row) { return row.method; });
}

}  // namespace

Table all_rows(std::span<const SceneRow> rows) {
  Table table{"Scene: every row",
              {"environment", "setting", "samples", "method", "psnr_path", "psnr_scattered",
               "numbers", "lambert_rms", "fit_us"},
              {}};
  for (const MaterialClass material : kSceneMaterials) {
    table.columns.push_back(fmt::format("numbers_{}", name_of(material)));
  }
  for (const SceneRow& row : rows) {
    std::vector<std::string> line{row.environment,
                                  row.setting,
                                  std::to_string(row.samples),
                                  row.method,
                                  decimals(row.psnr_path_db, 3),
                                  decimals(row.psnr_scattered_db, 3),
                                  decimals(row.numbers, 2),
                                  decimals(row.lambert_rms, 5),
                                  decimals(row.fit_us, 3)};
    for (const double numbers : row.numbers_by_material) line.push_back(decimals(numbers, 2));
    table.rows.push_back(std::move(line));
  }
  return table;
}

Table all_rows(std::span<const BusyRow> rows) {
  Table table{"Busy environment: every row",
              {"views", "samples", "method", "rms", "worst95", "numbers"},
              {}};
  for (const BusyRow& row : rows) {
    table.rows.push_back({row.views, std::to_string(row.samples), row.method, decimals(row.rms, 5),
                          decimals(row.worst95, 3), decimals(row.numbers, 1)});
  }
  return table;
}

Table psnr_against_samples(std::span<const SceneRow> rows, const std::string& environment) {
  Table table{fmt::format("Scene, {} environment: PSNR in dB, held-out walk | scattered views",
                          environment),
              {"method"},
              {}};
  const auto counts = distinct(rows, [](const SceneRow& row) { return row.samples; });
  for (const std::size_t count : counts) table.columns.push_back(fmt::format("N = {}", count));
  for (const std::string& method : methods_of(rows)) {
    std::vector<std::string> line{method};
    for (const std::size_t count : counts) {
      const auto row = find(rows, environment, "base", count, method);
      line.push_back(row ? fmt::format("{:.2f}, {:.2f}", row->psnr_path_db, row->psnr_scattered_db)
                         : "-");
    }
    table.rows.push_back(std::move(line));
  }
  return table;
}

Table numbers_by_material(std::span<const SceneRow> rows, const std::string& environment) {
  Table table{fmt::format("Scene, {} environment, {} samples per point: numbers per patch",
                          environment, kShownSamples),
              {"method"},
              {}};
  for (const MaterialClass material : kSceneMaterials) {
    table.columns.emplace_back(name_of(material));
  }
  for (const char* column : {"all", "Lambert RMS", "us per sample", "2 % outliers cost, dB"}) {
    table.columns.emplace_back(column);
  }
  for (const std::string& method : methods_of(rows)) {
    const auto row = find(rows, environment, "base", kShownSamples, method);
    const auto outliers = find(rows, environment, "outliers 2 %", kShownSamples, method);
    if (!row || !outliers) continue;
    std::vector<std::string> line{method};
    for (const double numbers : row->numbers_by_material) line.push_back(decimals(numbers, 1));
    line.push_back(decimals(row->numbers, 1));
    line.push_back(decimals(row->lambert_rms, 4));
    line.push_back(decimals(row->fit_us, 2));
    line.push_back(decimals(row->psnr_path_db - outliers->psnr_path_db, 2));
    table.rows.push_back(std::move(line));
  }
  return table;
}

Table busy_table(std::span<const BusyRow> rows) {
  Table table{"Busy environment, nine materials: RMS (numbers per patch)", {"method"}, {}};
  const auto label = [](const BusyRow& row) {
    return fmt::format("{} {}", row.views, row.samples);
  };
  const auto settings = distinct(rows, label);
  const auto methods = distinct(rows, [](const BusyRow& row) { return row.method; });
  table.columns.insert(table.columns.end(), settings.begin(), settings.end());
  for (const std::string& method : methods) {
    std::vector<std::string> line{method};
    for (const std::string& setting : settings) {
      const auto row = std::find_if(rows.begin(), rows.end(), [&](const BusyRow& candidate) {
        return candidate.method == method && label(candidate) == setting;
      });
      line.push_back(row == rows.end() ? "-"
                                       : fmt::format("{:.4f} ({:.0f})", row->rms, row->numbers));
    }
    table.rows.push_back(std::move(line));
  }
  return table;
}

Table scene_targets(std::span<const SceneRow> rows, const std::string& method) {
  Table table{fmt::format("Targets of {} on the scene ({} samples, studio)", method, kShownSamples),
              {"target", "wanted", "measured", "verdict"},
              {}};
  const auto find_base = [&](const std::string& name) {
    return find(rows, "studio", "base", kShownSamples, name);
  };
  const auto ours = find_base(method);
  const auto outliers = find(rows, "studio", "outliers 2 %", kShownSamples, method);
  if (!ours || !outliers) return table;
  struct Rival {
    const char* name;
    double fewer, better_db;
  };
  for (const Rival& rival : {Rival{"quadtree 16x3 faithful", 0.85, 1.5}, Rival{"sh 3", 0.60, 2.0},
                             Rival{"sh 3 ridge .01", 0.60, 2.0}}) {
    const auto row = find_base(rival.name);
    if (!row) continue;
    const double fewer = 1.0 - ours->numbers / row->numbers;
    const double better_db = ours->psnr_path_db - row->psnr_path_db;
    table.rows.push_back({fmt::format("fewer numbers than {}", rival.name),
                          fmt::format("{:.0f} %", 100 * rival.fewer),
                          fmt::format("{:.1f} %", 100 * fewer), verdict(fewer >= rival.fewer)});
    table.rows.push_back(
        {fmt::format("better PSNR than {}", rival.name), fmt::format("{:.1f} dB", rival.better_db),
         fmt::format("{:.2f} dB", better_db), verdict(better_db >= rival.better_db)});
  }
  const double lambert_numbers = ours->numbers_by_material[0];
  table.rows.push_back({"numbers of a Lambert patch", "3", decimals(lambert_numbers, 2),
                        verdict(lambert_numbers < 3.05)});
  table.rows.push_back({"RMS of Lambert patches", ".0015", decimals(ours->lambert_rms, 4),
                        verdict(ours->lambert_rms <= 0.0015)});
  const double cost_db = ours->psnr_path_db - outliers->psnr_path_db;
  table.rows.push_back({"cost of 2 % outliers", "2.5 dB", fmt::format("{:.2f} dB", cost_db),
                        verdict(cost_db <= 2.5)});
  return table;
}

}  // namespace sheen::evaluation
