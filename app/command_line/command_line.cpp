// SPDX-License-Identifier: MIT
#include "app/command_line/command_line.h"

#include "core/text/lower_case.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <sstream>

namespace sheen::app {
namespace {

std::string text_of(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

std::string joined(const std::vector<std::string>& words, const char* mark) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : mark) + word;
  return all;
}

std::optional<double> number_in(const std::string& text) {
  double number = 0;
  if (!CLI::detail::lexical_cast(text, number)) return std::nullopt;
  return number;
}

/// Refuses numbers outside of what `is_fine` accepts.
CLI::Validator number_check(const std::function<bool(double)>& is_fine, const std::string& wanted) {
  return CLI::Validator(
      [=](const std::string& text) {
        const auto number = number_in(text);
        if (number && is_fine(*number)) return std::string();
        return "Value " + text + " is not " + wanted;
      },
      "");
}

template <typename Value>
Option bound(CLI::App* app, const std::string& names, Value& value, const std::string& text) {
  return Option(app->add_option(names, value, text));
}

/// Lines of at most `width` characters, broken between words.
std::string wrapped(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::string lines;
  std::size_t length = 0;
  for (std::string word; words >> word;) {
    if (length > 0 && length + 1 + word.size() > width) {
      lines += '\n';
      length = 0;
    }
    if (length > 0) lines += ' ';
    lines += word;
    length += word.size() + (length > 0 ? 1 : 0);
  }
  return lines;
}

/// Help that fits a terminal.
class HelpFormatter final : public CLI::Formatter {
 public:
  std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
    // CLI11 shows a negated word as "--word{false}".
    std::string name = CLI::Formatter::make_option_name(option, is_positional);
    const std::string mark = "{false}";
    const auto place = name.find(mark);
    if (place != std::string::npos) name.erase(place, mark.size());
    return name;
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(CLI::Formatter::make_option_desc(option), kWidth - get_column_width());
  }

 private:
  static constexpr std::size_t kWidth = 100;
};

}  // namespace

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::type(const std::string& name) {
  option_->type_name(name);
  return *this;
}

Option& Option::show_default() {
  option_->capture_default_str();
  return *this;
}

Option& Option::range(double least, double most) {
  option_->check(number_check([=](double v) { return v >= least && v <= most; },
                              "in range [" + text_of(least) + " - " + text_of(most) + "]"));
  return *this;
}

Option& Option::positive() {
  option_->check(number_check([](double v) { return v > 0; }, "a positive number"));
  return *this;
}

Option& Option::not_negative() {
  option_->check(number_check([](double v) { return v >= 0; }, "0 or a positive number"));
  return *this;
}

Option& Option::one_of(const std::vector<std::string>& words) {
  option_->check(CLI::IsMember(words).description(""));
  option_->type_name(joined(words, "|"));
  return *this;
}

Option& Option::check(const std::function<std::string(const std::string&)>& fault) {
  option_->check(CLI::Validator([fault](const std::string& text) { return fault(text); }, ""));
  return *this;
}

Option& Option::excludes(const Option& other) {
  option_->excludes(other.option_);
  return *this;
}

Option& Option::numbers(int count) {
  option_->expected(count);
  return *this;
}

Option& Option::separated_by(char mark) {
  option_->delimiter(mark);
  return *this;
}

bool Option::is_given() const {
  return option_->count() > 0;
}

Command::Command(CLI::App* app)
    : app_(app), checks_(std::make_shared<std::vector<std::function<void()>>>()) {}

Option Command::option(const std::string& names, int& value, const std::string& text) {
  return bound(app_, names, value, text);
}
Option Command::option(const std::string& names, std::uint32_t& value, const std::string& text) {
  return bound(app_, names, value, text);
}
Option Command::option(const std::string& names, std::uint64_t& value, const std::string& text) {
  return bound(app_, names, value, text);
}
Option Command::option(const std::string& names, float& value, const std::string& text) {
  return bound(app_, names, value, text);
}
Option Command::option(const std::string& names, double& value, const std::string& text) {
  return bound(app_, names, value, text);
}
Option Command::option(const std::string& names, std::string& value, const std::string& text) {
  return bound(app_, names, value, text);
}
Option Command::option(const std::string& names, std::filesystem::path& value,
                       const std::string& text) {
  return bound(app_, names, value, text);
}
Option Command::option(const std::string& names, std::optional<int>& value,
                       const std::string& text) {
  return bound(app_, names, value, text);
}
Option Command::option(const std::string& names, std::optional<double>& value,
                       const std::string& text) {
  return bound(app_, names, value, text);
}
Option Command::option(const std::string& names, std::vector<std::string>& value,
                       const std::string& text) {
  return bound(app_, names, value, text);
}
Option Command::option(const std::string& names, std::vector<double>& value,
                       const std::string& text) {
  return bound(app_, names, value, text);
}
Option Command::option(const std::string& names, std::vector<std::filesystem::path>& value,
                       const std::string& text) {
  return bound(app_, names, value, text);
}

Option Command::option(const std::string& names, const std::function<void(const std::string&)>& set,
                       const std::string& text) {
  return Option(app_->add_option_function<std::string>(names, set, text));
}

Option Command::option(const std::string& names,
                       const std::function<void(const std::vector<std::string>&)>& set,
                       const std::string& text) {
  return Option(app_->add_option_function<std::vector<std::string>>(names, set, text));
}

Option Command::flag(const std::string& names, bool& value, const std::string& text) {
  return Option(app_->add_flag(names, value, text));
}

Option Command::switch_on(const std::string& name, const std::function<void()>& set,
                          const std::string& text) {
  return Option(app_->add_flag_callback(name, set, text));
}

Option Command::choice_of_words(const std::string& names, const std::vector<std::string>& words,
                                const std::string& default_word, const std::string& text,
                                const std::function<void(std::size_t)>& choose) {
  const std::string shown = default_word.empty() ? text : text + " (default " + default_word + ")";
  CLI::Option* const option = app_->add_option_function<std::string>(
      names,
      [words, names, choose](const std::string& given) {
        const auto found = std::ranges::find(words, core::lower_case(given));
        if (found == words.end()) {
          throw UsageError(names + ": " + given + " is not one of " + joined(words, ", "));
        }
        choose(static_cast<std::size_t>(found - words.begin()));
      },
      shown);
  option->type_name(joined(words, "|"));
  return Option(option);
}

Command Command::exactly_one_of(const std::string& heading, const std::string& text) {
  CLI::Option_group* const group = app_->add_option_group(heading, text);
  group->require_option(1);
  return Command(group);
}

void Command::example(const std::string& text) {
  app_->footer(text);
}

void Command::after_parsing(const std::function<void()>& check) {
  checks_->push_back(check);
  app_->parse_complete_callback([checks = checks_] {
    for (const auto& each : *checks) each();
  });
}

void Command::action(const std::function<void()>& run) {
  app_->final_callback(run);
}

CommandLine::CommandLine(const std::string& text, const std::string& version,
                         const std::string& footer)
    : app_(std::make_unique<CLI::App>(text)) {
  app_->formatter(std::make_shared<HelpFormatter>());
  app_->set_version_flag("--version", version);
  app_->require_subcommand(0, 1);  // none is reported below: CLI11 would not name a wrong one
  app_->footer(footer);
}

CommandLine::~CommandLine() = default;

Command CommandLine::command(const std::string& name, const std::string& text) {
  return Command(app_->add_subcommand(name, text));
}

bool CommandLine::run(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
    if (app_->get_subcommands().empty()) throw CLI::RequiredError("A subcommand");
    return true;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      app_->exit(error);
      return false;
    }
    // CLI11's message is one line already; say where help is on the same line.
    throw UsageError(std::string(error.what()) + "; see sheen --help or sheen COMMAND --help");
  }
}

}  // namespace sheen::app
