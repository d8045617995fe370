// SPDX-License-Identifier: Apache-2.0
// Layout of the text behind --help.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace viewloom::usage {

// Option, name of its value, description; then in parentheses: the default, other options that it
// needs or excludes. Lines end by column 100.
class HelpText final : public CLI::Formatter {
 public:
  HelpText();

  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_usage(const CLI::App* app, std::string name) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  // Options of which exactly one is to be given.
  std::string make_expanded(const CLI::App* alternatives) const override;
};

// "--fps HZ": the option, and the name of its value.
std::string withValueName(const CLI::Option& option);

}  // namespace viewloom::usage
