// SPDX-License-Identifier: Apache-2.0
// Where the server of a command is, and how the two know each other.
#pragma once

#include <memory>
#include <optional>

#include "cli/command.h"
#include "usage/command_line.h"

namespace grpc {
class Channel;
}  // namespace grpc

namespace viewloom::cli {

// Adds --server, the options of its encryption and --token-file. Sets `common` to their defaults:
// the server of this machine, and the token of the environment. `common` must live until the
// command line is parsed.
void addServerOptions(const usage::Command& app, CommonOptions& common);

// Reads the files that the options name, once they are parsed. Nothing when all is right; else the
// exit code, after an error was printed.
std::optional<int> readServerOptions(CommonOptions& common);

// A channel to the server; it does not connect yet.
std::shared_ptr<grpc::Channel> channelTo(const CommonOptions& common);

}  // namespace viewloom::cli
