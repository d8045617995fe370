// SPDX-License-Identifier: Apache-2.0
#include "access/utc_time.h"

#include <array>
#include <chrono>
#include <ctime>

namespace viewloom {
namespace {

constexpr const char* kForm = "%Y-%m-%dT%H:%M:%SZ";

}  // namespace

int64_t systemSeconds() {
  const auto since = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::seconds>(since).count();
}

std::string utcText(int64_t seconds) {
  const std::time_t time = seconds;
  std::tm parts{};
  std::array<char, 64> text{};
  if (gmtime_r(&time, &parts) == nullptr) return "?";
  const size_t length = std::strftime(text.data(), text.size(), kForm, &parts);
  return {text.data(), length};
}

std::optional<int64_t> secondsFromUtc(std::string_view text) {
  const std::string whole = std::string(text) + (text.size() == 10 ? "T00:00:00Z" : "");
  std::tm parts{};
  const char* const end = strptime(whole.c_str(), kForm, &parts);
  if (end == nullptr || *end != '\0') return std::nullopt;
  const int64_t seconds = timegm(&parts);
  // The 31st of February becomes another day.
  if (utcText(seconds) != whole) return std::nullopt;
  return seconds;
}

}  // namespace viewloom
