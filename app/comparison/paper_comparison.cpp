// SPDX-License-Identifier: MIT
#include "app/comparison/paper_comparison.h"

#include "app/interrupt.h"
#include "bench/paper/paper_experiments.h"

#include <utility>

namespace sheen::app {

void compare_with_paper(const std::filesystem::path& folder, const CommandContext& context) {
  const bench::PaperTables tables = bench::run_paper_experiments({}, [&](const std::string& part) {
    throw_if_interrupted();
    context.note(part);
  });
  std::string text;
  nlohmann::ordered_json written = nlohmann::ordered_json::array();
  for (const auto& [name, table] : {std::pair{"paper_layouts.csv", &tables.layouts},
                                    std::pair{"paper_incremental.csv", &tables.incremental},
                                    std::pair{"paper_fits.csv", &tables.fits},
                                    std::pair{"paper_centers.csv", &tables.centers}}) {
    bench::write_csv(folder / name, *table);
    text += bench::markdown(*table) + "\n";
    written.push_back((folder / name).string());
  }
  context.publish({{"written", written}}, text + "written  " + folder.string() + "/paper_*.csv\n");
}

}  // namespace sheen::app
