// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"

#include <optional>
#include <string>

namespace viewloom::cli {

std::vector<NamedCommand> addCommands(const usage::Command& app) {
  std::vector<NamedCommand> commands;
  const auto add = [&](const char* name, const char* description, auto add_command) {
    const usage::Command command = app.addCommand(name, description);
    commands.push_back({.syntax = command, .run = add_command(command)});
  };
  add("publish", "Publish files, a folder, a recording or a built-in scene as a stream",
      addPublishCommand);
  add("inspect", "Report what files contain, how viewloom reads them, and what looks wrong",
      addInspectCommand);
  add("watch", "Receive the views of a stream, save them, and report rate and latency",
      addWatchCommand);
  add("show", "Show a stream on a light-field panel or in a window", addShowCommand);
  add("record", "Record the views of a stream in a file", addRecordCommand);
  add("advise", "Compute which camera a scene needs, so that a display shows all of it",
      addAdviseCommand);
  add("list", "List the streams, displays and presets of a server", addListCommand);
  add("cast", "Show a stream on a Looking Glass through Looking Glass Bridge", addCastCommand);
  commands.back().calls_server = false;
  app.footer(
      "Examples:\n"
      "  viewloom publish --synthetic                     publish the built-in scene as \"demo\"\n"
      "  viewloom watch --count 1 --out .                 save one quilt of it\n"
      "  viewloom watch --help                            options of one command");
  return commands;
}

void noteMessages(const std::vector<NamedCommand>& commands, CommonOptions& common) {
  for (const NamedCommand& command : commands) {
    for (const char* name : {"display", "encoding"}) {
      const std::optional<usage::Option> option = command.syntax.find(std::string("--") + name);
      if (option) option->onGiven([&common, name] { common.messages.emplace_back(name); });
    }
  }
}

}  // namespace viewloom::cli
