// SPDX-License-Identifier: Apache-2.0
// One line on stderr that says how it goes: rewritten in place on a terminal, seldom elsewhere. All
// text is printed without the control characters in it: names may come from anybody.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace viewloom::cli {

// Thread-safety: all methods may be called from any thread.
class StatusLine {
 public:
  explicit StatusLine(bool is_quiet);
  // Leaves the last status standing.
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  // Whether it is time for a new status: twice a second on a terminal, every 10 s elsewhere.
  bool isDue() const;
  void show(const std::string& status);
  // A line of its own that stays, above the status.
  void say(const std::string& line);
  // A line of results, on stdout.
  void print(const std::string& line);

 private:
  void write(const std::string& text);

  const bool is_quiet_;
  const bool is_terminal_;
  mutable std::mutex mutex_;
  std::chrono::steady_clock::time_point shown_at_ = std::chrono::steady_clock::now();
  bool line_is_open_ = false;
};

// Events per second since the last reading.
class RateMeter {
 public:
  double perSecond(uint64_t count_now);

 private:
  std::chrono::steady_clock::time_point read_at_ = std::chrono::steady_clock::now();
  uint64_t count_ = 0;
};

// "12.3 MB", "850 kB".
std::string formatBytes(double bytes);
// A number with so many digits after the point.
std::string formatNumber(double value, int digits);

}  // namespace viewloom::cli
