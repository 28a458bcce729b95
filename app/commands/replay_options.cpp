// SPDX-License-Identifier: MIT
#include "app/commands/replay_options.h"

#include "fitting/registry.h"

#include <algorithm>
#include <map>
#include <vector>

namespace sheen::app {
namespace {

namespace iwls = fitting::iwls;

const std::string kSparse = "sparse";
const std::map<std::string, iwls::Construction> kConstructions{
    {"quadtree", iwls::Construction::quadtree},
    {"adaptive", iwls::Construction::adaptive},
    {"batch", iwls::Construction::batch}};
const std::map<std::string, iwls::Layout> kLayouts{{"grid", iwls::Layout::grid},
                                                   {"jittered-grid", iwls::Layout::jittered_grid},
                                                   {"disk", iwls::Layout::disk},
                                                   {"jittered-disk", iwls::Layout::jittered_disk}};
const std::map<std::string, int> kTerms{{"1", 1}, {"3", 3}, {"6", 6}, {"auto", 0}};
const std::map<std::string, VisibilityMethod> kVisibilities{{"auto", VisibilityMethod::automatic},
                                                            {"raster", VisibilityMethod::raster},
                                                            {"rays", VisibilityMethod::rays},
                                                            {"depth", VisibilityMethod::depth}};

template <typename Value>
std::string name_in(const std::map<std::string, Value>& names, Value value) {
  for (const auto& [name, candidate] : names) {
    if (candidate == value) return name;
  }
  return {};
}

/// An option that takes one of a few words; the words and the default end up in the help.
template <typename Value>
CLI::Option* add_choice(CLI::App& command, const std::string& flag, Value& value,
                        const std::map<std::string, Value>& names, const std::string& text) {
  std::string words;
  for (const auto& [name, unused] : names) words += (words.empty() ? "" : "|") + name;
  return command.add_option(flag, value, text + " (default " + name_in(names, value) + ")")
      ->transform(CLI::CheckedTransformer(names, CLI::ignore_case).description(""))
      ->type_name(words);
}

/// The sparse fitter needs no settings; whoever sets centres means one of the paper's
/// constructions.
void add_fitter_options(CLI::App& command, ReplayOptions& options) {
  const CLI::Option* fitter =
      command
          .add_option(
              "--fitter", options.fitter,
              "How patches are fitted: sparse (default) gives each as many terms as it needs; "
              "quadtree, adaptive and batch are the paper's constructions")
          ->check(CLI::IsMember({"sparse", "quadtree", "adaptive", "batch"}).description(""))
          ->type_name("sparse|quadtree|adaptive|batch");
  command
      .add_option("--tolerance", options.sparse.tolerance,
                  "With sparse: error that nobody minds, of 1; more is smaller (default: twice the "
                  "camera's noise, estimated from the samples)")
      ->check(CLI::Range(0.0005, 0.5));
  const std::vector<const CLI::Option*> of_centres{
      add_choice(command, "--layout", options.iwls.layout, kLayouts,
                 "With centres: where they lie on the disc of directions"),
      command.add_option("--centers", options.iwls.centers, "With centres: how many per patch")
          ->check(CLI::IsMember({16, 64}))
          ->capture_default_str(),
      add_choice(command, "--terms", options.iwls.terms, kTerms,
                 "With centres: polynomial terms of each"),
      command.add_flag("--faithful", options.iwls.faithful,
                       "Exactly the paper's rules: centres of 3 terms, no ridge")};
  command.parse_complete_callback([&options, fitter, of_centres] {
    const bool centres_are_meant =
        std::any_of(of_centres.begin(), of_centres.end(),
                    [](const CLI::Option* option) { return option->count() > 0; });
    if (fitter->count() == 0 && centres_are_meant) options.fitter = "quadtree";
    if (options.fitter == kSparse && centres_are_meant) {
      throw CLI::ValidationError(
          "--fitter sparse has no centres: leave out --layout, --centers, "
          "--terms and --faithful");
    }
    if (options.fitter != kSparse) options.iwls.construction = kConstructions.at(options.fitter);
  });
}

}  // namespace

std::string ReplayOptions::registered_name() const {
  return representation == "iwls" && fitter == kSparse ? kSparse : representation;
}

void add_model_options(CLI::App& command, ReplayOptions& options) {
  options.representation = "iwls";
  command.add_option("--representation", options.representation, "How patches are modelled")
      ->check(CLI::IsMember(fitting::representation_names()))
      ->capture_default_str();
  add_fitter_options(command, options);
  add_choice(command, "--visibility", options.visibility, kVisibilities,
             "How hidden vertices are found");
  command
      .add_option("--min-cosine", options.limits.min_cosine,
                  "Refuse samples seen at a smaller cosine to the normal")
      ->check(CLI::Range(0.0, 0.99))
      ->capture_default_str();
  command.add_flag("--refine-poses,!--no-refine-poses", options.photometric.refine_poses,
                   "Refine every pose photometrically against the model that is being built");
  command
      .add_option("--pose-error", options.photometric.pose_error_px,
                  "With --refine-poses: error to expect of the given poses, pixels on the object")
      ->check(CLI::Range(0.01, 10.0))
      ->capture_default_str();
  command.add_flag("--exposure,!--no-exposure", options.photometric.exposure,
                   "Estimate every frame's exposure against the model and take it out");
  command.add_flag("--refuse-mismatches", options.refuse_mismatches,
                   "Keep frames out that contradict what earlier ones showed (jump of the "
                   "exposure, wrong pose)");
  command.add_option("--snapshots", options.snapshots, "Folder for snapshots of the window (F12)")
      ->type_name("DIR")
      ->capture_default_str();
}

void add_replay_options(CLI::App& command, ReplayOptions& options) {
  command.add_option("session", options.session.folder, "Session folder")->required();
  command.add_option("-o,--output", options.output, "Model to write (.glb)")
      ->required()
      ->check(CLI::Validator(
          [](const std::string& path) {
            return path.ends_with(".glb") ? std::string() : path + " does not end in .glb";
          },
          ""))
      ->type_name("MODEL.glb");
  add_model_options(command, options);
  command
      .add_option("--patches", options.patches,
                  "vertex: one patch per vertex; texel: as fine as the images resolve")
      ->check(CLI::IsMember({"vertex", "texel"}))
      ->capture_default_str();
  command
      .add_option("--texel-px", options.texel_px,
                  "Largest distance between neighbouring texel patches, pixels")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      .add_option("--hold-out", options.session.hold_out,
                  "Keep every N-th frame out of the fit and report the error on them; 0: none")
      ->check(CLI::NonNegativeNumber)
      ->check(CLI::Validator(
          [](const std::string& every) {
            return every == "1" ? std::string("1 would keep every frame out, use 2 or more")
                                : std::string();
          },
          ""))
      ->capture_default_str();
  add_session_options(command, options.session);
  command.add_flag("--refine-board", options.refine_board,
                   "Refine where the tags lie from the whole recording before posing frames");
  command.add_flag(
      "--preview", options.preview,
      "Watch it in a window, no faster than it was recorded; the program ends when the "
      "window is closed");
  command
      .add_option("--mean-out", options.mean_output,
                  "Also save the mean colours, what a textured mesh would show")
      ->type_name("FILE");
  command.add_option("--poses-out", options.poses_output, "Also save the poses, TUM form")
      ->type_name("FILE");
}

nlohmann::ordered_json to_json(const ReplayOptions& options) {
  return {{"session", options.session.folder.string()},
          {"representation", options.representation},
          {"fitter", options.fitter},
          {"layout", name_in(kLayouts, options.iwls.layout)},
          {"centers", options.iwls.centers},
          {"terms", name_in(kTerms, options.iwls.terms)},
          {"faithful", options.iwls.faithful},
          {"patches", options.patches},
          {"visibility", name_in(kVisibilities, options.visibility)},
          {"hold_out", options.session.hold_out},
          {"start", options.session.start},
          {"min_cosine", options.limits.min_cosine},
          {"refine_poses", options.photometric.refine_poses},
          {"pose_error_px", options.photometric.pose_error_px},
          {"refine_board", options.refine_board},
          {"exposure", options.photometric.exposure},
          {"refuse_mismatches", options.refuse_mismatches},
          {"texel_px", options.texel_px}};
}

}  // namespace sheen::app
