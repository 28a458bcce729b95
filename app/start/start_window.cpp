// SPDX-License-Identifier: MIT
#include "app/start/start_window.h"

#include "app/preview/commands.h"
#include "app/preview/panel_words.h"
#include "app/preview/snapshot.h"
#include "app/preview/theme.h"
#include "app/preview/window_layout.h"
#include "app/start/card.h"
#include "app/start/desktop_folders.h"
#include "app/start/sheet_picture.h"
#include "core/diagnostics/error.h"

#include <imgui.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>

namespace sheen::app {
namespace {

namespace fs = std::filesystem;

// In units of the content scale.
constexpr float kEdge = 36;
constexpr float kBetween = 18;
constexpr float kHead = 92;
constexpr float kFoot = 84;
constexpr float kSideStep = 0.26f;  // of the width; the capture takes what is left

constexpr double kTyping_s = 0.015;  // longest wait for an event

const ImVec4 kAction{0.22f, 0.37f, 0.44f, 1};
const ImVec4 kActionLit{0.25f, 0.43f, 0.51f, 1};

template <std::size_t kSize>
void set_text(std::array<char, kSize>& text, const std::string& words) {
  text.fill('\0');
  std::memcpy(text.data(), words.data(), std::min(words.size(), kSize - 1));
}

/// The largest size of this aspect within a rectangle.
ImVec2 fitted(float aspect, const ImVec2& room) {
  return {std::min(room.x, room.y * aspect), std::min(room.y, room.x / aspect)};
}

/// As ImGui names textures.
ImTextureID name_of(const render::ImageTexture& texture) {
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture.name()));
}

std::string failure_text(const RunningCommand& command, int exit_code) {
  const std::string words = command.last_words();
  return words.empty() ? "ended with exit code " + std::to_string(exit_code) : words;
}

}  // namespace

StartWindow::StartWindow(CameraAccess cameras, fs::path snapshot_folder)
    : cameras_(std::move(cameras)),
      snapshot_folder_(std::move(snapshot_folder)),
      window_("Sheen", layout::kWidth, layout::kHeight),
      looks_(std::make_unique<CameraLooks>(cameras_, Window::wake)),
      recent_(recent_files()) {
  choice_.sheet_folder = downloads_folder();
  set_text(name_, choice_.name);
}

bool StartWindow::redraw(double longest_wait_s) {
  // ImGui takes in a key a redraw: whoever types waits for none.
  const bool is_typing = ImGui::GetIO().WantTextInput;
  window_.begin_redraw(is_typing ? std::min(kTyping_s, longest_wait_s) : longest_wait_s);
  for (const KeyPress& press : window_.key_presses()) obey(press);
  for (const fs::path& path : window_.dropped()) open(path);
  follow_command();
  if (looks_) seen_ = looks_->looks();
  lay_out();
  window_.draw();
  if (std::exchange(snapshot_wanted_, false)) save_snapshot(window_.image(), snapshot_folder_);
  window_.show();
  return !window_.wants_to_close();
}

void StartWindow::obey(const KeyPress& press) {
  const auto command = command_of(press);
  if (!command) return;
  if (*command == ViewCommand::snapshot) snapshot_wanted_ = true;
  if (*command == ViewCommand::quit && !ImGui::GetIO().WantTextInput) window_.close();
}

void StartWindow::follow_command() {
  if (!command_) return;
  const auto exit_code = command_->exit_code();
  if (!exit_code) {
    progress_ = command_->last_words();
    return;
  }
  has_failed_ = *exit_code != 0;
  const Arguments arguments = command_->arguments();
  outcome_ = has_failed_ ? failure_text(*command_, *exit_code) : "";
  command_.reset();
  looks_ = std::make_unique<CameraLooks>(cameras_, Window::wake);
  if (has_failed_) return;
  if (arguments.front() == "board") {
    const fs::path sheet = sheet_file(choice_);
    outcome_ = show_on_desktop(sheet)
                   ? "Print " + sheet.filename().string() + " at 100 %, glue it on something flat"
                   : "Open " + sheet.string() + " and print it at 100 %";
    return;
  }
  const fs::path model = model_of(arguments);
  note_recent_file(model);
  recent_ = recent_files();
  if (arguments.front() == "view") return;
  made_ = model;
  outcome_ = model.filename().string() + " is made";
}

void StartWindow::run(const Arguments& arguments) {
  if (command_) return;
  looks_.reset();  // a capture needs the camera
  made_.clear();
  outcome_.clear();
  progress_.clear();
  try {
    command_ = std::make_unique<RunningCommand>(arguments);
  } catch (const core::Error& error) {
    outcome_ = error.what();
    has_failed_ = true;
    looks_ = std::make_unique<CameraLooks>(cameras_, Window::wake);
  }
}

void StartWindow::open(const fs::path& path) {
  if (const auto arguments = open_arguments(path)) return run(*arguments);
  has_failed_ = true;
  outcome_ =
      path.string() + ": is no model, session, film or folder of pictures; drop one of these here";
}

void StartWindow::lay_out() {
  const float scale = window_.content_scale();
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float edge = kEdge * scale;
  const float between = kBetween * scale;

  // Head.
  ImGui::SetNextWindowPos({edge, 0.6f * edge});
  ImGui::SetNextWindowSize({display.x - 2 * edge, kHead * scale});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{0, 0});
  ImGui::Begin("head", nullptr,
               layout::kFixed | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoInputs);
  ImGui::PopStyleVar();
  ImGui::PushFont(window_.fonts().large);
  text(theme::kText, "Sheen");
  ImGui::PopFont();
  text(theme::kQuiet, "From an object on a printed sheet to its light field");
  ImGui::End();

  // Three steps.
  const float top = kHead * scale;
  const float height = display.y - top - kFoot * scale;
  const float room = display.x - 2 * edge - 2 * between;
  const float side = kSideStep * room;
  const float middle = room - 2 * side;
  begin_card("sheet", {edge, top}, {side, height}, scale);
  show_sheet_step();
  ImGui::End();
  begin_card("capture", {edge + side + between, top}, {middle, height}, scale);
  show_capture_step();
  ImGui::End();
  begin_card("open", {edge + side + middle + 2 * between, top}, {side, height}, scale);
  show_open_step();
  ImGui::End();

  // Foot.
  ImGui::SetNextWindowPos({edge, display.y - kFoot * scale});
  ImGui::SetNextWindowSize({display.x - 2 * edge, kFoot * scale});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{0, between});
  ImGui::Begin("foot", nullptr, layout::kFixed | ImGuiWindowFlags_NoBackground);
  ImGui::PopStyleVar();
  show_foot();
  ImGui::End();
}

void StartWindow::show_sheet_step() {
  step_title("1", "Print the sheet", window_.fonts());
  wrapped(theme::kQuiet,
          "The object stands in its free middle; the tags tell where the camera is.");
  gap(0.4f);
  constexpr std::array papers{std::pair{"A4", "a4"}, std::pair{"Letter", "letter"}};
  for (const auto& [label, paper] : papers) {
    if (ImGui::RadioButton(label, choice_.paper == paper)) choice_.paper = paper;
    ImGui::SameLine();
  }
  ImGui::NewLine();
  gap(0.4f);
  const Arguments arguments = board_arguments(choice_);
  const CardFoot foot = card_foot(arguments, 0);
  const auto [sheet, is_new] = sheets_.try_emplace(choice_.paper);
  if (is_new) sheet->second = draw_sheet(choice_.paper);
  const ShownPicture& shown = sent(choice_.paper, sheet->second);
  const float width = ImGui::GetContentRegionAvail().x;
  const ImVec2 size = fitted(shown.aspect, {width, room_above(foot.command)});
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 0.5f * (width - size.x));
  ImGui::Image(name_of(*shown.texture), size);
  show_command(arguments, foot.command);
  if (step_button("Make the PDF and open it", true)) run(arguments);
}

void StartWindow::show_capture_step() {
  step_title("2", "Walk round the object", window_.fonts());
  wrapped(theme::kQuiet,
          "Once at knee, once at shoulder height, slowly. Camera, shape and light field are found "
          "from the recording.");
  choice_.name = name_.data();
  const auto arguments = capture_arguments(choice_);
  const Arguments shown = arguments.value_or(Arguments{"capture", "CAMERA", "-o", "object.glb"});
  const CardFoot foot = card_foot(shown, 2);
  gap(0.4f);
  show_cameras(room_above(foot.fields));
  ImGui::SetCursorPosY(foot.fields);

  const float width = ImGui::GetContentRegionAvail().x;
  const float look_width = ImGui::CalcTextSize("Look").x + 2 * ImGui::GetStyle().FramePadding.x;
  ImGui::SetNextItemWidth(width - look_width - ImGui::GetStyle().ItemSpacing.x);
  const bool is_entered = ImGui::InputTextWithHint(
      "##address", "A phone's or network camera's address: http://\u2026 or rtsp://\u2026",
      address_.data(), address_.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::SameLine();
  const bool is_asked = ImGui::Button("Look") || is_entered;
  if (is_asked && address_.front() != '\0' && looks_) {
    choice_.camera = address_.data();
    looks_->add(choice_.camera);
  }
  ImGui::AlignTextToFramePadding();
  text(theme::kQuiet, "Name");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
  ImGui::InputText("##name", name_.data(), name_.size());
  show_command(shown, foot.command);
  if (step_button("Capture", arguments.has_value())) run(*arguments);
}

void StartWindow::show_cameras(float height) {
  if (seen_.empty()) {
    const bool is_listing = looks_ && looks_->is_listing();
    wrapped(theme::kQuiet, is_listing ? "Looking for cameras\u2026"
                                      : "No camera at this machine: plug one in and look again, or "
                                        "give a phone's address below.");
    if (!is_listing && looks_ && ImGui::Button("Look again")) {
      looks_ = std::make_unique<CameraLooks>(cameras_, Window::wake);
    }
    return;
  }
  if (choice_.camera.empty()) {
    const auto usable = std::ranges::find_if(
        seen_, [](const CameraLook& look) { return look.fault.empty() && !look.is_due; });
    if (usable != seen_.end()) choice_.camera = usable->address;
  }
  ImGui::BeginChild("cameras", {0, height});
  const float spacing = ImGui::GetStyle().ItemSpacing.x;
  const std::size_t columns = seen_.size() == 1 ? 1 : 2;
  const float width =
      (ImGui::GetContentRegionAvail().x - spacing * static_cast<float>(columns - 1)) /
      static_cast<float>(columns);
  const float tile = std::min(height, 0.75f * width);
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    if (i % columns != 0) ImGui::SameLine();
    show_camera(seen_[i], {width, tile});
  }
  ImGui::EndChild();
}

void StartWindow::show_camera(const CameraLook& look, const ImVec2& size) {
  const float em = ImGui::GetFontSize();
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const ImVec2 to(from.x + size.x, from.y + size.y);
  const float label = 2.9f * em;
  if (ImGui::InvisibleButton(look.address.c_str(), size) && look.fault.empty()) {
    choice_.camera = look.address;
  }
  const bool is_chosen = choice_.camera == look.address;
  const bool is_lit = ImGui::IsItemHovered();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float rounding = 0.4f * em;
  list.AddRectFilled(from, to, ImGui::GetColorU32(theme::kBackground), rounding);
  list.PushClipRect(from, to, true);
  const ImVec2 room(size.x, size.y - label);
  if (!look.picture.empty()) {
    const ShownPicture& shown = sent(look.address, look.picture);
    const ImVec2 fit = fitted(shown.aspect, room);
    const ImVec2 at(from.x + 0.5f * (room.x - fit.x), from.y + 0.5f * (room.y - fit.y));
    list.AddImage(name_of(*shown.texture), at, {at.x + fit.x, at.y + fit.y});
  } else {
    const std::string words = look.is_due ? "Looking\u2026" : look.fault;
    const std::string shown =
        words.empty() ? "sends video; its picture is seen when it records" : words;
    list.AddText(ImGui::GetFont(), em, {from.x + em, from.y + em},
                 ImGui::GetColorU32(look.fault.empty() ? theme::kQuiet : theme::kAlarm),
                 shown.c_str(), nullptr, size.x - 2 * em);
  }
  const std::string name = look.name.empty() ? look.address : look.name;
  list.AddRectFilled({from.x, to.y - label}, to, ImGui::GetColorU32(theme::kRaised));
  list.AddText({from.x + 0.7f * em, to.y - label + 0.3f * em}, ImGui::GetColorU32(theme::kText),
               fitted(name, size.x - 1.4f * em).c_str());
  const std::string shown_address = name == look.address ? "" : look.address + "  ";
  const std::string detail = shown_address + look.mode;
  list.AddText({from.x + 0.7f * em, to.y - 1.35f * em}, ImGui::GetColorU32(theme::kQuiet),
               fitted(detail, size.x - 1.4f * em).c_str());
  list.PopClipRect();
  if (is_chosen || is_lit) {
    list.AddRect(from, to, ImGui::GetColorU32(is_chosen ? theme::kAccent : theme::kQuiet), rounding,
                 0, 0.13f * em);
  }
}

void StartWindow::show_open_step() {
  step_title("3", "Look at it", window_.fonts());
  wrapped(theme::kQuiet,
          "A model, a session, a film or a folder of pictures: drop it on this window, or choose.");
  gap(0.4f);
  const Arguments made =
      made_.empty() ? Arguments{"view", "object.glb"} : Arguments{"view", made_.string()};
  const auto typed = open_arguments(path_.data());
  const Arguments shown = typed.value_or(made);
  const CardFoot foot = card_foot(shown, 1);
  ImGui::BeginChild("recent", {0, room_above(foot.fields)});
  if (recent_.empty()) text(theme::kQuiet, "Nothing opened yet");
  const float width = ImGui::GetContentRegionAvail().x;
  const std::vector<fs::path> offered = recent_;  // opening one changes the list
  for (const fs::path& path : offered) {
    ImGui::PushID(path.c_str());
    const ImVec2 from = ImGui::GetCursorPos();
    if (ImGui::Selectable("##file", false, 0,
                          {width, 2.2f * ImGui::GetTextLineHeightWithSpacing()}))
      open(path);
    ImGui::SetCursorPos({from.x + 0.3f * ImGui::GetFontSize(), from.y + 2});
    text(theme::kText, fitted(path.filename().string(), width));
    ImGui::SetCursorPosX(from.x + 0.3f * ImGui::GetFontSize());
    text(theme::kQuiet, fitted(shown_path(path.parent_path()), width));
    ImGui::PopID();
  }
  ImGui::EndChild();
  ImGui::SetCursorPosY(foot.fields);
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
  const bool is_entered =
      ImGui::InputTextWithHint("##path", "A file or a folder", path_.data(), path_.size(),
                               ImGuiInputTextFlags_EnterReturnsTrue);
  show_command(shown, foot.command);
  const bool is_possible = typed || !made_.empty();
  if (step_button("Open", is_possible)) run(shown);
  if (is_entered && !typed) open(path_.data());
  if (is_entered && typed) run(*typed);
}

void StartWindow::show_foot() {
  if (command_) {
    const bool is_capture = command_->arguments().front() == "capture";
    text(theme::kAccent, "Running");
    ImGui::SameLine();
    text(theme::kText, fitted(as_typed("sheen", command_->arguments()),
                              ImGui::GetContentRegionAvail().x - 9 * ImGui::GetFontSize()));
    const char* const label = is_capture ? "Stop recording" : "Stop";
    ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(label).x -
                    2 * ImGui::GetStyle().FramePadding.x);
    if (ImGui::Button(label)) command_->interrupt();
    text(theme::kQuiet, fitted(progress_, ImGui::GetContentRegionAvail().x));
  } else if (!outcome_.empty()) {
    wrapped(has_failed_ ? theme::kAlarm : theme::kGood, outcome_);
  } else {
    text(theme::kQuiet, "Every step is a command, too; sheen --help names all of them.");
  }
}

void StartWindow::show_command(const Arguments& arguments, float y) {
  ImGui::SetCursorPosY(y);
  wrapped(theme::kAccent, as_typed("sheen", arguments));
}

bool StartWindow::step_button(const char* label, bool is_possible) {
  ImGui::BeginDisabled(command_ != nullptr || !is_possible);
  ImGui::PushStyleColor(ImGuiCol_Button, kAction);
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, kActionLit);
  ImGui::SetCursorPosY(ImGui::GetWindowHeight() - ImGui::GetStyle().WindowPadding.y -
                       ImGui::GetFrameHeight());
  const bool is_clicked = ImGui::Button(label, {ImGui::GetContentRegionAvail().x, 0});
  ImGui::PopStyleColor(2);
  ImGui::EndDisabled();
  return is_clicked;
}

/// The picture as it was sent; sends it where it is another one than before.
const StartWindow::ShownPicture& StartWindow::sent(const std::string& key, const cv::Mat& image) {
  ShownPicture& shown = pictures_[key];
  if (std::exchange(shown.pixels, image.data) == image.data) return shown;
  shown.texture = std::make_unique<render::ImageTexture>(window_.gl());
  shown.texture->upload(image);
  shown.aspect = static_cast<float>(image.cols) / static_cast<float>(image.rows);
  return shown;
}

}  // namespace sheen::app
