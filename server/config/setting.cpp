// SPDX-License-Identifier: Apache-2.0
#include "config/setting.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <vector>

#include "absl/strings/str_split.h"
#include "base/host_port.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr std::array<std::string_view, 6> kLogLevels{"trace", "debug", "info",
                                                     "warn",  "error", "off"};

std::optional<uint64_t> parseCount(std::string_view text) {
  uint64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

std::optional<bool> parseBool(std::string_view text) {
  if (text == "true") return true;
  if (text == "false") return false;
  return std::nullopt;
}

// "127.0.0.1:8080", "[::1]:8080", "localhost:0".
bool isHostPort(std::string_view text) {
  const std::optional<HostPort> parsed = parseHostPort(text);
  return parsed && parsed->port;
}

bool isOfHostNames(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
         c == '-' || c == ',';
}

// "https://studio.example", "http://10.0.0.7:3000": scheme and host, as browsers send them.
bool isOrigin(std::string_view text) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (!text.starts_with(scheme)) continue;
    const std::string_view host = text.substr(scheme.size());
    return host.find_first_of("/?#@ ") == std::string_view::npos && parseHostPort(host);
  }
  return false;
}

bool areOrigins(std::string_view list) {
  while (!list.empty()) {
    const std::string_view origin = list.substr(0, list.find(','));
    if (!isOrigin(origin)) return false;
    list.remove_prefix(std::min(origin.size() + 1, list.size()));
  }
  return true;
}

bool areAbsolutePaths(const std::string& text) {
  const std::vector<std::string> paths = absl::StrSplit(text, ',', absl::SkipEmpty());
  return std::ranges::all_of(paths, [](const std::string& path) { return path.starts_with('/'); });
}

bool fits(TextSetting::Form form, std::string_view text) {
  switch (form) {
    case TextSetting::Form::kAny:
    case TextSetting::Form::kFile:
      return true;
    case TextSetting::Form::kHostPort:
      return isHostPort(text);
    case TextSetting::Form::kGrpcAddress:
      return isHostPort(text) || (text.starts_with("unix:") && text.size() > 5);
    case TextSetting::Form::kHostNames:
      return std::all_of(text.begin(), text.end(), isOfHostNames);
    case TextSetting::Form::kOrigins:
      return areOrigins(text);
    case TextSetting::Form::kPaths:
      return areAbsolutePaths(std::string(text));
    case TextSetting::Form::kLogLevel:
      return std::find(kLogLevels.begin(), kLogLevels.end(), text) != kLogLevels.end();
  }
  return false;
}

std::optional<bool> boolOf(const SettingValue& value, bool from_text) {
  if (from_text) return parseBool(std::get<std::string>(value));
  const bool* typed = std::get_if<bool>(&value);
  return typed ? std::optional(*typed) : std::nullopt;
}

std::optional<uint64_t> countOf(const SettingValue& value, bool from_text) {
  if (from_text) return parseCount(std::get<std::string>(value));
  const int64_t* typed = std::get_if<int64_t>(&value);
  return typed && *typed >= 0 ? std::optional(static_cast<uint64_t>(*typed)) : std::nullopt;
}

struct Assign {
  const SettingValue& value;
  bool from_text;

  bool operator()(const BoolSetting& setting) const {
    const std::optional<bool> parsed = boolOf(value, from_text);
    if (parsed) *setting.value = *parsed;
    return parsed.has_value();
  }
  bool operator()(const CountSetting& setting) const {
    const std::optional<uint64_t> parsed = countOf(value, from_text);
    if (!parsed || *parsed < setting.min || *parsed > setting.max) return false;
    std::visit(
        [&](auto* count) {
          *count = static_cast<std::remove_reference_t<decltype(*count)>>(*parsed);
        },
        setting.value);
    return true;
  }
  bool operator()(const TextSetting& setting) const {
    const std::string* text = std::get_if<std::string>(&value);
    if (!text || !fits(setting.form, *text)) return false;
    *setting.value = *text;
    return true;
  }
};

}  // namespace

std::string acceptedText(const Setting& setting) {
  if (std::holds_alternative<BoolSetting>(setting.target)) return "true or false";
  if (const auto* count = std::get_if<CountSetting>(&setting.target)) {
    return strCat(count->min, "..", count->max, setting.unit.empty() ? "" : " ", setting.unit);
  }
  switch (std::get<TextSetting>(setting.target).form) {
    case TextSetting::Form::kAny:
      return "any text";
    case TextSetting::Form::kFile:
      return "the path of a file";
    case TextSetting::Form::kHostPort:
      return "HOST:PORT";
    case TextSetting::Form::kGrpcAddress:
      return "HOST:PORT or unix:PATH";
    case TextSetting::Form::kHostNames:
      return "host names, separated by commas";
    case TextSetting::Form::kOrigins:
      return "addresses as https://HOST or http://HOST:PORT, separated by commas";
    case TextSetting::Form::kPaths:
      return "absolute paths, separated by commas";
    case TextSetting::Form::kLogLevel:
      return "trace, debug, info, warn, error or off";
  }
  return "";
}

std::string valueName(const Setting& setting) {
  if (std::holds_alternative<BoolSetting>(setting.target)) return "true|false";
  if (std::holds_alternative<CountSetting>(setting.target)) {
    if (setting.unit == "s") return "SECONDS";
    if (setting.unit == "px") return "PIXELS";
    return setting.unit == "bytes" ? "BYTES" : "N";
  }
  switch (std::get<TextSetting>(setting.target).form) {
    case TextSetting::Form::kAny:
      return "NAME";
    case TextSetting::Form::kFile:
      return "FILE";
    case TextSetting::Form::kHostPort:
      return "HOST:PORT";
    case TextSetting::Form::kGrpcAddress:
      return "HOST:PORT|unix:PATH";
    case TextSetting::Form::kHostNames:
      return "HOST,HOST";
    case TextSetting::Form::kOrigins:
      return "ORIGIN,ORIGIN";
    case TextSetting::Form::kPaths:
      return "PATH,PATH";
    case TextSetting::Form::kLogLevel:
      return "LEVEL";
  }
  return "";
}

std::string helpText(const Setting& setting) {
  if (const auto* count = std::get_if<CountSetting>(&setting.target)) {
    return strCat(setting.help, "; ", count->min, " to ", count->max);
  }
  const auto* text = std::get_if<TextSetting>(&setting.target);
  const bool is_level = text != nullptr && text->form == TextSetting::Form::kLogLevel;
  return is_level ? strCat(setting.help, ": ", acceptedText(setting)) : std::string(setting.help);
}

std::string valueText(const Setting& setting) {
  if (const auto* flag = std::get_if<BoolSetting>(&setting.target)) {
    return *flag->value ? "true" : "false";
  }
  if (const auto* count = std::get_if<CountSetting>(&setting.target)) {
    return std::visit([](const auto* value) { return strCat(*value); }, count->value);
  }
  return strCat("\"", *std::get<TextSetting>(setting.target).value, "\"");
}

bool assign(const Setting& setting, const SettingValue& value, bool from_text) {
  return std::visit(Assign{value, from_text}, setting.target);
}

}  // namespace viewloom
