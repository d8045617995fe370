// SPDX-License-Identifier: Apache-2.0
#include "containment/refused_calls.h"

#include <seccomp.h>
#include <signal.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <string_view>

namespace viewloom {
namespace {

// More than any architecture has calls.
constexpr size_t kCallCount = 512;
constexpr size_t kNameBytes = 32;

// A handler of signals may neither take memory nor look names up, so they are looked up before.
std::array<std::array<char, kNameBytes>, kCallCount> call_names;
std::array<std::atomic<bool>, kCallCount> is_told;

// A line that is put together without memory of the heap.
class Line {
 public:
  void add(std::string_view text) {
    for (const char c : text) {
      if (length_ < bytes_.size()) bytes_[length_++] = c;
    }
  }
  void add(int number) {
    const auto [end, error] =
        std::to_chars(bytes_.data() + length_, bytes_.data() + bytes_.size(), number);
    if (error == std::errc()) length_ = static_cast<size_t>(end - bytes_.data());
  }
  void write() const {
    // There is nobody to tell that standard error is closed.
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, bytes_.data(), length_);
  }

 private:
  std::array<char, 160> bytes_{};
  size_t length_ = 0;
};

void tell(int number) {
  const auto index = static_cast<size_t>(number);
  const bool has_name = index < kCallCount;
  if (has_name && is_told[index].exchange(true)) return;
  Line line;
  line.add("viewloomd: containment refused the system call ");
  if (has_name) line.add(call_names[index].data());
  line.add(" (number ");
  line.add(number);
  line.add("), and will go on to do so\n");
  line.write();
}

void setResult(void* context, int result) {
  auto* const thread = static_cast<ucontext_t*>(context);
#if defined(__x86_64__)
  thread->uc_mcontext.gregs[REG_RAX] = result;
#elif defined(__aarch64__)
  thread->uc_mcontext.regs[0] = static_cast<uint64_t>(static_cast<int64_t>(result));
#else
#error "say where this architecture returns the result of a system call"
#endif
}

void answer(int, siginfo_t* info, void* context) {
  const int before = errno;
  tell(info->si_syscall);
  setResult(context, -EPERM);
  errno = before;
}

}  // namespace

void answerRefusedCalls() {
  for (size_t i = 0; i < kCallCount; ++i) {
    char* const name = seccomp_syscall_resolve_num_arch(SCMP_ARCH_NATIVE, static_cast<int>(i));
    if (name == nullptr) continue;
    const std::string_view text(name);
    text.copy(call_names[i].data(), kNameBytes - 1);
    std::free(name);
  }
  struct sigaction action {};
  action.sa_sigaction = answer;
  action.sa_flags = SA_SIGINFO | SA_RESTART;
  sigaction(SIGSYS, &action, nullptr);
}

}  // namespace viewloom
