// SPDX-License-Identifier: Apache-2.0
#include "usage/usage_error.h"

#include <string_view>
#include <vector>

#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/str_cat.h"

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

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
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
    text += strCat(" It is an option of ", joined(owners), ".");
  }
  return text;
}

std::string unknownCommand(const CLI::App& app, const std::string& word) {
  const std::vector<std::string> known = commandNames(app);
  return strCat("unknown command \"", printable(word), "\". Known commands: ", joined(known), ".",
                sentence(didYouMean(word, known)));
}

// What does not belong to any option; options first, as their values are left over with them.
std::string unknownWord(const CLI::App& app, const CLI::App& command) {
  const std::vector<std::string> words = app.remaining(true);
  const bool is_command = &command == &app && !words.empty() && !words.front().starts_with('-');
  if (is_command) return unknownCommand(app, words.front());
  for (const std::string& word : words) {
    if (word.size() > 1 && word[0] == '-') return unknownOption(app, command, word);
  }
  if (words.empty()) return "";
  return strCat("unexpected argument \"", printable(words.front()), "\".");
}

// "UINT" and the like, as the option's value is named in the help.
std::string wordsOfType(const std::string& type) {
  if (type.starts_with("UINT")) return "a whole number, 0 or more";
  if (type.starts_with("INT")) return "a whole number";
  if (type.starts_with("FLOAT")) return "a number";
  return "a value";
}

// "Could not convert: --count = abc".
std::string notConverted(const CLI::App& app, const CLI::App& command, std::string_view text) {
  const size_t colon = text.find(": ");
  const size_t equals = text.find(" = ");
  if (colon == std::string_view::npos || equals == std::string_view::npos || equals < colon) {
    return printable(text);
  }
  const std::string option(text.substr(colon + 2, equals - colon - 2));
  const CLI::Option* found = command.get_option_no_throw(option);
  if (found == nullptr) found = app.get_option_no_throw(option);
  return strCat(option, ": got \"", printable(text.substr(equals + 3)), "\"; accepted is ",
                found == nullptr ? "a value" : wordsOfType(found->get_type_name()));
}

std::string problemOf(const CLI::App& app, const CLI::App& command, const CLI::ParseError& error) {
  if (std::string unknown = unknownWord(app, command); !unknown.empty()) return unknown;
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
    return notConverted(app, command, error.what());
  }
  if (&command == &app && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    return strCat("no command is given. Known commands: ", joined(commandNames(app)), ".");
  }
  return printable(error.what());
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
