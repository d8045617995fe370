// SPDX-License-Identifier: Apache-2.0
// Command lines: options, subcommands, and errors.
//
// The parser behind this is CLI11. Each file that includes it takes seconds longer to compile, so
// it stays behind these handles. Everything here is for one thread.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace viewloom::usage {

inline constexpr int kExitUsage = 2;

// Thrown by functions that take the value of an option; says what came and what is accepted.
class BadValue : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// An option of a command. A handle, valid for as long as its CommandLine.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  std::string name() const;
  bool isShown() const;           // in the help
  std::string help() const;       // its description
  std::string valueName() const;  // "" for an option without a value

  // In the help: the heading above it, "" to hide it, its default, the same in words, the name of
  // its value.
  Option group(const std::string& heading) const;
  Option showDefault() const;
  Option defaultText(const std::string& text) const;
  Option valueName(const std::string& name) const;

  Option required() const;
  Option needs(Option other) const;
  Option needs(const std::string& other) const;  // of the same command, added before
  Option excludes(Option other) const;
  Option excludes(const std::string& other) const;
  // Environment variable that gives the value if the command line does not.
  Option environment(const std::string& variable) const;

  // Values that are accepted.
  Option between(int min, int max) const;
  Option between(uint32_t min, uint32_t max) const;
  Option between(double min, double max) const;
  Option positive() const;
  Option notNegative() const;
  Option existingFile() const;
  Option existingFolder() const;
  // The words also name the value. Suggests the nearest of them to another.
  Option oneOf(std::vector<std::string> words) const;
  // Number of values.
  Option count(int value_count) const;

  // Called when the command line names it.
  void onGiven(std::function<void()> act) const;

 private:
  CLI::Option* option_;
};

// A program or one of its subcommands. A handle, valid for as long as its CommandLine.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}

  std::string name() const;
  std::string help() const;
  void footer(const std::string& text) const;  // at the end of the help

  // An option that takes a value, or an argument without a name where `names` begins without "-".
  // `value` holds the default. The end of command_line.cpp lists the types that it may have.
  template <typename Value>
  Option add(const std::string& names, Value& value, const std::string& help = "") const;
  // An option whose value is given to `take`, which may throw BadValue.
  Option addTaken(const std::string& names, std::function<void(const std::string&)> take,
                  const std::string& help) const;
  // An option that takes a word, which stands for a value.
  template <typename Target, typename Value>
  Option addWord(const std::string& names, Target& value, const std::map<std::string, Value>& words,
                 const std::string& help) const;

  // An option without a value.
  Option addFlag(const std::string& names, bool& is_given, const std::string& help) const;
  Option addAction(const std::string& names, std::function<void()> act,
                   const std::string& help) const;

  // Subcommands take the options of those above them, too.
  Command addCommand(const std::string& name, const std::string& help) const;
  // Called when the command line names it and is right.
  void onChosen(std::function<void()> act) const;
  // Options of which exactly one is to be given.
  Command addAlternatives(const std::string& heading) const;

  bool wasNamed() const;
  std::optional<Option> find(const std::string& name) const;
  std::vector<Option> options() const;

 protected:
  CLI::App* app_;
};

// The command line of a program.
class CommandLine final : public Command {
 public:
  explicit CommandLine(const std::string& description = "", const std::string& program = "");
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;
  ~CommandLine();

  void version(const std::string& text) const;
  void requireCommand() const;  // else one may be named, or none

  // Nothing when the command line is right. Else the exit code, after help or an error was printed:
  // 0 for --help and --version, kExitUsage for an error.
  std::optional<int> parse(int argc, const char* const* argv) const;
  // Options alone, as in a shell's line; false when they are not right. Prints nothing.
  bool parse(const std::string& options) const;

 private:
  explicit CommandLine(std::unique_ptr<CLI::App> app);

  std::unique_ptr<CLI::App> owned_;
};

template <typename Target, typename Value>
Option Command::addWord(const std::string& names, Target& value,
                        const std::map<std::string, Value>& words, const std::string& help) const {
  std::vector<std::string> keys;
  for (const auto& [word, meaning] : words) keys.push_back(word);
  const auto take = [&value, words](const std::string& word) { value = words.at(word); };
  return addTaken(names, take, help).oneOf(std::move(keys));
}

}  // namespace viewloom::usage
