// SPDX-License-Identifier: MIT
#include "app/commands/paper_comparison.h"

#include "app/interrupt.h"
#include "evaluation/paper/paper_experiments.h"

#include <utility>

namespace sheen::app {

void compare_with_paper(const std::filesystem::path& folder, const CommandContext& context) {
  const evaluation::PaperTables tables =
      evaluation::run_paper_experiments({}, [&](const std::string& part) {
        throw_if_interrupted();
        context.note(part);
      });
  std::string text;
  nlohmann::ordered_json written = nlohmann::ordered_json::array();
  for (const auto& [name, table] : {std::pair{"paper_layouts.csv", &tables.layouts},
                                    std::pair{"paper_incremental.csv", &tables.incremental},
                                    std::pair{"paper_fits.csv", &tables.fits},
                                    std::pair{"paper_centers.csv", &tables.centers}}) {
    evaluation::write_csv(folder / name, *table);
    text += evaluation::markdown(*table) + "\n";
    written.push_back((folder / name).string());
  }
  context.publish({{"written", written}}, text + "written  " + folder.string() + "/paper_*.csv\n");
}

}  // namespace sheen::app
