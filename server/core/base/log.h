// SPDX-License-Identifier: Apache-2.0
// The log: lines on standard error with time and level. The one place that knows spdlog.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/str_cat.h"

namespace viewloom {

enum class LogLevel : uint8_t { kTrace, kDebug, kInfo, kWarning, kError, kOff };

// "trace", "debug", "info", "warn", "error", "off"; anything else is kInfo.
LogLevel logLevelOf(std::string_view name);

// Lines below the level are not written. Before the first call the level is kInfo.
void setLogLevel(LogLevel level);
bool isLogged(LogLevel level);

// One line. Thread-safety: may be called from any thread.
void writeLog(LogLevel level, const std::string& line);

// The parts, one after the other, as strCat joins them; not joined when the line is not written.
template <typename... Parts>
void log(LogLevel level, const Parts&... parts) {
  if (isLogged(level)) writeLog(level, strCat(parts...));
}

}  // namespace viewloom
