// SPDX-License-Identifier: MIT
#include "app/batch/jobs_file.h"

#include "capture/files/text_file.h"
#include "core/diagnostics/error.h"
#include "core/text/number.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <set>
#include <sstream>

namespace sheen::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = std::size_t{16} << 20;  // a hundred thousand sessions
constexpr int kMostParts = 100;
constexpr const char* kRemedy = "see docs/batch.md for what it may say";
constexpr const char* kEverySession = "*";

class JobsReader {
 public:
  explicit JobsReader(const fs::path& path) : path_(path) {}

  Jobs read() const {
    const YAML::Node root = YAML::Load(capture::read_text_file(path_, kMostBytes));
    if (!root.IsMap()) fail("is no list of keys and values");
    check_keys(root, "the file",
               {"sessions", "steps", "hold_out", "wanted", "options", "format", "parts"});
    Jobs jobs;
    if (root["hold_out"]) jobs.hold_out = hold_out(root["hold_out"]);
    if (root["format"]) jobs.format = text(root["format"], "format");
    if (root["wanted"]) jobs.wanted = wanted(root["wanted"]);
    Job common;
    common.steps = default_steps(jobs.hold_out);
    take_settings(root, jobs.hold_out, common);
    const YAML::Node sessions = root["sessions"];
    if (!sessions || !sessions.IsSequence() || sessions.size() == 0) {
      fail("sessions is missing or no list");
    }
    for (const YAML::Node& entry : sessions) add_session(entry, jobs.hold_out, common, jobs);
    check_names(jobs);
    return jobs;
  }

  [[noreturn]] void fail(const std::string& fault) const {
    throw core::bad_input(path_, fault, kRemedy);
  }

 private:
  void check_keys(const YAML::Node& map, const std::string& what,
                  const std::set<std::string>& known) const {
    std::set<std::string> seen;
    for (const auto& member : map) {
      const std::string key = text(member.first, "a key");
      if (!known.contains(key)) fail(what + " has the unknown key \"" + core::quotable(key) + "\"");
      if (!seen.insert(key).second) fail(what + " has the key " + key + " twice");
    }
  }

  std::string text(const YAML::Node& node, const std::string& key) const {
    if (!node.IsScalar() || node.Scalar().empty() ||
        node.Scalar().find('\0') != std::string::npos) {
      fail(key + " is no text");
    }
    return node.Scalar();
  }

  double number(const YAML::Node& node, const std::string& key, double most) const {
    const auto value = core::parse_number(text(node, key));
    if (!value || !(*value >= 0) || !(*value <= most)) {
      fail(key + " is no number from 0 to " + std::to_string(static_cast<int>(most)));
    }
    return *value;
  }

  int hold_out(const YAML::Node& node) const {
    const auto value = core::parse_whole_number(text(node, "hold_out"));
    if (!value || *value < 0 || *value == 1 || *value > 1'000'000) {
      fail("hold_out is neither 0 nor a whole number from 2");
    }
    return static_cast<int>(*value);
  }

  Wanted wanted(const YAML::Node& node) const {
    if (!node.IsMap()) fail("wanted is no list of keys and values");
    check_keys(node, "wanted", {"psnr", "seen", "posed"});
    Wanted result;
    if (node["psnr"]) result.psnr_db = number(node["psnr"], "wanted: psnr", 100);
    if (node["seen"]) result.seen = number(node["seen"], "wanted: seen", 1);
    if (node["posed"]) result.posed = number(node["posed"], "wanted: posed", 1);
    return result;
  }

  static std::vector<Step> default_steps(int hold_out) {
    std::vector<Step> steps(kAllSteps.begin(), kAllSteps.end());
    if (hold_out == 0) std::erase(steps, Step::evaluate);
    return steps;
  }

  std::vector<Step> steps(const YAML::Node& node, int hold_out) const {
    if (!node.IsSequence()) fail("steps is no list");
    std::set<Step> chosen;
    for (const YAML::Node& entry : node) {
      const auto step = step_named(text(entry, "steps"));
      if (!step) fail("steps knows no \"" + core::quotable(text(entry, "steps")) + "\"");
      chosen.insert(*step);
    }
    for (const Step step : {Step::evaluate, Step::export_model}) {
      if (chosen.contains(step) && !chosen.contains(Step::replay)) {
        fail("steps has " + std::string(name_of(step)) + " without the replay that it needs");
      }
    }
    if (chosen.contains(Step::evaluate) && hold_out == 0) {
      fail("steps has evaluate, but hold_out: 0 keeps no frames for it");
    }
    if (chosen.empty()) fail("steps is empty");
    return {chosen.begin(), chosen.end()};
  }

  /// A list of words, or words between blanks.
  std::vector<std::string> words(const YAML::Node& node, const std::string& key) const {
    std::vector<std::string> result;
    if (node.IsSequence()) {
      for (const YAML::Node& word : node) result.push_back(text(word, key));
      return result;
    }
    std::istringstream line(text(node, key));
    for (std::string word; line >> word;) result.push_back(word);
    return result;
  }

  int parts(const YAML::Node& node) const {
    const auto value = core::parse_whole_number(text(node, "parts"));
    if (!value || *value < 1 || *value > kMostParts) {
      fail("parts is no whole number from 1 to " + std::to_string(kMostParts));
    }
    return static_cast<int>(*value);
  }

  /// `steps`, `parts` and `options`, of the file or of one session.
  void take_settings(const YAML::Node& node, int hold_out, Job& job) const {
    if (node["steps"]) job.steps = steps(node["steps"], hold_out);
    if (node["parts"]) job.parts = parts(node["parts"]);
    const YAML::Node options = node["options"];
    if (!options) return;
    if (!options.IsMap()) fail("options is no list of keys and values");
    for (const auto& member : options) {
      const std::string name = text(member.first, "options");
      const auto step = step_named(name);
      if (!step) fail("options knows no step \"" + core::quotable(name) + "\"");
      job.words[*step] = words(member.second, "options: " + name);
    }
  }

  void add_session(const YAML::Node& entry, int hold_out, const Job& common, Jobs& jobs) const {
    Job job = common;
    if (entry.IsMap()) {
      check_keys(entry, "a session", {"folder", "name", "steps", "options", "parts"});
      if (!entry["folder"]) fail("a session has no folder");
      take_settings(entry, hold_out, job);
      if (entry["name"]) job.name = text(entry["name"], "name");
      job.folder = text(entry["folder"], "folder");
    } else {
      job.folder = text(entry, "sessions");
    }
    job.folder = (path_.parent_path() / job.folder).lexically_normal();
    if (job.folder.filename() == kEverySession) {
      if (!job.name.empty()) fail("one name cannot be that of all " + job.folder.string());
      add_all(job, jobs);
      return;
    }
    if (!job.folder.has_filename()) job.folder = job.folder.parent_path();
    if (job.name.empty()) job.name = job.folder.filename().string();
    jobs.jobs.push_back(std::move(job));
  }

  /// Every session within a folder, by name.
  void add_all(const Job& pattern, Jobs& jobs) const {
    const fs::path parent = pattern.folder.parent_path();
    std::vector<fs::path> folders;
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(parent, failure)) {
      if (fs::exists(entry.path() / "session.json", failure)) folders.push_back(entry.path());
    }
    if (folders.empty()) fail("there are no sessions in " + core::quotable(parent.string()));
    std::sort(folders.begin(), folders.end());
    for (const fs::path& folder : folders) {
      Job job = pattern;
      job.folder = folder;
      job.name = folder.filename().string();
      jobs.jobs.push_back(std::move(job));
    }
  }

  void check_names(const Jobs& jobs) const {
    std::set<std::string> names;
    for (const Job& job : jobs.jobs) {
      if (job.name.starts_with('.') || job.name.find('/') != std::string::npos) {
        fail("\"" + core::quotable(job.name) + "\" cannot be the name of a folder");
      }
      if (!names.insert(job.name).second) {
        fail("two sessions have the name \"" + core::quotable(job.name) +
             "\"; give one another by name:");
      }
    }
  }

  fs::path path_;
};

}  // namespace

Jobs read_jobs(const std::filesystem::path& path) {
  const JobsReader reader(path);
  try {
    return reader.read();
  } catch (const YAML::Exception& error) {
    reader.fail(std::string("is no valid YAML: ") + error.what());
  }
}

}  // namespace sheen::app
