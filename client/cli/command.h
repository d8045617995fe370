// SPDX-License-Identifier: Apache-2.0
// Interface that the subcommands of `viewloom` share.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lib/credentials.h"
#include "usage/command_line.h"

namespace viewloom::cli {

enum ExitCode : int {
  kExitDone = 0,
  kExitFailed = 1,    // the server refused, a file could not be written
  kExitUsage = 2,     // the command line or an input file is wrong
  kExitNoServer = 3,  // nobody listens at the address
};

struct CommonOptions {
  std::string server;  // "host:port", "unix:path" or "https://host:port"
  TlsOptions tls;
  std::shared_ptr<grpc::ChannelCredentials> credentials;  // made of both
  std::string token = {};                                 // shown to the server; empty = none
  // Messages that were given as JSON, by their fields: "display", "encoding".
  std::vector<std::string> messages = {};
};

// A subcommand after its options are parsed; returns the exit code.
using RunCommand = std::function<int(const CommonOptions&)>;

struct NamedCommand {
  usage::Command syntax;
  RunCommand run;
  bool calls_server = true;  // that --server names; false: it reads the options of TLS by itself
};

}  // namespace viewloom::cli
