// SPDX-License-Identifier: MIT
#include "app/commands/billboard_comparison.h"

#include "app/interrupt.h"
#include "capture/synthetic/torus_knot.h"
#include "core/mesh/read_mesh.h"
#include "evaluation/billboards/billboard_charts.h"
#include "evaluation/billboards/billboard_tables.h"
#include "evaluation/report/chart_script.h"

namespace sheen::app {
namespace {

constexpr int kKnotVertices = 30000;

core::Mesh mesh_of(const BillboardComparison& comparison, const CommandContext& context) {
  if (comparison.mesh.empty()) return capture::synthetic::torus_knot(kKnotVertices);
  std::vector<std::string> notes;
  core::Mesh mesh = core::read_mesh(comparison.mesh, &notes);
  for (const std::string& note : notes) context.note("note: " + note);
  return mesh;
}

}  // namespace

void compare_billboards(const BillboardComparison& comparison, const std::filesystem::path& folder,
                        const CommandContext& context) {
  const auto study =
      evaluation::run_billboard_study(mesh_of(comparison, context), comparison.side_px,
                                      context.threads, [&](const std::string& part) {
                                        throw_if_interrupted();
                                        context.note(part);
                                      });
  std::string text;
  for (const auto& table : evaluation::average_tables(study)) {
    text += evaluation::markdown(table) + "\n";
  }
  const auto law = evaluation::law_table(study);
  const auto rules = evaluation::rule_table(study);
  text += evaluation::markdown(law) + "\n" + evaluation::markdown(rules) + "\n";
  const auto csv = folder / "billboards.csv";
  evaluation::write_csv(csv, evaluation::all_figures(study));
  evaluation::write_csv(folder / "billboards_law.csv", law);
  evaluation::write_csv(folder / "billboards_rules.csv", rules);
  const auto note =
      evaluation::draw_charts(std::string(evaluation::billboard_charts("charts.py")), csv, folder);
  if (note) context.note("note: " + *note);
  nlohmann::ordered_json found = nlohmann::ordered_json::array();
  for (const auto& row : rules.rows) {
    found.push_back({{"rule", row[0]}, {"found", row[1]}, {"holds", row[2] == "met"}});
  }
  context.publish({{"rules", found}}, text + "written  " + folder.string() + "/billboards*\n");
}

}  // namespace sheen::app
