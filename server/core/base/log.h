// SPDX-License-Identifier: Apache-2.0
// Log: lines on standard error with time and level. Only this file knows spdlog.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/str_cat.h"

namespace viewloom {

enum class LogLevel : uint8_t { kTrace, kDebug, kInfo, kWarning, kError, kOff };

// Level by its name: "trace", "debug", "info", "warn", "error", "off". Others mean kInfo.
LogLevel logLevelOf(std::string_view name);

// Sets the level. Lines below it are not written. Before the first call it is kInfo.
void setLogLevel(LogLevel level);
bool isLogged(LogLevel level);

// Writes one line. Thread-safety: may be called from any thread.
void writeLog(LogLevel level, const std::string& line);

// Writes the parts joined by strCat. They are not joined if the line is not written.
template <typename... Parts>
void log(LogLevel level, const Parts&... parts) {
  if (isLogged(level)) writeLog(level, strCat(parts...));
}

}  // namespace viewloom
