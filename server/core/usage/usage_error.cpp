// SPDX-License-Identifier: Apache-2.0
#include "usage/usage_error.h"

#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/str_cat.h"
#include "usage/help_text.h"
#include "usage/value_checks.h"

namespace viewloom::usage {
namespace {

// The command that the words belong to: the subcommand, where one was given.
const CLI::App& commandOf(const CLI::App& app) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  return chosen.empty() ? app : *chosen.front();
}

std::string fullName(const CLI::App& app, const CLI::App& command) {
  return &app == &command ? app.get_name() : strCat(app.get_name(), " ", command.get_name());
}

void addOptionNames(const CLI::App& app, std::vector<std::string>& names) {
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
}

std::vector<std::string> commandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

std::string sentence(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] -= 'a' - 'A';
  return text.empty() ? "" : " " + text;
}

// The other commands that have the option.
std::vector<std::string> ownersOf(const CLI::App& app, const std::string& option) {
  std::vector<std::string> owners;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_option_no_throw(option) != nullptr) {
      owners.push_back(strCat("\"", fullName(app, *command), "\""));
    }
  }
  return owners;
}

std::string unknownOption(const CLI::App& app, const CLI::App& command, const std::string& word) {
  const std::string option = word.substr(0, word.find('='));
  std::vector<std::string> known;
  addOptionNames(command, known);
  if (&command != &app) addOptionNames(app, known);
  const std::string meant = didYouMean(option, known);
  std::string text = strCat("unknown option \"", printable(option), "\".", sentence(meant));
  const std::vector<std::string> owners = ownersOf(app, option);
  if (!owners.empty()) {
    text += strCat(" It is an option of ", joined(owners, ", "), ".");
  }
  return text;
}

std::string unknownCommand(const CLI::App& app, const std::string& word) {
  const std::vector<std::string> known = commandNames(app);
  return strCat("unknown command \"", printable(word), "\". Known commands: ", joined(known, ", "),
                ".", sentence(didYouMean(word, known)));
}

std::string knownArguments(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) names.push_back(option->get_name());
  }
  return names.empty() ? "Only options are accepted here."
                       : strCat("Arguments without an option: ", joined(names, ", "), ".");
}

// Words that belong to no option; options first, as their values are left over with them.
std::string unknownWord(const CLI::App& app, const CLI::App& command) {
  const std::vector<std::string> words = app.remaining(true);
  const bool is_command = &command == &app && !words.empty() && !words.front().starts_with('-');
  if (is_command) return unknownCommand(app, words.front());
  for (const std::string& word : words) {
    if (word.size() > 1 && word[0] == '-') return unknownOption(app, command, word);
  }
  if (words.empty()) return "";
  return strCat("unexpected argument \"", printable(words.front()), "\". ",
                knownArguments(command));
}

const CLI::Option* optionNamed(const CLI::App& app, const CLI::App& command,
                               const std::string& name) {
  const CLI::Option* const found = command.get_option_no_throw(name);
  return found == nullptr ? app.get_option_no_throw(name) : found;
}

// "--out FILE", where there is such an option.
std::string howToWrite(const CLI::App& app, const CLI::App& command, const std::string& name) {
  const CLI::Option* const option = optionNamed(app, command, name);
  return option == nullptr ? name : withValueName(*option);
}

// "Could not convert: --count = abc".
std::string notConverted(const std::string& text) {
  const size_t colon = text.find(": ");
  const size_t equals = text.find(" = ");
  if (colon == std::string::npos || equals == std::string::npos || equals < colon) return text;
  return strCat(text.substr(colon + 2, equals - colon - 2), ": ",
                refusal(text.substr(equals + 3), "a number"));
}

// "--fps excludes --speed", "--speed requires --replay".
std::pair<std::string, std::string> bothSides(const std::string& text, std::string_view verb) {
  const size_t at = text.find(verb);
  if (at == std::string::npos) return {text, ""};
  return {text.substr(0, at), text.substr(at + verb.size())};
}

// "--out is required", "Exactly 1 option from [--display,--preset] is required and 2 were given".
std::string missing(const CLI::App& app, const CLI::App& command, const std::string& text) {
  const size_t open = text.find('[');
  const size_t close = text.find(']');
  if (open != std::string::npos && close != std::string::npos) {
    const std::string names =
        CLI::detail::find_and_replace(text.substr(open + 1, close - open - 1), ",", ", ");
    return strCat(text.ends_with("given") ? "more than one of these was given: "
                                          : "one of these is missing: ",
                  names, ". Give exactly one");
  }
  const std::string name = text.substr(0, text.find(" is required"));
  return strCat(name, " is missing. Give ", howToWrite(app, command, name));
}

// "--out: 1 required TEXT missing", "--count: At Most 1 required but received 2".
std::string wrongCount(const CLI::App& app, const CLI::App& command, const std::string& text) {
  const std::string name = text.substr(0, text.find(": "));
  if (optionNamed(app, command, name) == nullptr) return text;
  const bool is_many = text.find("At Most") != std::string::npos;
  return strCat(name,
                is_many ? ": came with too many values. Give " : ": the value is missing. Give ",
                howToWrite(app, command, name), is_many ? " once" : "");
}

std::string problemOf(const CLI::App& app, const CLI::App& command, const CLI::ParseError& error) {
  if (std::string unknown = unknownWord(app, command); !unknown.empty()) return unknown;
  const std::string text = printable(error.what());
  const auto is = [&]<typename Kind>(std::type_identity<Kind>) {
    return dynamic_cast<const Kind*>(&error) != nullptr;
  };
  if (is(std::type_identity<CLI::ConversionError>())) return notConverted(text);
  if (is(std::type_identity<CLI::ArgumentMismatch>())) return wrongCount(app, command, text);
  if (is(std::type_identity<CLI::ExcludesError>())) {
    const auto [one, other] = bothSides(text, " excludes ");
    return strCat(one, " and ", other, " cannot be combined. Leave out one of them");
  }
  if (is(std::type_identity<CLI::RequiresError>())) {
    const auto [one, other] = bothSides(text, " requires ");
    return strCat(one, " works only with ", other, ". Add ", howToWrite(app, command, other),
                  ", or leave out ", one);
  }
  if (!is(std::type_identity<CLI::RequiredError>())) return text;
  const bool needs_command = &command == &app && !commandNames(app).empty();
  if (!needs_command) return missing(app, command, text);
  return strCat("no command is given. Known commands: ", joined(commandNames(app), ", "), ".");
}

}  // namespace

std::string usageError(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = commandOf(app);
  const std::string name = fullName(app, command);
  std::string problem = problemOf(app, command, error);
  if (!problem.ends_with('.') && !problem.ends_with('?')) problem += '.';
  return strCat(name, ": ", problem, " See \"", name, " --help\".");
}

}  // namespace viewloom::usage
