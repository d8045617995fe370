// SPDX-License-Identifier: Apache-2.0
#include "config/setting_options.h"

#include <algorithm>

#include "config/settings.h"

namespace viewloom {

void addSettingOptions(const usage::Command& command, ConfigSources& sources,
                       const std::vector<std::string>& beginnings) {
  command.addTaken(
      "--config", [&sources](const std::string& file) { sources.file = file; },
      "Settings as TOML; see deploy/viewloomd.example.toml");
  Config defaults;
  for (const Setting& setting : settingsOf(defaults)) {
    const std::string key(setting.key);
    const bool is_wanted = std::ranges::any_of(
        beginnings, [&](const std::string& beginning) { return key.starts_with(beginning); });
    if (!is_wanted) continue;
    command
        .addTaken(
            "--" + key, [&sources, key](const std::string& text) { sources.flags[key] = text; },
            acceptedText(setting))
        .group("Settings");
  }
}

}  // namespace viewloom
