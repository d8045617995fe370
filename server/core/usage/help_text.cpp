// SPDX-License-Identifier: Apache-2.0
#include "usage/help_text.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "base/str_cat.h"
#include "usage/value_checks.h"

namespace viewloom::usage {
namespace {

constexpr size_t kTextColumn = 28;
constexpr size_t kTextWidth = 100 - kTextColumn;
// An option that excludes more says so in its own description.
constexpr size_t kListedExcludes = 3;

bool isMany(const CLI::Option& option) {
  return option.get_expected_max() == CLI::detail::expected_max_vector_size;
}

// "--fps, --rate HZ", or "colour...".
std::string headOf(const CLI::Option& option, bool is_positional) {
  if (is_positional) return option.get_name(true, false) + (isMany(option) ? "..." : "");
  std::string names = CLI::detail::find_and_replace(option.get_name(false, true), ",", ", ");
  if (option.get_type_size() == 0) return names;
  return strCat(names, " ", option.get_type_name(), isMany(option) ? "..." : "");
}

// Sorted, as the parser keeps them in no order; options that the help hides are left out.
std::vector<std::string> namesOf(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) {
    if (!option->get_group().empty()) names.push_back(option->get_name());
  }
  std::ranges::sort(names);
  return names;
}

std::vector<std::string> excludesOf(const CLI::Option& option) {
  std::set<CLI::Option*> listed = option.get_excludes();
  if (listed.size() > kListedExcludes) return {};
  std::erase_if(listed, [](const CLI::Option* other) {
    return other->get_excludes().size() > kListedExcludes;
  });
  return namesOf(listed);
}

// "default 15; not with --speed".
std::string notesOf(const CLI::Option& option) {
  std::vector<std::string> notes;
  if (option.get_required()) notes.emplace_back("required");
  if (!option.get_default_str().empty()) {
    notes.push_back(strCat("default ", option.get_default_str()));
  }
  if (!option.get_envname().empty()) notes.push_back(strCat("environment ", option.get_envname()));
  const std::vector<std::string> needed = namesOf(option.get_needs());
  if (!needed.empty()) notes.push_back(strCat("needs ", joined(needed, ", ")));
  const std::vector<std::string> excluded = excludesOf(option);
  if (!excluded.empty()) notes.push_back(strCat("not with ", joined(excluded, ", ")));
  return joined(notes, "; ");
}

// The line, broken between words.
std::string wrapped(std::string_view line) {
  const std::string indent(kTextColumn, ' ');
  std::string text;
  while (line.size() > kTextWidth) {
    const size_t end = line.rfind(' ', kTextWidth);
    if (end == std::string_view::npos || end < line.find_first_not_of(' ')) break;
    text += strCat(line.substr(0, end), "\n", indent);
    line.remove_prefix(end + 1);
  }
  return strCat(text, line);
}

// The notes belong to the first line: a table of values may follow it.
std::string descriptionOf(const CLI::Option& option) {
  const std::string description = option.get_description();
  const std::string notes = notesOf(option);
  const size_t end = std::min(description.find('\n'), description.size());
  std::string text =
      wrapped(strCat(description.substr(0, end), notes.empty() ? "" : strCat(" (", notes, ")")));
  for (size_t from = end; from < description.size();) {
    const size_t next = std::min(description.find('\n', from + 1), description.size());
    text += strCat("\n", std::string(kTextColumn, ' '),
                   wrapped(std::string_view(description).substr(from + 1, next - from - 1)));
    from = next;
  }
  return text;
}

}  // namespace

HelpText::HelpText() {
  label("Positionals", "Arguments");
  label("SUBCOMMAND", "COMMAND");
  column_width(kTextColumn);
}

std::string HelpText::make_help(const CLI::App* app, std::string name,
                                CLI::AppFormatMode mode) const {
  return CLI::detail::find_and_replace(CLI::Formatter::make_help(app, std::move(name), mode),
                                       "\n\n\n", "\n\n");
}

std::string HelpText::make_usage(const CLI::App* app, std::string name) const {
  return "\n" + CLI::Formatter::make_usage(app, std::move(name));
}

std::string HelpText::make_option(const CLI::Option* option, bool is_positional) const {
  std::string text = "  " + headOf(*option, is_positional);
  text += text.size() < kTextColumn ? "" : "\n";
  const size_t used = text.ends_with('\n') ? 0 : text.size();
  return strCat(text, std::string(kTextColumn - used, ' '), descriptionOf(*option), "\n");
}

std::string HelpText::make_expanded(const CLI::App* alternatives) const {
  const CLI::Option* const help = alternatives->get_help_ptr();
  return make_group(strCat(alternatives->get_group(), ", exactly one of"), false,
                    alternatives->get_options([help](const CLI::Option* option) {
                      return option != help && option->nonpositional();
                    }));
}

std::string withValueName(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name();
  return strCat(option.get_name(), " ", option.get_type_name());
}

}  // namespace viewloom::usage
