// SPDX-License-Identifier: Apache-2.0
#include "load/process_usage.h"

#include <unistd.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace viewloom::load {
namespace {

// Fields of /proc/PID/stat behind the program's name, which may hold anything up to the last ')'.
// Their count starts at 3 in proc(5).
constexpr size_t kFirstField = 3;
constexpr size_t kUserTimeField = 14;
constexpr size_t kSystemTimeField = 15;
constexpr size_t kResidentPagesField = 24;

}  // namespace

ProcessUsage usageOf(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) {
    throw std::runtime_error("process " + std::to_string(process) + " is gone");
  }
  std::istringstream rest(text.substr(name_end + 1));
  const std::vector<std::string> fields{std::istream_iterator<std::string>(rest), {}};
  const auto field = [&fields](size_t number) {
    return std::stoll(fields.at(number - kFirstField));
  };
  const int64_t ticks = field(kUserTimeField) + field(kSystemTimeField);
  return {.resident_bytes = static_cast<uint64_t>(field(kResidentPagesField)) *
                            static_cast<uint64_t>(sysconf(_SC_PAGESIZE)),
          .cpu_ns = ticks * (1'000'000'000 / sysconf(_SC_CLK_TCK))};
}

}  // namespace viewloom::load
