// SPDX-License-Identifier: Apache-2.0
#include "config/toml_file.h"

#include <toml++/toml.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "base/printable.h"
#include "base/str_cat.h"
#include "config/read_config.h"

namespace viewloom {
namespace {

constexpr uint64_t kBytesMax = uint64_t{1} << 20;

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

ConfigError unreadable(const std::string& path, const std::string& problem) {
  return ConfigError(strCat("--config ", printable(path), ": ", problem,
                            "; name a settings file, as deploy/viewloomd.example.toml is one"));
}

// The whole file, looked at before it is opened: a pipe would be waited for.
std::string readText(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw unreadable(path, "there is no such file");
  if (std::filesystem::is_directory(status)) throw unreadable(path, "is a folder, not a file");
  if (!std::filesystem::is_regular_file(status)) throw unreadable(path, "is no regular file");
  const uint64_t size = std::filesystem::file_size(path, error);
  if (!error && size > kBytesMax) {
    throw unreadable(path, strCat("has ", size, " bytes; accepted are up to ", kBytesMax));
  }
  std::ifstream in(path, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (!in.is_open() || in.bad()) throw unreadable(path, "cannot be read; may you read it?");
  if (text.find('\0') != std::string::npos) throw unreadable(path, "is no text");
  return text;
}

}  // namespace

std::vector<TomlEntry> readTomlFile(const std::string& path) {
  const std::string text = readText(path);
  try {
    std::vector<TomlEntry> entries;
    flatten(toml::parse(text, path), "", path, entries);
    return entries;
  } catch (const toml::parse_error& error) {
    throw ConfigError(strCat(placeOf(path, error.source()), ": ",
                             printable({error.description().data(), error.description().size()})));
  }
}

}  // namespace viewloom
