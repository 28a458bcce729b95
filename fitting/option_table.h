// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sheen::fitting {

/// Settings of a representation as text, by name: what a command line, a report or another language
/// hands over. Settings that are not named keep their defaults.
using OptionValues = std::map<std::string, std::string, std::less<>>;

/// One setting, bound to the field of a struct that holds it. All text about it stands here: the
/// command line, the help and the reports are made from it.
struct FitOption {
  std::string name;  ///< as on the command line, without dashes
  std::string help;  ///< one sentence
  std::string type;  ///< "grid|disk", "NUMBER"; empty for a flag
  /// Takes the text of a value; throws std::invalid_argument saying what is allowed.
  std::function<void(const std::string& text)> set;
  /// The value as text; empty: decided by the fit.
  std::function<std::string()> get;

  [[nodiscard]] bool is_flag() const { return type.empty(); }
};

/// Every setting of one representation, in the order of the help.
using OptionTable = std::vector<FitOption>;

/// The settings of one representation, whatever they are.
class FitOptions {
 public:
  virtual ~FitOptions() = default;
  /// Bound to this object.
  virtual OptionTable table() = 0;
  /// Throws std::invalid_argument naming the setting and its allowed values.
  virtual void check() const = 0;
};

/// A struct of settings with `check() const`, beside which `option_table(Options&)` is found.
template <typename Options>
class OptionsOf final : public FitOptions {
 public:
  OptionTable table() override { return option_table(value); }
  void check() const override { value.check(); }

  Options value;
};

/// For descriptors: a new set, and the settings of a type that is known.
template <typename Options>
std::unique_ptr<FitOptions> new_options() {
  return std::make_unique<OptionsOf<Options>>();
}
template <typename Options>
const Options& options_as(const FitOptions& options) {
  return dynamic_cast<const OptionsOf<Options>&>(options).value;
}

/// Of a representation that has nothing to choose.
struct NoOptions {
  void check() const {}
};
inline OptionTable option_table(NoOptions& /*options*/) {
  return {};
}

/// A number in [least, most].
FitOption number_option(std::string name, double& value, double least, double most,
                        std::string help);
FitOption number_option(std::string name, int& value, int least, int most, std::string help);
/// A number that the fit chooses itself when it is not given.
FitOption number_option(std::string name, std::optional<float>& value, double least, double most,
                        std::string help);
FitOption flag_option(std::string name, bool& value, std::string help);

/// One of a few words; `words` holds them in the order of the help, each with its value.
template <typename Value>
FitOption choice_option(std::string name, Value& value,
                        std::vector<std::pair<std::string, Value>> words, std::string help);

/// Sets what `values` names. Throws std::invalid_argument for a name that the table does not have
/// (`representation` is named in the message) or a value that is not allowed.
void apply(const OptionValues& values, std::string_view representation, const OptionTable& table);

/// Throws std::invalid_argument: "--name is TEXT, allowed: ...".
[[noreturn]] void refuse_value(const std::string& name, const std::string& text,
                               const std::string& allowed);

/// The same unless `holds`.
void require_value(bool holds, const std::string& name, double value, const std::string& allowed);

template <typename Value>
FitOption choice_option(std::string name, Value& value,
                        std::vector<std::pair<std::string, Value>> words, std::string help) {
  std::string type;
  for (const auto& [word, unused] : words) type += (type.empty() ? "" : "|") + word;
  FitOption option{name, std::move(help), type, {}, {}};
  option.set = [name = std::move(name), words, type, &value](const std::string& text) {
    for (const auto& [word, choice] : words) {
      if (word != text) continue;
      value = choice;
      return;
    }
    refuse_value(name, text, type);
  };
  option.get = [words = std::move(words), &value] {
    for (const auto& [word, choice] : words) {
      if (choice == value) return word;
    }
    return std::string();
  };
  return option;
}

}  // namespace sheen::fitting
