// SPDX-License-Identifier: MIT
#include "app/commands/evaluate.h"

#include "app/commands/session_options.h"
#include "app/evaluation/contact_sheet.h"
#include "app/evaluation/evaluate_views.h"
#include "core/diagnostics/error.h"
#include "core/image/write_image.h"
#include "fitting/model_file/model_file.h"
#include "render/surface/surface_renderer.h"

#include <fmt/format.h>

namespace sheen::app {
namespace {

constexpr int kSheetColumns = 4;

struct EvaluateOptions {
  std::filesystem::path model;
  std::filesystem::path beside;  ///< a second model on the same views; empty: none
  SessionOptions session;
  std::filesystem::path sheet;  ///< contact sheet; empty: none
};

/// Every `stride`-th view, so that the sheet spans the whole session.
bool is_on_sheet(int position, int views) {
  const int stride = std::max(1, views / kSheetColumns);
  return position % stride == stride / 2 && position / stride < kSheetColumns;
}

std::string name_of(const fitting::Model& model) {
  return std::string(model.light_field->representation());
}

std::string to_text(const std::vector<std::string>& names,
                    const std::vector<EvaluationSummary>& summaries) {
  std::string text = fmt::format("{:<14}{:>6}{:>11}{:>12}{:>9}{:>9}{:>10}\n", "model", "views",
                                 "PSNR mean", "PSNR median", "SSIM", "RMSE", "covered");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const EvaluationSummary& s = summaries[i];
    text += fmt::format("{:<14}{:>6}{:>8.2f} dB{:>9.2f} dB{:>9.4f}{:>9.4f}{:>8.1f} %\n", names[i],
                        s.views.size(), s.mean.psnr_db, s.median.psnr_db, s.mean.ssim, s.mean.rmse,
                        100 * s.covered_fraction);
  }
  return text;
}

void run_evaluate(const EvaluateOptions& options, const CommandContext& context) {
  // Read the models and pose the views.
  context.check_outputs({options.sheet});
  std::vector<fitting::Model> models;
  models.push_back(fitting::read_model(options.model));
  if (!options.beside.empty()) models.push_back(fitting::read_model(options.beside));
  const capture::Session session = capture::open_session(options.session.folder);
  std::vector<PosedFrame> views;
  {
    Progress progress = context.progress("posing", 0);
    views = pose_frames(session, options.session, [&](int read) { progress.show(read); });
  }

  // Draw and compare.
  const auto gl = render::make_osmesa_context();
  std::vector<std::string> names;
  std::vector<std::unique_ptr<render::SurfaceRenderer>> owners;
  std::vector<render::SurfaceRenderer*> renderers;
  for (const fitting::Model& model : models) {
    names.push_back(name_of(model));
    owners.push_back(render::make_gl_surface_renderer(*gl, model.mesh, *model.light_field));
    renderers.push_back(owners.back().get());
  }
  ContactSheet sheet(names);
  Progress progress = context.progress("evaluating", static_cast<int>(views.size()));
  int done = 0;
  const auto summaries = evaluate_views(session, views, renderers, [&](const ComparedView& view) {
    if (is_on_sheet(done, static_cast<int>(views.size()))) sheet.add(view);
    progress.show(++done);
  });
  if (done == 0) {
    throw core::bad_input(options.session.folder, "shows the model in none of its posed views",
                          "check T_stage_object and that the session belongs to this model");
  }

  // Report.
  if (!options.sheet.empty()) core::write_image(options.sheet, sheet.image());
  nlohmann::ordered_json document = to_json(summaries.front());
  if (summaries.size() > 1) document["beside"] = to_json(summaries[1]);
  context.publish(document, to_text(names, summaries));
}

}  // namespace

void add_evaluate_command(CLI::App& program, CommandContext& context) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* command = program.add_subcommand(
      "evaluate", "Draw every posed view of a session and compare with its images");
  command->footer(
      "Errors are of 8-bit sRGB over the pixels where the mesh is seen, eroded by two.\n"
      "Example:\n  sheen evaluate model.glb sample_data/glossy/held_out --contact-sheet sheet.png");
  command->add_option("model", options->model, "Model file (.glb)")->required();
  command->add_option("session", options->session.folder, "Session folder")->required();
  command->add_option("--beside", options->beside, "Evaluate a second model on the same views")
      ->type_name("MODEL.glb");
  command
      ->add_option("--contact-sheet", options->sheet,
                   "Image of photographs, renderings and differences side by side")
      ->type_name("FILE.png");
  command
      ->add_option("--hold-out", options->session.hold_out,
                   "Only the frames that replay --hold-out N kept out; 0: all")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  add_session_options(*command, options->session);
  add_common_options(*command, context);
  command->callback([options, &context] { run_evaluate(*options, context); });
}

}  // namespace sheen::app
