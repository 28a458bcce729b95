// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// The command line over CLI11, which is compiled in one file only: its templates take seconds each.
namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace sheen::app {

/// The arguments contradict each other or one is not allowed: one line, exit code 2.
class UsageError : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// An option or argument of a command, to be described further. A handle: copies mean the same.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option& required();
  Option& type(const std::string& name);  ///< how the help shows the value: "FILE"
  Option& show_default();                 ///< in the help
  Option& range(double least, double most);
  Option& positive();
  Option& not_negative();
  Option& one_of(const std::vector<std::string>& words);
  /// `fault` gives what is wrong with a value, empty when it is fine.
  Option& check(const std::function<std::string(const std::string&)>& fault);
  Option& excludes(const Option& other);
  Option& numbers(int count);       ///< takes so many values
  Option& separated_by(char mark);  ///< several values in one word

  [[nodiscard]] bool is_given() const;

 private:
  CLI::Option* option_;
};

/// One subcommand while it is described. Variables are bound: parsing sets them, and whatever they
/// hold before is the default.
class Command {
 public:
  explicit Command(CLI::App* app);

  // Names: "session" for an argument, "-o,--output" for an option.
  Option option(const std::string& names, int& value, const std::string& text);
  Option option(const std::string& names, std::uint32_t& value, const std::string& text);
  Option option(const std::string& names, std::uint64_t& value, const std::string& text);
  Option option(const std::string& names, float& value, const std::string& text);
  Option option(const std::string& names, double& value, const std::string& text);
  Option option(const std::string& names, std::string& value, const std::string& text);
  Option option(const std::string& names, std::filesystem::path& value, const std::string& text);
  Option option(const std::string& names, std::optional<int>& value, const std::string& text);
  Option option(const std::string& names, std::optional<double>& value, const std::string& text);
  Option option(const std::string& names, std::vector<std::string>& value, const std::string& text);
  Option option(const std::string& names, std::vector<double>& value, const std::string& text);
  Option option(const std::string& names, std::vector<std::filesystem::path>& value,
                const std::string& text);
  /// `set` throws UsageError for what is not allowed.
  Option option(const std::string& names, const std::function<void(const std::string&)>& set,
                const std::string& text);
  /// An option that takes several words, or is given several times.
  Option option(const std::string& names,
                const std::function<void(const std::vector<std::string>&)>& set,
                const std::string& text);
  /// "--list"; "--exposure,!--no-exposure" where either word may be said.
  Option flag(const std::string& names, bool& value, const std::string& text);

  /// A flag that does something.
  Option switch_on(const std::string& name, const std::function<void()>& set,
                   const std::string& text);

  /// One of a few words, which end up in the help together with the default.
  template <typename Value>
  Option choice(const std::string& names, Value& value,
                const std::vector<std::pair<std::string, Value>>& words, const std::string& text) {
    std::vector<std::string> names_of_words;
    std::string default_word;
    for (const auto& [word, choice] : words) {
      names_of_words.push_back(word);
      if (choice == value) default_word = word;
    }
    return choice_of_words(names, names_of_words, default_word, text,
                           [&value, words](std::size_t idx) { value = words[idx].second; });
  }

  /// Options under a heading of their own, of which exactly one must be given.
  Command exactly_one_of(const std::string& heading, const std::string& text);

  /// Shown after the options.
  void example(const std::string& text);
  /// Looks at the arguments together, before `action`, in the order in which they were added;
  /// throws UsageError.
  void after_parsing(const std::function<void()>& check);
  void action(const std::function<void()>& run);

 private:
  Option choice_of_words(const std::string& names, const std::vector<std::string>& words,
                         const std::string& default_word, const std::string& text,
                         const std::function<void(std::size_t)>& choose);

  CLI::App* app_;
  std::shared_ptr<std::vector<std::function<void()>>> checks_;
};

/// The program's commands.
class CommandLine {
 public:
  CommandLine(const std::string& text, const std::string& version, const std::string& footer);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;
  CommandLine(CommandLine&&) = delete;
  CommandLine& operator=(CommandLine&&) = delete;

  Command command(const std::string& name, const std::string& text);

  /// Parses and runs. Returns false after --help or --version, which have been answered. Throws
  /// UsageError, or what the command throws.
  bool run(int argc, char** argv);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace sheen::app
