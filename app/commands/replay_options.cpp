// SPDX-License-Identifier: MIT
#include "app/commands/replay_options.h"

#include "app/commands/frame_options.h"
#include "app/commands/representation_options.h"
#include "core/text/number.h"
#include "fitting/descriptor.h"

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sheen::app {
namespace {

using pipeline::Patches;

const std::vector<std::pair<std::string, VisibilityMethod>> kVisibilities{
    {"auto", VisibilityMethod::automatic},
    {"raster", VisibilityMethod::raster},
    {"rays", VisibilityMethod::rays},
    {"depth", VisibilityMethod::depth}};
const std::vector<std::pair<std::string, std::optional<Patches>>> kPatches{
    {"auto", Patches::automatic},
    {"vertex", Patches::vertex},
    {"texel", Patches::texel},
    {"detail", Patches::detail}};
constexpr const char* kVertexPatches = "sparse";
constexpr const char* kTexture = "detail";

template <typename Value>
std::string word_for(const std::vector<std::pair<std::string, Value>>& words, const Value& value) {
  for (const auto& [word, candidate] : words) {
    if (candidate == value) return word;
  }
  return {};
}

/// Whether one of the options is not of patches at vertices: it asks for the texture.
bool asks_texture(const fitting::OptionValues& values) {
  const auto options = fitting::representation_named(kVertexPatches).default_options();
  const fitting::OptionTable known = options->table();
  return std::ranges::any_of(values, [&](const auto& value) {
    return std::ranges::find(known, value.first, &fitting::FitOption::name) == known.end();
  });
}

/// Representation and patches from what was said of them. A texture and patches at vertices are one
/// representation each, so --patches chooses between them where --representation is not given; and
/// a state holds samples, of which no texture can be made.
void reconcile_patches(const RepresentationChoice& choice, const std::optional<Patches>& wanted,
                       ReplayOptions& options) {
  pipeline::ReconstructionOptions& fit = options.reconstruction;
  const bool is_free = choice.representation == kTexture && !choice.asked_by_name;
  const Patches patches = wanted.value_or(Patches::automatic);
  const bool for_state = patches == Patches::automatic && !options.state_output.empty();
  if (is_free && (for_state || patches == Patches::vertex || patches == Patches::texel)) {
    fit.representation = kVertexPatches;
    static_cast<void>(resolve_representation(fit.representation, fit.fit));
    if (for_state) options.note = "note: a state holds no texture, so this is --patches vertex";
  }
  const bool has_texture = fit.representation == kTexture;
  const bool agree = patches == Patches::automatic || (patches == Patches::detail) == has_texture;
  if (!agree) {
    throw UsageError("--patches " + word_for(kPatches, std::optional(patches)) +
                     " contradicts --representation " + fit.representation);
  }
  fit.patches = patches != Patches::automatic       ? patches
                : !has_texture                      ? Patches::vertex
                : is_free && !asks_texture(fit.fit) ? Patches::automatic
                                                    : Patches::detail;
}

core::PatchShare share_from(const std::string& text) {
  core::PatchShare share;
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, share.number);
  const bool goes_on = number.ec == std::errc() && number.ptr != end && *number.ptr == '/';
  const auto of = goes_on ? std::from_chars(number.ptr + 1, end, share.of) : number;
  if (!goes_on || of.ec != std::errc() || of.ptr != end || share.number < 1 ||
      share.number > share.of) {
    throw UsageError("--part is \"" + core::quotable(text) + "\", write 1/3, 2/3 and 3/3");
  }
  return share;
}

/// A share is of use to be merged, and what looks at the model while it grows needs all of it.
void check_share(const ReplayOptions& options) {
  const pipeline::ReconstructionOptions& fit = options.reconstruction;
  if (fit.share.is_whole()) return;
  if (options.state_output.empty()) {
    throw UsageError("--part needs --state, sheen merge joins the states of all parts");
  }
  if (fit.photometric.refine_poses || fit.photometric.exposure || fit.refuse_mismatches) {
    throw UsageError(
        "--part excludes --refine-poses, --exposure and --refuse-mismatches: they look at the "
        "whole model");
  }
}

using WantedPatches = std::shared_ptr<std::optional<Patches>>;

void add_model_options(Command command, const WantedPatches& patches, ReplayOptions& options) {
  pipeline::ReconstructionOptions& fit = options.reconstruction;
  const auto choice = std::make_shared<RepresentationChoice>();
  add_representation_options(command, *choice);
  command.after_parsing([choice, patches, &options] {
    options.reconstruction.representation = choice->representation;
    options.reconstruction.fit = choice->values;
    reconcile_patches(*choice, *patches, options);
  });
  command.choice("--visibility", options.visibility, kVisibilities,
                 "How hidden vertices are found");
  command
      .option("--min-cosine", fit.limits.min_cosine,
              "Refuse samples seen at a smaller cosine to the normal")
      .range(0, 0.99)
      .show_default();
  command.flag("--refine-poses,!--no-refine-poses", fit.photometric.refine_poses,
               "Refine every pose photometrically against the model that is being built");
  command
      .option("--pose-error", fit.photometric.pose_error_px,
              "With --refine-poses: error to expect of the given poses, pixels on the object")
      .range(0.01, 10)
      .show_default();
  command.flag("--exposure,!--no-exposure", fit.photometric.exposure,
               "Estimate every frame's exposure against the model and take it out");
  command.flag("--refuse-mismatches", fit.refuse_mismatches,
               "Keep frames out that contradict what earlier ones showed (jump of the exposure, "
               "wrong pose)");
  command.option("--snapshots", options.snapshots, "Folder for snapshots of the window (F12)")
      .type("DIR")
      .show_default();
}

}  // namespace

void add_model_options(Command command, ReplayOptions& options) {
  add_model_options(std::move(command), std::make_shared<std::optional<Patches>>(), options);
}

void add_replay_options(Command command, ReplayOptions& options) {
  pipeline::ReconstructionOptions& fit = options.reconstruction;
  command
      .option("session", options.session,
              "Session folder, or a video or folder of pictures of a walk round an object on a "
              "printed board")
      .required();
  command.option("-o,--output", options.output, "Model to write (.glb)")
      .required()
      .check([](const std::string& path) {
        return path.ends_with(".glb") ? std::string() : path + " does not end in .glb";
      })
      .type("MODEL.glb");
  command
      .option("--session-out", options.new_session,
              "For a video or pictures: the session folder to make (default: the model's name "
              "without .glb)")
      .type("DIR");
  add_walk_options(command, options.walk);
  const auto patches = std::make_shared<std::optional<Patches>>();
  command.choice(
      "--patches", *patches, kPatches,
      "vertex: one patch per vertex; texel: the mesh is subdivided to the footprint of a "
      "pixel first; detail: one per vertex and a texture as fine as the images; auto: detail, but "
      "vertex where the vertices lie as densely as pixels, or with --state (default auto)");
  add_model_options(command, patches, options);
  command.option("--texel-px", fit.texel_px, "With --patches texel: longest edge, pixels")
      .positive()
      .show_default();
  command
      .option("--hold-out", fit.frames.hold_out,
              "Keep every N-th frame out of the fit and report the error on them; 0: none")
      .not_negative()
      .check([](const std::string& every) {
        return every == "1" ? std::string("1 would keep every frame out, use 2 or more")
                            : std::string();
      })
      .show_default();
  add_frame_options(command, fit.frames);
  command.flag("--refine-board", fit.refine_board,
               "Refine where the tags lie from the whole recording before posing frames");
  Option refine_mesh = command.switch_on(
      "--refine-mesh", [&fit] { fit.refine_mesh = true; },
      "Put a mesh of another size or beside its place right by the object's outlines, and move its "
      "vertices along their normals to where the pictures of its print agree; kept as it is unless "
      "that shows on views left out of it. Default where a texture is fitted: the place, and "
      "vertices where the mesh is much coarser than the texels");
  command
      .switch_on(
          "--no-refine-mesh", [&fit] { fit.refine_mesh = false; }, "Leave the mesh where it is")
      .excludes(refine_mesh);
  command
      .option("--write-mesh", options.mesh_output,
              "Also save the mesh, refined or not, in the coordinates of the session's (.ply)")
      .check([](const std::string& path) {
        return path.ends_with(".ply") ? std::string() : path + " does not end in .ply";
      })
      .type("FILE.ply");
  command.after_parsing([&options] {
    if (!options.mesh_output.empty() && options.reconstruction.refine_mesh == false) {
      throw UsageError("--write-mesh excludes --no-refine-mesh: the mesh is the session's");
    }
    if (!options.state_output.empty() && options.reconstruction.refine_mesh == true) {
      throw UsageError("--refine-mesh excludes --state: states know the session's mesh");
    }
  });
  Option preview = command.flag(
      "--preview", options.preview,
      "Watch it in a window, no faster than it was recorded; the program ends when the "
      "window is closed");
  command
      .option("--mean-out", options.mean_output,
              "Also save the mean colours, what a textured mesh would show")
      .type("FILE");
  const Option state =
      command
          .option("--state", options.state_output,
                  "Also save every view's samples (24 bytes each), for sheen resume, merge, forget")
          .type("FILE");
  preview.excludes(state);
  command
      .option(
          "--part", [&fit](const std::string& text) { fit.share = share_from(text); },
          "Fit the k-th of n equal shares of the patches alone, 2/3, and leave its samples in "
          "--state; sheen merge of all n states gives the whole model")
      .type("K/N");
  command.after_parsing([&options] { check_share(options); });
  command.option("--poses-out", options.poses_output, "Also save the poses, TUM form").type("FILE");
}

nlohmann::ordered_json to_json(const ReplayOptions& options) {
  const pipeline::ReconstructionOptions& fit = options.reconstruction;
  nlohmann::ordered_json document{{"session", options.session.string()},
                                  {"representation", fit.representation},
                                  {"fitter", fit.representation}};
  const auto settings =
      fitting::options_from(fitting::representation_named(fit.representation), fit.fit);
  for (const fitting::FitOption& option : settings->table()) {
    const std::string text = option.get();
    const auto value = nlohmann::ordered_json::parse(text, nullptr, false);
    document[option.name] = text.empty()           ? nlohmann::ordered_json(nullptr)
                            : value.is_discarded() ? nlohmann::ordered_json(text)
                                                   : value;
  }
  document.update({{"patches", word_for(kPatches, std::optional(fit.patches))},
                   {"visibility", word_for(kVisibilities, options.visibility)},
                   {"hold_out", fit.frames.hold_out},
                   {"start", fit.frames.start},
                   {"min_cosine", fit.limits.min_cosine},
                   {"refine_poses", fit.photometric.refine_poses},
                   {"pose_error_px", fit.photometric.pose_error_px},
                   {"refine_board", fit.refine_board},
                   {"refine_mesh", fit.refine_mesh ? nlohmann::ordered_json(*fit.refine_mesh)
                                                   : nlohmann::ordered_json("auto")},
                   {"exposure", fit.photometric.exposure},
                   {"refuse_mismatches", fit.refuse_mismatches},
                   {"texel_px", fit.texel_px}});
  return document;
}

}  // namespace sheen::app
