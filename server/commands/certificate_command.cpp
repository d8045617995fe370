// SPDX-License-Identifier: Apache-2.0
// viewloomd certificate: makes a certificate for a network without an authority.
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "absl/strings/str_join.h"
#include "base/output_file.h"
#include "base/printable.h"
#include "base/str_cat.h"
#include "certificates/certificate.h"
#include "commands/command.h"
#include "commands/reachable_addresses.h"
#include "tls/make_certificate.h"
#include "usage/command_line.h"

namespace viewloom {
namespace {

constexpr int kExitNotWritten = 1;
constexpr mode_t kForOwnerAlone = 0077;

struct CertificateOptions {
  std::vector<std::string> hosts;
  uint32_t days = CertificateWish{}.days;
  std::filesystem::path folder = ".";
  bool is_replaced = false;
};

std::string withoutBrackets(const std::string& address) {
  return address.starts_with('[') ? address.substr(1, address.size() - 2) : address;
}

// Names and addresses by which other machines and this one may call this machine.
std::vector<std::string> hostsOfThisMachine() {
  std::array<char, 256> name{};
  std::vector<std::string> hosts;
  if (gethostname(name.data(), name.size() - 1) == 0 && name.front() != '\0') {
    hosts.emplace_back(name.data());
    const bool is_short = hosts.front().find('.') == std::string::npos;
    if (is_short && hosts.front() != "localhost") hosts.push_back(hosts.front() + ".local");
  }
  if (hosts.empty() || hosts.front() != "localhost") hosts.emplace_back("localhost");
  const InterfaceAddresses interfaces = interfaceAddresses();
  for (const std::string& address : interfaces.ipv4) hosts.push_back(address);
  for (const std::string& address : interfaces.ipv6) hosts.push_back(withoutBrackets(address));
  hosts.insert(hosts.end(), {"127.0.0.1", "::1"});
  return hosts;
}

absl::Status place(OutputFile& file, const std::filesystem::path& path, bool is_replaced) {
  if (is_replaced) return file.replace();
  const absl::StatusOr<bool> is_new = file.placeNew();
  VIEWLOOM_RETURN_IF_ERROR(is_new.status());
  if (*is_new) return absl::OkStatus();
  return absl::FailedPreconditionError(
      strCat(path.string(),
             " is there already; replace it with --replace, or choose another "
             "folder with --out. Clients have to pin a new certificate anew"));
}

// Both files, or an error before either has its name. The key is for its owner alone: the user of
// the server, if the folder is that user's.
absl::Status writeFiles(const MadeCertificate& made, const std::filesystem::path& certificate_path,
                        const std::filesystem::path& key_path, bool is_replaced) {
  const mode_t before = umask(kForOwnerAlone);
  auto key = OutputFile::create(key_path);
  umask(before);
  VIEWLOOM_RETURN_IF_ERROR(key.status());
  auto certificate = OutputFile::create(certificate_path);
  VIEWLOOM_RETURN_IF_ERROR(certificate.status());
  VIEWLOOM_RETURN_IF_ERROR((*key)->write(made.key_pem));
  VIEWLOOM_RETURN_IF_ERROR((*certificate)->write(made.certificate_pem));
  VIEWLOOM_RETURN_IF_ERROR((*key)->keepOwner());
  VIEWLOOM_RETURN_IF_ERROR((*certificate)->keepOwner());
  VIEWLOOM_RETURN_IF_ERROR(place(**key, key_path, is_replaced));
  return place(**certificate, certificate_path, is_replaced);
}

void tell(const MadeCertificate& made, const CertificateWish& wish,
          const std::filesystem::path& certificate_path, const std::filesystem::path& key_path) {
  std::printf("wrote %s and %s\n", printable(certificate_path.string()).c_str(),
              printable(key_path.string()).c_str());
  std::printf("for %s, until %s\n", absl::StrJoin(wish.hosts, ", ").c_str(),
              dayText(wish.now_s + int64_t{wish.days} * 86400).c_str());
  std::printf("SHA-256 fingerprint %s\n", made.fingerprint.text().c_str());
  std::printf("server:  viewloomd --tls.certificate %s --tls.key %s\n",
              printable(certificate_path.string()).c_str(), printable(key_path.string()).c_str());
  std::printf("clients: viewloom --server https://HOST:50051 --fingerprint %s\n",
              made.fingerprint.text().c_str());
}

int makeFiles(const CertificateOptions& options) {
  const CertificateWish wish{.hosts = options.hosts.empty() ? hostsOfThisMachine() : options.hosts,
                             .days = options.days,
                             .now_s = std::time(nullptr)};
  const absl::StatusOr<MadeCertificate> made = makeCertificate(wish);
  if (!made.ok()) {
    const std::string problem(made.status().message());  // "host: got ..."
    throw std::runtime_error("--name" +
                             problem.substr(std::min(problem.find(": "), problem.size())));
  }
  const std::filesystem::path certificate_path = options.folder / "viewloomd.crt";
  const std::filesystem::path key_path = options.folder / "viewloomd.key";
  const absl::Status written = writeFiles(*made, certificate_path, key_path, options.is_replaced);
  if (!written.ok()) {
    const std::string problem(written.message());
    std::fprintf(stderr, "viewloomd: %s\n", printable(problem, true).c_str());
    return kExitNotWritten;
  }
  tell(*made, wish, certificate_path, key_path);
  return 0;
}

}  // namespace

void addCertificateCommand(const usage::Command& app, RunCommand& chosen) {
  const usage::Command command = app.addCommand(
      "certificate", "Make a certificate for a network without an authority, which clients pin");
  const auto options = std::make_shared<CertificateOptions>();
  command
      .add("--name", options->hosts,
           "Host name or address that the certificate is for; give it once for each")
      .valueName("HOST")
      .defaultText("the names and addresses of this machine");
  command.add("--days", options->days, "Days until it expires, 1 to 3650")
      .valueName("DAYS")
      .between(1U, kCertificateDaysMax)
      .showDefault();
  command.add("--out", options->folder, "Folder for the files viewloomd.crt and viewloomd.key")
      .valueName("FOLDER")
      .existingFolder()
      .showDefault();
  command.addFlag("--replace", options->is_replaced, "Replace files that are there already");
  command.onChosen(
      [&chosen, options] { chosen = [options](const Config&) { return makeFiles(*options); }; });
}

}  // namespace viewloom
