// SPDX-License-Identifier: Apache-2.0
#include "base/log.h"

#include <array>
#include <memory>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "base/printable.h"

namespace viewloom {
namespace {

constexpr std::array<std::string_view, 6> kNames{"trace", "debug", "info", "warn", "error", "off"};
constexpr std::array<spdlog::level::level_enum, 6> kSpdlogLevels{
    spdlog::level::trace, spdlog::level::debug, spdlog::level::info,
    spdlog::level::warn,  spdlog::level::err,   spdlog::level::off};

spdlog::level::level_enum spdlogLevel(LogLevel level) {
  return kSpdlogLevels.at(static_cast<size_t>(level));
}

spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> logger = [] {
    auto made = spdlog::stderr_color_mt("viewloom");
    made->set_pattern("%Y-%m-%dT%H:%M:%S.%e%z %^%l%$ %v");
    return made;
  }();
  return *logger;
}

}  // namespace

LogLevel logLevelOf(std::string_view name) {
  for (size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) return static_cast<LogLevel>(i);
  }
  return LogLevel::kInfo;
}

void setLogLevel(LogLevel level) {
  logger().set_level(spdlogLevel(level));
}

bool isLogged(LogLevel level) {
  return logger().should_log(spdlogLevel(level));
}

void writeLog(LogLevel level, const std::string& line) {
  logger().log(spdlogLevel(level), spdlog::string_view_t(printable(line)));
}

}  // namespace viewloom
