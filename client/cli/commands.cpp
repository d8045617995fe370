// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"

namespace viewloom::cli {

std::vector<NamedCommand> addCommands(const usage::Command& app) {
  std::vector<NamedCommand> commands;
  const auto add = [&](const char* name, const char* description, auto add_command) {
    const usage::Command command = app.addCommand(name, description);
    commands.push_back({command, add_command(command)});
  };
  add("publish",
      "Send the synthetic scene, a test pattern, image files, manifests or a recording as a stream",
      addPublishCommand);
  add("inspect", "Say what files hold, how they are read, what is wrong", addInspectCommand);
  add("watch", "Receive atlases of a stream, write them, see how fast they come", addWatchCommand);
  add("show", "Show a stream on a light-field panel, or in a window", addShowCommand);
  add("record", "Keep the atlases of a stream in a file", addRecordCommand);
  add("advise", "Say which source would serve a display of a scene", addAdviseCommand);
  add("list", "Show the streams, displays and presets of a server", addListCommand);
  add("cast", "Have Looking Glass Bridge show a stream", addCastCommand);
  return commands;
}

}  // namespace viewloom::cli
