// SPDX-License-Identifier: MIT
#include "app/commands/evaluate.h"

#include "app/commands/frame_options.h"
#include "app/terminal_sink.h"
#include "capture/plausibility/unit_guess.h"
#include "core/diagnostics/error.h"
#include "core/image/write_image.h"
#include "core/mesh/bounds.h"
#include "evaluation/views/contact_sheet.h"
#include "evaluation/views/evaluate_views.h"
#include "fitting/model_file/model_file.h"
#include "pipeline/light/session_light.h"
#include "pipeline/pose_frames.h"
#include "pipeline/session_mesh.h"
#include "pipeline/session_readout.h"
#include "render/renderer.h"

#include <fmt/format.h>

namespace sheen::app {
namespace {

constexpr int kSheetColumns = 4;

struct EvaluateOptions {
  std::filesystem::path model;
  std::filesystem::path beside;  ///< a second model on the same views; empty: none
  std::filesystem::path session;
  pipeline::FrameChoice frames;
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
                    const std::vector<evaluation::EvaluationSummary>& summaries) {
  std::string text = fmt::format("{:<14}{:>6}{:>11}{:>12}{:>9}{:>9}{:>10}\n", "model", "views",
                                 "PSNR mean", "PSNR median", "SSIM", "RMSE", "covered");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const evaluation::EvaluationSummary& s = summaries[i];
    text += fmt::format("{:<14}{:>6}{:>8.2f} dB{:>9.2f} dB{:>9.4f}{:>9.4f}{:>8.1f} %\n", names[i],
                        s.views.size(), s.mean.psnr_db, s.median.psnr_db, s.mean.ssim, s.mean.rmse,
                        100 * s.covered_fraction);
  }
  return text;
}

/// Refuses a model of another object or in other coordinates than the session's mesh: their boxes
/// must be of about one size and meet.
void check_same_object(const core::Mesh& model, const std::filesystem::path& model_path,
                       const core::Mesh& mesh, const std::filesystem::path& mesh_path) {
  const Eigen::AlignedBox3d model_box = core::file_bounds_of(model);
  const Eigen::AlignedBox3d box = core::file_bounds_of(mesh);
  const double ratio = model_box.diagonal().norm() / box.diagonal().norm();
  if (ratio > 3 || ratio < 1.0 / 3) {
    throw core::bad_input(
        model_path,
        fmt::format("is {} across, {} of the session {}",
                    capture::length_text(model_box.diagonal().norm()),
                    mesh_path.filename().string(), capture::length_text(box.diagonal().norm())),
        "give a session of the same object in the same unit");
  }
  if (!model_box.intersects(box)) {
    throw core::bad_input(
        model_path,
        fmt::format("lies {} from where {} of the session does",
                    capture::length_text((model_box.center() - box.center()).norm()),
                    mesh_path.filename().string()),
        "give a session whose mesh has the same coordinates");
  }
}

std::vector<Eigen::Isometry3d> poses_of(const std::vector<pipeline::PosedFrame>& views) {
  std::vector<Eigen::Isometry3d> poses;
  for (const pipeline::PosedFrame& view : views) poses.push_back(view.camera_from_board);
  return poses;
}

void run_evaluate(const EvaluateOptions& options, const CommandContext& context) {
  // Read the models and pose the views.
  context.check_outputs({options.sheet});
  std::vector<fitting::Model> models;
  models.push_back(fitting::read_model(options.model));
  if (!options.beside.empty()) models.push_back(fitting::read_model(options.beside));
  capture::Session session = capture::open_session(options.session);
  TerminalSink sink(context);
  core::Mesh mesh = pipeline::read_session_mesh(session, sink);
  pipeline::complete_readout(session, options.frames, sink);
  pipeline::complete_light(session, options.frames, sink);
  const auto views = pipeline::pose_frames(session, options.frames, sink);
  pipeline::SessionScene::check(session, mesh, options.frames.pose_source, views, sink);
  pipeline::face_cameras(mesh, session, poses_of(views), sink);

  // Bring everything into the coordinates of the first model.
  for (std::size_t i = 0; i < models.size(); ++i) {
    check_same_object(models[i].mesh, i == 0 ? options.model : options.beside, mesh, session.mesh);
  }
  for (fitting::Model& model : models) core::move_offset(model.mesh, models.front().mesh.offset);
  core::move_offset(mesh, models.front().mesh.offset);
  session.take_offset(mesh.offset);

  // Draw and compare.
  const auto gl = render::make_osmesa_context();
  std::vector<std::string> names;
  std::vector<std::unique_ptr<render::Renderer>> owners;
  std::vector<render::Renderer*> renderers;
  for (const fitting::Model& model : models) {
    names.push_back(name_of(model));
    owners.push_back(render::make_renderer(*gl, model.mesh, *model.light_field, context.threads));
    renderers.push_back(owners.back().get());
  }
  evaluation::ContactSheet sheet(names);
  int done = 0;
  const int count = static_cast<int>(views.size());
  const auto summaries = evaluation::evaluate_views(*gl, {session, mesh, views}, renderers,
                                                    [&](const evaluation::ComparedView& view) {
                                                      if (is_on_sheet(done, count)) sheet.add(view);
                                                      sink.progress({"evaluating", ++done, count});
                                                    });
  if (done == 0) {
    throw core::bad_input(options.session, "shows the model in none of its posed views",
                          "check T_stage_object and that the session belongs to this model");
  }

  // Report.
  if (!options.sheet.empty()) core::write_image(options.sheet, sheet.image());
  nlohmann::ordered_json document = to_json(summaries.front());
  if (summaries.size() > 1) document["beside"] = to_json(summaries[1]);
  context.publish(document, to_text(names, summaries));
}

}  // namespace

void add_evaluate_command(CommandLine& program, CommandContext& context) {
  auto options = std::make_shared<EvaluateOptions>();
  Command command =
      program.command("evaluate", "Draw every posed view of a session and compare with its images");
  command.example(
      "Errors are of 8-bit sRGB over the pixels where the mesh is seen, eroded by two.\n"
      "Example:\n  sheen evaluate model.glb sample_data/glossy/held_out --contact-sheet sheet.png");
  command.option("model", options->model, "Model file (.glb)").required();
  command.option("session", options->session, "Session folder").required();
  command.option("--beside", options->beside, "Evaluate a second model on the same views")
      .type("MODEL.glb");
  command
      .option("--contact-sheet", options->sheet,
              "Image of photographs, renderings and differences side by side")
      .type("FILE.png");
  add_evaluated_frame_options(command, options->frames);
  add_common_options(command, context);
  command.action([options, &context] { run_evaluate(*options, context); });
}

}  // namespace sheen::app
