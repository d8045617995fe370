// SPDX-License-Identifier: Apache-2.0
#include "commands/contained_serve.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/str_split.h"
#include "base/host_port.h"
#include "config/kernel_folder.h"

namespace viewloom {
namespace {

constexpr std::string_view kUnixScheme = "unix:";

// At the end of a program, a sanitizer looks for leaks: it starts a process that looks into this
// one.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif

// The port of an address, or the folder in which its socket is made.
void addAddress(const std::string& address, ContainmentOptions& options) {
  if (address.starts_with(kUnixScheme)) {
    std::error_code error;
    const auto path = std::filesystem::absolute(address.substr(kUnixScheme.size()), error);
    options.files.push_back({path.parent_path(), FileAccess::kSockets});
    return;
  }
  const std::optional<HostPort> parsed = parseHostPort(address);
  if (parsed && parsed->port) options.listen_ports.push_back(*parsed->port);
}

// A file of the settings that is read again when it has changed.
void addReloaded(const std::string& file, ContainmentOptions& options) {
  if (file.empty()) return;
  for (FileGrant& grant : replaceableFile(file)) options.files.push_back(std::move(grant));
}

// A log that is opened anew once its file was moved away: the folder, for the new file.
void addLog(const std::string& file, ContainmentOptions& options) {
  if (file.empty()) return;
  std::error_code error;
  options.files.push_back({std::filesystem::absolute(file, error).parent_path(), FileAccess::kLog});
}

}  // namespace

ContainmentOptions containmentOf(const Config& config) {
  ContainmentOptions options{.is_enabled = config.containment.enabled && !kIsSanitized,
                             .may_dump_core = config.containment.core_dumps || kIsSanitized};
  // gRPC tries a free port to find out whether there is IPv6.
  options.listen_ports.push_back(0);
  addAddress(config.grpc.address, options);
  if (config.http.enabled) addAddress(config.http.address, options);
  for (const std::string& file : {config.tls.certificate, config.tls.key, config.tls.client_ca,
                                  config.access.token_file, config.access.jwks_file}) {
    addReloaded(file, options);
  }
  addLog(config.access.audit_file, options);
  const std::string kernels = kernelFolder(config.kernel_folder);
  if (!kernels.empty()) options.files.push_back({kernels, FileAccess::kKeep});
  const std::vector<std::string> readable =
      absl::StrSplit(config.containment.readable, ',', absl::SkipEmpty());
  for (const std::string& path : readable) options.files.push_back({path, FileAccess::kRead});
  return options;
}

}  // namespace viewloom
