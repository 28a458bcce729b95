// SPDX-License-Identifier: MIT
#include "app/commands/board.h"

#include "capture/board_print/board_pdf.h"

#include <fmt/format.h>

#include <memory>

namespace sheen::app {
namespace {

struct BoardOptions {
  capture::BoardDesign design;
  std::filesystem::path output = "sheen-board.pdf";
  double measured_mm = capture::kRulerMm;
};

std::string describe(const capture::BoardPlan& plan) {
  std::string text = fmt::format(
      "{} tags of {} mm on {} {} of {} paper", plan.board.tags.size(), plan.design.tag_mm,
      plan.sheets.size(), plan.sheets.size() == 1 ? "sheet" : "sheets", plan.design.paper.name);
  if (plan.free_width_mm > 0) {
    text +=
        fmt::format(", free middle {:.0f} x {:.0f} mm", plan.free_width_mm, plan.free_height_mm);
  }
  return text;
}

void run_board(const BoardOptions& options, const CommandContext& context) {
  const capture::BoardPlan plan = capture::plan_board(options.design);
  auto yaml = options.output;
  yaml.replace_extension(".yaml");
  context.check_outputs({options.output, yaml});
  capture::write_board_pdf(options.output, plan);
  capture::write_board(yaml, capture::board_as_printed(plan.board, options.measured_mm));

  const bool is_measured = options.measured_mm != capture::kRulerMm;
  const std::string advice =
      is_measured ? fmt::format("{} holds the sizes of a print whose ruler is {} mm long",
                                yaml.filename().string(), options.measured_mm)
                  : fmt::format(
                        "print at 100 %, measure the ruler; if it is not {} mm long, run "
                        "this again with --measured-mm",
                        capture::kRulerMm);
  context.publish({{"pdf", options.output.string()},
                   {"board", yaml.string()},
                   {"sheets", plan.sheets.size()},
                   {"tags", plan.board.tags.size()},
                   {"first_id", plan.first_id},
                   {"columns", plan.columns},
                   {"rows", plan.rows},
                   {"tag_mm", plan.design.tag_mm},
                   {"pitch_mm", plan.pitch_mm},
                   {"free_mm", {plan.free_width_mm, plan.free_height_mm}},
                   {"ruler_mm", capture::kRulerMm},
                   {"measured_mm", options.measured_mm}},
                  fmt::format("{}\nwritten  {} and {}\n{}\n", describe(plan),
                              options.output.string(), yaml.string(), advice));
}

void add_design_options(Command command, BoardOptions& options) {
  capture::BoardDesign& design = options.design;
  std::vector<std::string> papers;
  for (const capture::Paper& paper : capture::kPapers) papers.emplace_back(paper.name);
  command
      .option(
          "--paper",
          [&design](const std::string& name) {
            for (const capture::Paper& paper : capture::kPapers) {
              if (paper.name == name) design.paper = paper;
            }
          },
          "Paper, upright (default a4)")
      .one_of(papers);
  command.option("--tag-mm", design.tag_mm, "Side of a tag's black square")
      .range(5.0, 250.0)
      .type("MM")
      .show_default();
  command
      .option("--columns", design.columns,
              "Cells across; more than one sheet holds are printed on several, with marks to "
              "cut along (default: one sheet)")
      .range(1, 60)
      .type("N");
  command.option("--rows", design.rows, "Cells down, likewise").range(1, 60).type("N");
  command.flag("--full", design.full_grid,
               "Tags in the middle too, for calibrating; default: the rim only, the middle is "
               "left to the object");
  const std::vector<std::string> families(capture::kPrintableFamilies.begin(),
                                          capture::kPrintableFamilies.end());
  command.option("--family", design.family, "Tag family").one_of(families).show_default();
  command
      .option("--first-id", design.first_id,
              "Id of the tag at the lower left (default: 0; of the sheet that needs no board.yaml "
              "500, on letter 540)")
      .not_negative()
      .type("ID");
}

}  // namespace

void add_board_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<BoardOptions>();
  Command command =
      program.command("board", "Make a printable board of tags (PDF) and its board.yaml");
  command.example(
      "Examples:\n"
      "  sheen board                                     the sheet that needs no board.yaml, A4\n"
      "  sheen board --paper letter                      the same on US letter\n"
      "  sheen board --measured-mm 148.6                 the ruler of my print is 148.6 mm long:\n"
      "                                                  from then on --board sheen-board.yaml\n"
      "  sheen board -o big.pdf --tag-mm 40 --columns 9 --rows 9    several sheets\n"
      "  sheen board -o grid.pdf --full --tag-mm 25      full grid, for sheen calibrate");
  command.option("-o,--output", options->output, "PDF to write; the .yaml comes beside it")
      .show_default()
      .check([](const std::string& text) {
        return std::filesystem::path(text).extension() == ".pdf" ? std::string()
                                                                 : "must end with .pdf";
      })
      .type("FILE.pdf");
  add_design_options(command, *options);
  command
      .option("--measured-mm", options->measured_mm,
              "Length of the printed ruler as you measure it; board.yaml then fits the print")
      .range(75.0, 300.0)
      .type("MM")
      .show_default();
  add_common_options(command, context);
  command.action([options, &context] { run_board(*options, context); });
}

}  // namespace sheen::app
