// SPDX-License-Identifier: Apache-2.0
#include "cli/status_line.h"

#include <unistd.h>

#include <cstdio>
#include <utility>

#include "base/printable.h"

namespace viewloom::cli {

StatusLine::StatusLine(bool is_quiet) : is_quiet_(is_quiet), is_terminal_(isatty(STDERR_FILENO)) {}

StatusLine::~StatusLine() {
  if (line_is_open_) write("\n");
}

bool StatusLine::isDue() const {
  std::lock_guard lock(mutex_);
  const auto interval = is_terminal_ ? std::chrono::milliseconds(500) : std::chrono::seconds(10);
  return !is_quiet_ && std::chrono::steady_clock::now() - shown_at_ >= interval;
}

void StatusLine::show(const std::string& status) {
  std::lock_guard lock(mutex_);
  shown_at_ = std::chrono::steady_clock::now();
  if (is_quiet_) return;
  write(is_terminal_ ? "\r\033[K" + printable(status) : printable(status) + "\n");
  line_is_open_ = is_terminal_;
}

void StatusLine::say(const std::string& line) {
  std::lock_guard lock(mutex_);
  write((line_is_open_ ? "\r\033[K" : "") + printable(line) + "\n");
  line_is_open_ = false;
}

void StatusLine::print(const std::string& line) {
  std::lock_guard lock(mutex_);
  if (std::exchange(line_is_open_, false)) write("\r\033[K");
  std::printf("%s\n", printable(line).c_str());
  std::fflush(stdout);
}

void StatusLine::write(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

double RateMeter::perSecond(uint64_t count_now) {
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - read_at_).count();
  const auto events = static_cast<double>(count_now - count_);
  read_at_ = now;
  count_ = count_now;
  return seconds > 0 ? events / seconds : 0;
}

std::string formatNumber(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f", digits, value);
  return text;
}

std::string formatBytes(double bytes) {
  if (bytes >= 1e9) return formatNumber(bytes / 1e9, 2) + " GB";
  if (bytes >= 1e6) return formatNumber(bytes / 1e6, 1) + " MB";
  return formatNumber(bytes / 1e3, 0) + " kB";
}

}  // namespace viewloom::cli
