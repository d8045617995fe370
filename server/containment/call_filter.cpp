// SPDX-License-Identifier: Apache-2.0
#include "containment/call_filter.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <sched.h>
#include <seccomp.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <initializer_list>
#include <memory>

#include "base/str_cat.h"
#include "containment/call_lists.h"
#include "containment/refused_calls.h"

namespace viewloom {
namespace {

constexpr uint64_t kLow32 = 0xffffffff;

constexpr uint64_t kNewNamespaces = CLONE_NEWNS | CLONE_NEWCGROUP | CLONE_NEWUTS | CLONE_NEWIPC |
                                    CLONE_NEWUSER | CLONE_NEWPID | CLONE_NEWNET;

// Kinds of ioctl by the letter that a driver has chosen: DRM, NVIDIA, AMD's compute devices, shared
// buffers, fences.
constexpr char kDriverLetters[] = {'d', 'F', 'K', 'b', '>'};
// NVIDIA's unified memory numbers its calls from 1 on, without a letter; two begin and end it.
constexpr uint64_t kUnifiedMemoryCalls[] = {0x30000001, 0x30000002};
constexpr uint64_t kPlainControls[] = {FIONREAD, FIONBIO, FIOCLEX, FIONCLEX, TCGETS, TIOCGWINSZ};

constexpr uint64_t kAskedProcessControls[] = {
    PR_SET_NAME,       PR_GET_NAME,     PR_GET_DUMPABLE,     PR_GET_SECCOMP,
    PR_SET_TIMERSLACK, PR_CAPBSET_READ, PR_GET_NO_NEW_PRIVS, PR_SET_VMA};

// Collects rules; the first error is kept, and what follows it does nothing.
class Filter {
 public:
  Filter() : context_(seccomp_init(SCMP_ACT_TRAP), seccomp_release) {
    if (context_ == nullptr) {
      error_ = -ENOMEM;
      return;
    }
    note(seccomp_attr_set(context_.get(), SCMP_FLTATR_CTL_TSYNC, 1));
    // Calls of another architecture would come past the list.
    note(seccomp_attr_set(context_.get(), SCMP_FLTATR_ACT_BADARCH, SCMP_ACT_KILL_PROCESS));
    // Some hundred rules are searched in few steps.
    note(seccomp_attr_set(context_.get(), SCMP_FLTATR_CTL_OPTIMIZE, 2));
  }

  void add(uint32_t action, const char* name, std::initializer_list<scmp_arg_cmp> arguments = {}) {
    const int number = seccomp_syscall_resolve_name(name);
    if (error_ != 0 || number < 0) return;  // below 0: not of this architecture
    note(seccomp_rule_add_array(context_.get(), action, number,
                                static_cast<unsigned>(arguments.size()), arguments.begin()));
  }

  absl::Status load() {
    if (error_ == 0) note(seccomp_load(context_.get()));
    if (error_ == 0) return absl::OkStatus();
    return absl::FailedPreconditionError(strCat("seccomp: ", std::strerror(-error_)));
  }

 private:
  void note(int result) {
    if (error_ == 0) error_ = result;
  }

  const std::unique_ptr<void, decltype(&seccomp_release)> context_;
  int error_ = 0;
};

// Argument `index` is `value` in the bits of `mask`.
scmp_arg_cmp argument(unsigned index, uint64_t value, uint64_t mask = kLow32) {
  return {.arg = index, .op = SCMP_CMP_MASKED_EQ, .datum_a = mask, .datum_b = value};
}

// Streams that others connect to, on the network or this machine. Other protocols are not bound to
// ports by landlock.
void addSockets(Filter& filter) {
  constexpr uint64_t kKind = 0xf;  // without SOCK_CLOEXEC and SOCK_NONBLOCK
  const scmp_arg_cmp is_stream = argument(1, SOCK_STREAM, kKind);
  for (const uint64_t family : {uint64_t{AF_INET}, uint64_t{AF_INET6}, uint64_t{AF_UNIX}}) {
    filter.add(SCMP_ACT_ALLOW, "socket", {argument(0, family), is_stream, argument(2, 0)});
  }
  for (const uint64_t family : {uint64_t{AF_INET}, uint64_t{AF_INET6}}) {
    filter.add(SCMP_ACT_ALLOW, "socket",
               {argument(0, family), is_stream, argument(2, IPPROTO_TCP)});
  }
  // Datagrams of a pair could go to any other socket.
  filter.add(SCMP_ACT_ALLOW, "socketpair", {argument(0, AF_UNIX), is_stream});
  // TCP Fast Open connects while it sends.
  const auto connects_not = [](unsigned flags) { return argument(flags, 0, MSG_FASTOPEN); };
  filter.add(SCMP_ACT_ALLOW, "sendto", {connects_not(3)});
  filter.add(SCMP_ACT_ALLOW, "sendmsg", {connects_not(2)});
  filter.add(SCMP_ACT_ALLOW, "sendmmsg", {connects_not(3)});
}

// All commands but those that name a process to be signalled, which lie between 7 and 32.
void addDescriptorCommands(Filter& filter) {
  constexpr uint64_t kOpenFileLocks = 32;
  constexpr uint64_t kOfLinux = 1024;
  filter.add(SCMP_ACT_ALLOW, "fcntl", {argument(1, 0, kLow32 & ~uint64_t{7})});
  for (const uint64_t bit : {kOpenFileLocks, kOfLinux}) {
    filter.add(SCMP_ACT_ALLOW, "fcntl", {argument(1, bit, bit)});
  }
}

void addThreads(Filter& filter) {
  filter.add(SCMP_ACT_ALLOW, "clone", {argument(0, CLONE_THREAD, CLONE_THREAD | kNewNamespaces)});
  // Limits may be read, not set: no new value comes with the call.
  filter.add(SCMP_ACT_ALLOW, "prlimit64", {argument(2, 0, ~uint64_t{0})});
  const auto self = static_cast<uint64_t>(getpid());
  filter.add(SCMP_ACT_ALLOW, "kill", {argument(0, self)});
  filter.add(SCMP_ACT_ALLOW, "tgkill", {argument(0, self)});
  filter.add(SCMP_ACT_ALLOW, "rt_tgsigqueueinfo", {argument(0, self)});
  for (const uint64_t control : kAskedProcessControls) {
    filter.add(SCMP_ACT_ALLOW, "prctl", {argument(0, control)});
  }
}

void addControls(Filter& filter) {
  for (const char letter : kDriverLetters) {
    filter.add(SCMP_ACT_ALLOW, "ioctl",
               {argument(1, static_cast<uint64_t>(static_cast<uint8_t>(letter)) << 8, 0xff00)});
  }
  filter.add(SCMP_ACT_ALLOW, "ioctl", {argument(1, 0, kLow32 & ~uint64_t{0xff})});
  for (const uint64_t control : kUnifiedMemoryCalls) {
    filter.add(SCMP_ACT_ALLOW, "ioctl", {argument(1, control)});
  }
  for (const uint64_t control : kPlainControls) {
    filter.add(SCMP_ACT_ALLOW, "ioctl", {argument(1, control)});
  }
}

}  // namespace

absl::Status refuseOtherCalls() {
  Filter filter;
  for (const char* name : kAllowedCalls) filter.add(SCMP_ACT_ALLOW, name);
  for (const char* name : kDeadlyCalls) filter.add(SCMP_ACT_KILL_PROCESS, name);
  for (const char* name : kMissingCalls) filter.add(SCMP_ACT_ERRNO(ENOSYS), name);
  addSockets(filter);
  addDescriptorCommands(filter);
  addThreads(filter);
  addControls(filter);
  answerRefusedCalls();
  return filter.load();
}

}  // namespace viewloom
