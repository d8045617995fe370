// SPDX-License-Identifier: Apache-2.0
// Each case filters the calls of a child of the test, as no filter can be taken away.
#include "containment/call_filter.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/personality.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/timex.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <functional>
#include <thread>

#include "support/loopback.h"

namespace viewloom::call_filter_test {
namespace {

// Filters the calls of a child, tells whether `holds`, and ends the child.
[[noreturn]] void whenFiltered(const std::function<bool()>& holds) {
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  const absl::Status filtered = refuseOtherCalls();
  if (!filtered.ok()) std::fprintf(stderr, "%s\n", filtered.ToString().c_str());
  _exit(filtered.ok() && holds() ? 0 : 1);
}

void expectFiltered(const std::function<bool()>& holds, const char* on_standard_error = "") {
  EXPECT_EXIT(whenFiltered(holds), testing::ExitedWithCode(0), on_standard_error);
}

bool isRefused(long result) {
  return result == -1 && errno == EPERM;
}

bool isSocketRefused(int family, int kind) {
  return isRefused(socket(family, kind, 0));
}

TEST(CallFilter, leavesStreamsToListenOn) {
  expectFiltered([] {
    const int tcp = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    return tcp >= 0 && listen(tcp, 1) == 0 && socket(AF_INET6, SOCK_STREAM, 0) >= 0 &&
           socket(AF_UNIX, SOCK_STREAM, 0) >= 0;
  });
}

TEST(CallFilter, refusesOtherKindsOfSockets) {
  expectFiltered([] {
    return isSocketRefused(AF_INET, SOCK_DGRAM) && isSocketRefused(AF_INET6, SOCK_RAW) &&
           isSocketRefused(AF_NETLINK, SOCK_RAW) && isSocketRefused(AF_PACKET, SOCK_RAW) &&
           isSocketRefused(AF_VSOCK, SOCK_STREAM) && isSocketRefused(AF_UNIX, SOCK_DGRAM) &&
           isRefused(socket(AF_INET, SOCK_STREAM, IPPROTO_MPTCP)) &&
           socket(AF_INET6, SOCK_STREAM, IPPROTO_TCP) >= 0;
  });
}

TEST(CallFilter, callsNobody) {
  expectFiltered([] {
    const sockaddr_in address = test::loopback(0);
    return isRefused(connect(socket(AF_INET, SOCK_STREAM, 0),
                             reinterpret_cast<const sockaddr*>(&address), sizeof address));
  });
}

// TCP Fast Open connects without a call of connect().
TEST(CallFilter, sendsOnlyToThoseWhoHaveConnected) {
  expectFiltered([] {
    const int listener = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address = test::loopback(0);
    socklen_t size = sizeof address;
    auto* const place = reinterpret_cast<sockaddr*>(&address);
    const bool listens = bind(listener, place, size) == 0 && listen(listener, 1) == 0 &&
                         getsockname(listener, place, &size) == 0;
    char letter = 'x';
    iovec bytes{.iov_base = &letter, .iov_len = 1};
    mmsghdr message{};
    message.msg_hdr.msg_name = place;
    message.msg_hdr.msg_namelen = size;
    message.msg_hdr.msg_iov = &bytes;
    message.msg_hdr.msg_iovlen = 1;
    const int tcp = socket(AF_INET, SOCK_STREAM, 0);
    return listens && isRefused(sendto(tcp, &letter, 1, MSG_FASTOPEN, place, size)) &&
           isRefused(sendmsg(tcp, &message.msg_hdr, MSG_FASTOPEN)) &&
           isRefused(sendmmsg(tcp, &message, 1, MSG_FASTOPEN));
  });
}

TEST(CallFilter, leavesPairsOfStreamsButNotOfDatagrams) {
  expectFiltered([] {
    int pair[2] = {-1, -1};
    return socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) == 0 &&
           send(pair[0], "x", 1, MSG_NOSIGNAL) == 1 &&
           isRefused(socketpair(AF_UNIX, SOCK_DGRAM, 0, pair));
  });
}

TEST(CallFilter, letsNoDescriptorSignalOthers) {
  expectFiltered([] {
    const int file = open("/dev/null", O_RDWR);
    constexpr unsigned long kHighBits = 1UL << 40;
    return fcntl(file, F_SETFL, O_NONBLOCK) == 0 && fcntl(file, F_DUPFD_CLOEXEC, 0) >= 0 &&
           isRefused(fcntl(file, F_SETOWN, getppid())) &&
           isRefused(syscall(SYS_fcntl, file, kHighBits | F_SETOWN, getppid()));
  });
}

TEST(CallFilter, endsAProcessThatStartsAProgram) {
  EXPECT_EXIT(whenFiltered([] {
                char* const words[] = {nullptr};
                execve("/bin/true", words, words);
                return false;
              }),
              testing::KilledBySignal(SIGSYS), "");
}

TEST(CallFilter, endsAProcessThatLooksIntoAnother) {
  EXPECT_EXIT(whenFiltered([] {
                syscall(SYS_ptrace, 0, 0, 0, 0);
                return false;
              }),
              testing::KilledBySignal(SIGSYS), "");
}

TEST(CallFilter, leavesThreadsButNoProcesses) {
  expectFiltered([] {
    bool has_run = false;
    std::thread([&has_run] { has_run = true; }).join();
    return has_run && isRefused(fork());
  });
}

// Kernels are compiled to machine code within the process.
TEST(CallFilter, leavesCodeThatIsMade) {
  expectFiltered([] {
    const size_t size = static_cast<size_t>(sysconf(_SC_PAGESIZE));
    void* const page =
        mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return page != MAP_FAILED && mprotect(page, size, PROT_READ | PROT_EXEC) == 0;
  });
}

TEST(CallFilter, leavesDriversTheirControlsButNotTheKeyboard) {
  expectFiltered([] {
    char letter = 'x';
    constexpr unsigned long kHighBits = 1UL << 40;
    // No device stands behind this descriptor, so a control that is allowed answers ENOTTY.
    const int file = open("/dev/null", O_RDWR);
    const bool is_driver_allowed = ioctl(file, _IO('d', 0), &letter) == -1 && errno == ENOTTY;
    return is_driver_allowed && isRefused(ioctl(file, TIOCSTI, &letter)) &&
           isRefused(syscall(SYS_ioctl, file, kHighBits | TIOCSTI, &letter));
  });
}

TEST(CallFilter, readsLimitsWithoutSettingThem) {
  expectFiltered([] {
    rlimit files{};
    return getrlimit(RLIMIT_NOFILE, &files) == 0 && isRefused(setrlimit(RLIMIT_NOFILE, &files));
  });
}

TEST(CallFilter, signalsOnlyTheProcessItself) {
  expectFiltered([] { return kill(getpid(), 0) == 0 && isRefused(kill(getppid(), 0)); });
}

TEST(CallFilter, letsLibrariesDoWithoutNewCalls) {
  expectFiltered([] { return syscall(SYS_clone3, nullptr, 0) == -1 && errno == ENOSYS; });
}

TEST(CallFilter, namesTheCallThatItRefusesOnce) {
  expectFiltered(
      [] {
        const bool is_first_refused = isRefused(personality(PER_LINUX));
        return is_first_refused && isRefused(personality(PER_LINUX));
      },
      "^viewloomd: containment refused the system call personality \\(number [0-9]+\\), and will "
      "go on to do so\n$");
}

TEST(CallFilter, holdsInThreadsThatRunAlready) {
  EXPECT_EXIT(
      {
        std::atomic<bool> is_filtered = false;
        std::atomic<bool> is_refused = false;
        std::thread earlier([&] {
          is_filtered.wait(false);
          is_refused = isSocketRefused(AF_NETLINK, SOCK_RAW);
        });
        whenFiltered([&] {
          is_filtered = true;
          is_filtered.notify_all();
          earlier.join();
          return is_refused.load();
        });
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace viewloom::call_filter_test
