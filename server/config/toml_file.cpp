// SPDX-License-Identifier: Apache-2.0
#include "config/toml_file.h"

#include <toml++/toml.h>

#include "base/str_cat.h"
#include "config/read_config.h"

namespace viewloom {
namespace {

std::string placeOf(const std::string& path, const toml::source_region& region) {
  return strCat(path, ":", region.begin.line);
}

SettingValue valueOf(const std::string& key, const toml::node& node, const std::string& place) {
  if (const auto* value = node.as_boolean()) return value->get();
  if (const auto* value = node.as_integer()) return value->get();
  if (const auto* value = node.as_floating_point()) return value->get();
  if (const auto* value = node.as_string()) return value->get();
  throw ConfigError(strCat(place, ": ", key, " must be one value, not a list or a date"));
}

void flatten(const toml::table& table, const std::string& prefix, const std::string& path,
             std::vector<TomlEntry>& entries) {
  for (const auto& [name, node] : table) {
    const std::string key = strCat(prefix, name.str());
    if (const toml::table* inner = node.as_table()) {
      flatten(*inner, key + ".", path, entries);
      continue;
    }
    const std::string place = placeOf(path, node.source());
    entries.push_back({key, valueOf(key, node, place), place});
  }
}

}  // namespace

std::vector<TomlEntry> readTomlFile(const std::string& path) {
  try {
    std::vector<TomlEntry> entries;
    flatten(toml::parse_file(path), "", path, entries);
    return entries;
  } catch (const toml::parse_error& error) {
    throw ConfigError(strCat(placeOf(path, error.source()), ": ", error.description()));
  }
}

}  // namespace viewloom
