// SPDX-License-Identifier: Apache-2.0
// One setting: its key, what it means, its unit, what it accepts, and where its value lives.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

namespace viewloom {

struct BoolSetting {
  bool* value;
  bool is_switch = false;  // its flag stands alone and means true
};

struct CountSetting {
  std::variant<uint32_t*, uint64_t*> value;
  uint64_t min;
  uint64_t max;
};

struct TextSetting {
  enum class Form : uint8_t {
    kAny,
    kFile,
    kHostPort,
    kGrpcAddress,
    kHostNames,
    kOrigins,
    kPaths,
    kLogLevel
  };
  std::string* value;
  Form form = Form::kAny;
};

struct Setting {
  std::string_view key;   // "limits.frame_bytes_max"
  std::string_view unit;  // "" = none
  std::string_view help;  // for --help: what it sets, in words of users
  std::variant<BoolSetting, CountSetting, TextSetting> target;
};

// A value as a file (typed) or an environment variable or flag (always text) gives it.
using SettingValue = std::variant<bool, int64_t, double, std::string>;

// Accepted values in words: "1..8192 px", "true or false".
std::string acceptedText(const Setting& setting);
// Its description in --help, and the name of its value there: "PIXELS".
std::string helpText(const Setting& setting);
std::string valueName(const Setting& setting);
// The current value as TOML writes it.
std::string valueText(const Setting& setting);

// False when the value is not accepted; the config is then unchanged. Text is read as the type that
// the setting has when `from_text`; otherwise the types must agree.
bool assign(const Setting& setting, const SettingValue& value, bool from_text);

}  // namespace viewloom
