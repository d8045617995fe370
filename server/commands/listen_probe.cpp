// SPDX-License-Identifier: Apache-2.0
#include "commands/listen_probe.h"

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/host_port.h"

namespace viewloom {
namespace {

std::string whyNotBind(const addrinfo& candidate) {
  const int probe = socket(candidate.ai_family, candidate.ai_socktype, candidate.ai_protocol);
  if (probe < 0) return std::strerror(errno);
  // As the servers do: a port whose last connections still linger counts as free.
  const int yes = 1;
  setsockopt(probe, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const bool is_free =
      bind(probe, candidate.ai_addr, candidate.ai_addrlen) == 0 && listen(probe, 1) == 0;
  std::string refusal = is_free ? "" : std::strerror(errno);
  close(probe);
  return refusal;
}

// A server replaces a socket file that is left over, but it cannot make its folder.
std::string whyNotUnix(const std::filesystem::path& path) {
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  return access(folder.c_str(), W_OK) == 0 ? "" : folder.string() + ": " + std::strerror(errno);
}

}  // namespace

std::string whyNotListen(const std::string& address) {
  constexpr char kUnix[] = "unix:";
  if (address.starts_with(kUnix)) return whyNotUnix(address.substr(sizeof kUnix - 1));
  const std::optional<HostPort> parsed = parseHostPort(address);
  if (!parsed || !parsed->port) return "it is not HOST:PORT";
  const addrinfo hints = {.ai_flags = AI_PASSIVE, .ai_socktype = SOCK_STREAM};
  addrinfo* found = nullptr;
  const int error =
      getaddrinfo(parsed->host.c_str(), std::to_string(*parsed->port).c_str(), &hints, &found);
  if (error != 0) return gai_strerror(error);
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, freeaddrinfo);
  return whyNotBind(*found);
}

}  // namespace viewloom
