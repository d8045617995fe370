// SPDX-License-Identifier: Apache-2.0
// The subcommands of `viewloom`.
#pragma once

#include <vector>

#include "cli/command.h"
#include "usage/command_line.h"

namespace viewloom::cli {

// Adds them all, with what each runs.
std::vector<NamedCommand> addCommands(const usage::Command& app);

// Has `common` say which messages the command line gives as JSON. Before it is parsed.
void noteMessages(const std::vector<NamedCommand>& commands, CommonOptions& common);

// One each: adds its options, and returns what runs after they are parsed.

// Says which source would serve a display of a scene between two depths.
RunCommand addAdviseCommand(const usage::Command& app);
// Has Looking Glass Bridge show a stream's quilt.
RunCommand addCastCommand(const usage::Command& app);
// Says what files hold, how they are read, and what looks wrong. Needs no server.
RunCommand addInspectCommand(const usage::Command& app);
// Lists what a server has.
RunCommand addListCommand(const usage::Command& app);
// Sends the synthetic scene, test patterns, files or manifests as a stream.
RunCommand addPublishCommand(const usage::Command& app);
// Keeps the atlases of a stream in a file.
RunCommand addRecordCommand(const usage::Command& app);
// Shows a stream on a light-field panel, or in a window.
RunCommand addShowCommand(const usage::Command& app);
// Receives atlases of a stream, writes them, and says how it goes.
RunCommand addWatchCommand(const usage::Command& app);

}  // namespace viewloom::cli
