// SPDX-License-Identifier: Apache-2.0
#include "rpc/listening_sockets.h"

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <memory>
#include <optional>
#include <string_view>

#include "base/host_port.h"

namespace viewloom {
namespace {

constexpr std::string_view kUnixScheme = "unix:";

using AddressList = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

AddressList addressesOf(const HostPort& where) {
  addrinfo hints{};
  hints.ai_flags = AI_PASSIVE;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(where.host.c_str(), nullptr, &hints, &found) != 0) found = nullptr;
  return {found, freeaddrinfo};
}

// -1 when that cannot be; errno says why.
int listenOn(const sockaddr* address, socklen_t size) {
  const int fd = socket(address->sa_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return -1;
  const int on = 1;
  const int off = 0;
  // Without SO_REUSEPORT: a second server would silently take half of the clients.
  setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (address->sa_family == AF_INET6) {
    setsockopt(fd, IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof off);
  }
  if (bind(fd, address, size) == 0 && listen(fd, SOMAXCONN) == 0) return fd;
  const int error = errno;
  close(fd);
  errno = error;
  return -1;
}

void setPort(sockaddr* address, uint16_t port) {
  if (address->sa_family == AF_INET) {
    reinterpret_cast<sockaddr_in*>(address)->sin_port = htons(port);
  } else if (address->sa_family == AF_INET6) {
    reinterpret_cast<sockaddr_in6*>(address)->sin6_port = htons(port);
  }
}

uint16_t portOf(int fd) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  if (address.ss_family == AF_INET) {
    return ntohs(reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
  }
  return ntohs(reinterpret_cast<const sockaddr_in6*>(&address)->sin6_port);
}

ListeningSockets listenOnHost(const HostPort& where) {
  ListeningSockets sockets{.fds = {}, .port = where.port.value_or(0)};
  const AddressList addresses = addressesOf(where);
  for (const addrinfo* entry = addresses.get(); entry != nullptr; entry = entry->ai_next) {
    setPort(entry->ai_addr, sockets.port);
    const int fd = listenOn(entry->ai_addr, entry->ai_addrlen);
    if (fd >= 0) {
      sockets.fds.push_back(fd);
      sockets.port = portOf(fd);
    } else if (errno == EADDRINUSE || errno == EACCES) {
      for (const int opened : sockets.fds) close(opened);
      return {};
    }
  }
  return sockets;
}

// Leaves files of other kinds alone.
void removeSocket(const std::string& path) {
  struct stat file {};
  if (lstat(path.c_str(), &file) == 0 && S_ISSOCK(file.st_mode)) unlink(path.c_str());
}

// "" where the address is no path.
std::string pathOf(const std::string& address) {
  return address.starts_with(kUnixScheme) ? address.substr(kUnixScheme.size()) : "";
}

ListeningSockets listenOnPath(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) return {};
  path.copy(address.sun_path, path.size());
  removeSocket(path);
  const int fd = listenOn(reinterpret_cast<const sockaddr*>(&address), sizeof address);
  return fd < 0 ? ListeningSockets{} : ListeningSockets{.fds = {fd}, .port = 0};
}

}  // namespace

ListeningSockets openListeningSockets(const std::string& address) {
  if (const std::string path = pathOf(address); !path.empty()) return listenOnPath(path);
  const std::optional<HostPort> where = parseHostPort(address);
  return where ? listenOnHost(*where) : ListeningSockets{};
}

void closeListeningSockets(const std::string& address, const std::vector<int>& fds) {
  for (const int fd : fds) close(fd);
  const std::string path = pathOf(address);
  if (!fds.empty() && !path.empty()) removeSocket(path);
}

}  // namespace viewloom
