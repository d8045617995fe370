// SPDX-License-Identifier: Apache-2.0
// Options that name the server and show it an access token, and the channel that they mean.
#pragma once

#include <memory>

#include "cli/command.h"
#include "lib/channel.h"
#include "usage/command_line.h"

namespace viewloom::cli {

// Adds --server and --token-file. Sets `common` to their defaults: the server of this machine, and
// the token of the environment. `common` must live until the command line is parsed.
void addServerOptions(const usage::Command& app, CommonOptions& common);

// Does not connect yet.
std::shared_ptr<grpc::Channel> channelTo(const CommonOptions& common);

}  // namespace viewloom::cli
