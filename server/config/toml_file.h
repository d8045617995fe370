// SPDX-License-Identifier: Apache-2.0
// The values of a TOML file, flat.
#pragma once

#include <string>
#include <vector>

#include "config/settings.h"

namespace viewloom {

struct TomlEntry {
  std::string key;  // tables joined by '.': "grpc.address"
  SettingValue value;
  std::string place;  // "viewloomd.toml:12"
};

// Throws ConfigError when the file cannot be read, is not TOML, or holds a value of a type that no
// setting has.
std::vector<TomlEntry> readTomlFile(const std::string& path);

}  // namespace viewloom
