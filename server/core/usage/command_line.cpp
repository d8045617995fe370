// SPDX-License-Identifier: Apache-2.0
#include "usage/command_line.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <type_traits>
#include <utility>

#include "base/str_cat.h"
#include "usage/help_text.h"
#include "usage/usage_error.h"
#include "usage/value_checks.h"

namespace viewloom::usage {
namespace {

// The number that an option's text stands for; void where the text is taken as it is.
template <typename Value>
struct NumberIn {
  using Type = void;
};
template <>
struct NumberIn<int> {
  using Type = int;
};
template <>
struct NumberIn<uint32_t> {
  using Type = uint32_t;
};
template <>
struct NumberIn<uint64_t> {
  using Type = uint64_t;
};
template <>
struct NumberIn<double> {
  using Type = double;
};
template <typename Value>
struct NumberIn<std::optional<Value>> : NumberIn<Value> {};
template <typename Value>
struct NumberIn<std::vector<Value>> : NumberIn<Value> {};

}  // namespace

std::string Option::name() const {
  return option_->get_name();
}

Option Option::group(const std::string& heading) const {
  option_->group(heading);
  return *this;
}

Option Option::showDefault() const {
  option_->capture_default_str();
  return *this;
}

Option Option::defaultText(const std::string& text) const {
  option_->default_str(text);
  return *this;
}

Option Option::valueName(const std::string& name) const {
  option_->type_name(name);
  return *this;
}

Option Option::required() const {
  option_->required();
  return *this;
}

Option Option::needs(Option other) const {
  option_->needs(other.option_);
  return *this;
}

Option Option::needs(const std::string& other) const {
  option_->needs(other);
  return *this;
}

Option Option::excludes(Option other) const {
  option_->excludes(other.option_);
  return *this;
}

Option Option::excludes(const std::string& other) const {
  option_->excludes(other);
  return *this;
}

Option Option::environment(const std::string& variable) const {
  option_->envname(variable);
  return *this;
}

Option Option::between(int min, int max) const {
  option_->check(inRange(min, max, strCat(min, "..", max)));
  return *this;
}

Option Option::between(uint32_t min, uint32_t max) const {
  option_->check(inRange(min, max, strCat(min, "..", max)));
  return *this;
}

Option Option::between(double min, double max) const {
  option_->check(inRange(min, max, strCat(min, "..", max)));
  return *this;
}

Option Option::positive() const {
  using Limits = std::numeric_limits<double>;
  option_->check(inRange(Limits::min(), Limits::max(), "more than 0"));
  return *this;
}

Option Option::notNegative() const {
  option_->check(inRange(0.0, std::numeric_limits<double>::max(), "0 or more"));
  return *this;
}

Option Option::existingFile() const {
  option_->check(CLI::ExistingFile.description(""));
  return *this;
}

Option Option::existingFolder() const {
  option_->check(CLI::ExistingDirectory.description(""));
  return *this;
}

Option Option::oneOf(std::vector<std::string> words) const {
  option_->type_name(joined(words, "|"));
  option_->check(usage::oneOf(std::move(words)));
  return *this;
}

Option Option::count(int value_count) const {
  option_->expected(value_count);
  return *this;
}

void Option::onGiven(std::function<void()> act) const {
  option_->each([act = std::move(act)](const std::string&) { act(); });
}

bool Option::isShown() const {
  return !option_->get_group().empty();
}

std::string Option::help() const {
  return option_->get_description();
}

std::string Option::valueName() const {
  const bool has_value = option_->nonpositional() && option_->get_type_size() > 0;
  return has_value ? option_->get_type_name() : "";
}

std::string Command::name() const {
  return app_->get_name();
}

std::string Command::help() const {
  return app_->help();
}

void Command::footer(const std::string& text) const {
  app_->footer(text);
}

template <typename Value>
Option Command::add(const std::string& names, Value& value, const std::string& help) const {
  CLI::Option* const option = app_->add_option(names, value, help);
  using Number = typename NumberIn<Value>::Type;
  if constexpr (!std::is_void_v<Number>) {
    option->type_name(std::is_floating_point_v<Number> ? "NUMBER" : "N");
    option->check(anyNumber<Number>());
  }
  return Option(*option);
}

Option Command::addTaken(const std::string& names, std::function<void(const std::string&)> take,
                         const std::string& help) const {
  const auto take_or_refuse = [take = std::move(take), names](const std::string& value) {
    try {
      take(value);
    } catch (const BadValue& refused) {
      throw CLI::ValidationError(names, refused.what());
    }
  };
  return Option(*app_->add_option_function<std::string>(names, take_or_refuse, help));
}

Option Command::addFlag(const std::string& names, bool& is_given, const std::string& help) const {
  return Option(*app_->add_flag(names, is_given, help));
}

Option Command::addAction(const std::string& names, std::function<void()> act,
                          const std::string& help) const {
  return Option(*app_->add_flag_callback(names, std::move(act), help));
}

Command Command::addCommand(const std::string& name, const std::string& help) const {
  CLI::App* const command = app_->add_subcommand(name, help)->group("Commands");
  command->fallthrough();
  return Command(*command);
}

void Command::onChosen(std::function<void()> act) const {
  app_->callback(std::move(act));
}

Command Command::addAlternatives(const std::string& heading) const {
  CLI::Option_group* const alternatives = app_->add_option_group(heading);
  alternatives->require_option(1);
  return Command(*alternatives);
}

bool Command::wasNamed() const {
  return app_->parsed();
}

std::optional<Option> Command::find(const std::string& name) const {
  CLI::Option* const option = app_->get_option_no_throw(name);
  return option == nullptr ? std::nullopt : std::optional(Option(*option));
}

std::vector<Option> Command::options() const {
  std::vector<Option> options;
  for (CLI::Option* option : app_->get_options({})) options.emplace_back(*option);
  return options;
}

CommandLine::CommandLine(const std::string& description, const std::string& program)
    : CommandLine(std::make_unique<CLI::App>(description, program)) {}

CommandLine::CommandLine(std::unique_ptr<CLI::App> app) : Command(*app), owned_(std::move(app)) {
  app_->require_subcommand(0, 1);
  app_->formatter(std::make_shared<HelpText>());
  app_->set_help_flag("-h,--help", "Print this help and exit");
}

CommandLine::~CommandLine() = default;

void CommandLine::version(const std::string& text) const {
  app_->set_version_flag("--version", text, "Print the version and exit");
}

void CommandLine::requireCommand() const {
  app_->require_subcommand(1);
}

std::optional<int> CommandLine::parse(int argc, const char* const* argv) const {
  try {
    app_->parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::Success& help) {
    return app_->exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "%s\n", usageError(*app_, error).c_str());
    return kExitUsage;
  }
}

bool CommandLine::parse(const std::string& options) const {
  try {
    app_->parse(options);
    return true;
  } catch (const CLI::ParseError&) {
    return false;
  }
}

// The types that options may have.
#define VIEWLOOM_OPTION_OF(...) \
  template Option Command::add(const std::string&, __VA_ARGS__&, const std::string&) const
VIEWLOOM_OPTION_OF(std::string);
VIEWLOOM_OPTION_OF(std::filesystem::path);
VIEWLOOM_OPTION_OF(int);
VIEWLOOM_OPTION_OF(uint32_t);
VIEWLOOM_OPTION_OF(uint64_t);
VIEWLOOM_OPTION_OF(double);
VIEWLOOM_OPTION_OF(std::optional<int>);
VIEWLOOM_OPTION_OF(std::optional<uint32_t>);
VIEWLOOM_OPTION_OF(std::optional<double>);
VIEWLOOM_OPTION_OF(std::vector<std::string>);
VIEWLOOM_OPTION_OF(std::vector<std::filesystem::path>);
VIEWLOOM_OPTION_OF(std::vector<double>);
#undef VIEWLOOM_OPTION_OF

}  // namespace viewloom::usage
