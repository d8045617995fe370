// SPDX-License-Identifier: Apache-2.0
#include "config/read_config.h"

#include <unistd.h>

#include <algorithm>
#include <string_view>

#include "base/nearest_name.h"
#include "base/processor_count.h"
#include "base/str_cat.h"
#include "config/settings.h"
#include "config/toml_file.h"

namespace viewloom {
namespace {

constexpr std::string_view kEnvironmentPrefix = "VIEWLOOM_";

std::string environmentName(std::string_view key) {
  std::string name(kEnvironmentPrefix);
  for (const char c : key) {
    const bool lower = c >= 'a' && c <= 'z';
    name += c == '.' ? '_' : lower ? static_cast<char>(c - 'a' + 'A') : c;
  }
  return name;
}

std::string textOf(const SettingValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* text = std::get_if<std::string>(&value)) return strCat("\"", *text, "\"");
  if (const auto* number = std::get_if<int64_t>(&value)) return strCat(*number);
  return strCat(std::get<double>(value));
}

// Puts values into one config and words what does not fit.
class ConfigReader {
 public:
  explicit ConfigReader(Config& config) : settings_(settingsOf(config)) {}

  void readFile(const std::string& path) const {
    for (const TomlEntry& entry : readTomlFile(path)) {
      set(find(entry.key, entry.place), entry.value, false, entry.place, entry.key);
    }
  }

  void readFlags(const std::map<std::string, std::string>& flags) const {
    for (const auto& [key, text] : flags) {
      set(find(key, "command line"), text, true, "command line", key);
    }
  }

  // A variable of a section that exists must be a setting; other VIEWLOOM_ variables are not ours.
  void readEnvironment(const std::map<std::string, std::string>& environment) const {
    for (const auto& [name, text] : environment) {
      if (!name.starts_with(kEnvironmentPrefix)) continue;
      const auto named = std::ranges::find(
          settings_, name, [](const Setting& setting) { return environmentName(setting.key); });
      if (named != settings_.end()) {
        set(*named, text, true, "environment", name);
      } else if (isOfSection(name)) {
        throw unknown(name, "environment", names(environmentName));
      }
    }
  }

 private:
  template <typename NameOf>
  std::vector<std::string> names(NameOf name_of) const {
    std::vector<std::string> names;
    for (const Setting& setting : settings_) names.push_back(name_of(setting.key));
    return names;
  }

  bool isOfSection(std::string_view name) const {
    return std::any_of(settings_.begin(), settings_.end(), [&](const Setting& setting) {
      const size_t dot = setting.key.find('.');
      return dot != std::string_view::npos &&
             name.starts_with(environmentName(setting.key.substr(0, dot + 1)));
    });
  }

  const Setting& find(const std::string& key, const std::string& place) const {
    for (const Setting& setting : settings_) {
      if (setting.key == key) return setting;
    }
    throw unknown(key, place, names([](std::string_view k) { return std::string(k); }));
  }

  static ConfigError unknown(const std::string& name, const std::string& place,
                             const std::vector<std::string>& known) {
    const std::string meant = didYouMean(name, known);
    return ConfigError(strCat(place, ": ", name, " is no setting; ",
                              meant.empty() ? "viewloomd.example.toml lists all settings" : meant));
  }

  static void set(const Setting& setting, const SettingValue& value, bool from_text,
                  const std::string& place, const std::string& name) {
    if (assign(setting, value, from_text)) return;
    throw ConfigError(
        strCat(place, ": ", name, " is ", textOf(value), ", must be ", acceptedText(setting)));
  }

  std::vector<Setting> settings_;
};

}  // namespace

void addSettingOptions(const usage::Command& command, ConfigSources& sources,
                       const std::vector<std::string>& beginnings) {
  command
      .addTaken(
          "--config", [&sources](const std::string& file) { sources.file = file; },
          "Settings file in TOML; deploy/viewloomd.example.toml explains each setting")
      .valueName("FILE")
      .defaultText("no file");
  Config defaults;
  for (const Setting& setting : settingsOf(defaults)) {
    const std::string key(setting.key);
    const bool is_wanted = std::ranges::any_of(
        beginnings, [&](const std::string& beginning) { return key.starts_with(beginning); });
    if (!is_wanted) continue;
    const auto* toggle = std::get_if<BoolSetting>(&setting.target);
    if (toggle != nullptr && toggle->is_switch) {
      command
          .addAction(
              "--" + key, [&sources, key] { sources.flags[key] = "true"; }, helpText(setting))
          .group("Settings");
      continue;
    }
    command
        .addTaken(
            "--" + key, [&sources, key](const std::string& text) { sources.flags[key] = text; },
            helpText(setting))
        .valueName(valueName(setting))
        .defaultText(valueText(setting))
        .group("Settings");
  }
}

Config readConfig(const ConfigSources& sources) {
  Config config;
  const ConfigReader reader(config);
  if (sources.file) reader.readFile(*sources.file);
  reader.readEnvironment(sources.environment);
  reader.readFlags(sources.flags);
  return config;
}

std::map<std::string, std::string> processEnvironment() {
  std::map<std::string, std::string> variables;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text(*entry);
    const size_t equals = text.find('=');
    if (equals == std::string_view::npos) continue;
    variables.emplace(text.substr(0, equals), text.substr(equals + 1));
  }
  return variables;
}

uint32_t threadCount(uint32_t setting) {
  return setting != 0 ? setting : std::min(processorCount(), 8U);
}

}  // namespace viewloom
