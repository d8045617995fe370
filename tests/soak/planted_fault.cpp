// SPDX-License-Identifier: Apache-2.0
// Preloaded into a server: each connection that it accepts loses something. VIEWLOOM_PLANTED says
// what: "heap:BYTES", "descriptor" or "thread".
#include <dlfcn.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <thread>

namespace {

// Kept from the optimiser.
void* volatile lost_block = nullptr;

void lose(int connection) {
  const char* const planted = std::getenv("VIEWLOOM_PLANTED");
  if (planted == nullptr || connection < 0) return;
  const std::string_view fault(planted);
  constexpr std::string_view kHeap = "heap:";
  if (fault.starts_with(kHeap)) {
    const auto count = static_cast<size_t>(std::atol(planted + kHeap.size()));
    lost_block = std::malloc(count);
    if (lost_block != nullptr) std::memset(lost_block, 1, count);
  } else if (fault == "descriptor") {
    if (eventfd(0, EFD_CLOEXEC) < 0) std::abort();
  } else if (fault == "thread") {
    std::thread([] { std::this_thread::sleep_for(std::chrono::hours(24)); }).detach();
  }
}

}  // namespace

extern "C" {

int accept(int listener, sockaddr* address, socklen_t* size) {
  static const auto next = reinterpret_cast<decltype(&accept)>(dlsym(RTLD_NEXT, "accept"));
  const int connection = next(listener, address, size);
  lose(connection);
  return connection;
}

int accept4(int listener, sockaddr* address, socklen_t* size, int flags) {
  static const auto next = reinterpret_cast<decltype(&accept4)>(dlsym(RTLD_NEXT, "accept4"));
  const int connection = next(listener, address, size, flags);
  lose(connection);
  return connection;
}
}
