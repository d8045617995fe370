// SPDX-License-Identifier: Apache-2.0
// Reads the settings: defaults, then a TOML file, then the environment, then flags; and offers them
// as flags of a command line.
#pragma once

#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/config.h"
#include "usage/command_line.h"

namespace viewloom {

// A setting that is unknown or not accepted. what() is one line: the key, where it stands, what
// came, what is accepted or meant.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ConfigSources {
  std::optional<std::string> file;  // path of a TOML file
  // Environment variables whose name is VIEWLOOM_ and the key in capitals with '_' for '.':
  // VIEWLOOM_GRPC_ADDRESS.
  std::map<std::string, std::string> environment{};
  std::map<std::string, std::string> flags{};  // key to text: "grpc.address" to "0.0.0.0:50051"
};

// Adds --config and settings: --grpc.address, --device and so on, those whose key begins with one
// of `beginnings`, or all. What the command line names lands in `sources`, which must live until it
// is parsed.
void addSettingOptions(const usage::Command& command, ConfigSources& sources,
                       const std::vector<std::string>& beginnings = {""});

// Throws ConfigError.
Config readConfig(const ConfigSources& sources);

// The environment of this process.
std::map<std::string, std::string> processEnvironment();

}  // namespace viewloom
