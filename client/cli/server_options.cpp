// SPDX-License-Identifier: Apache-2.0
#include "cli/server_options.h"

#include <cstdio>
#include <string>
#include <utility>

#include "base/printable.h"
#include "lib/access_token.h"
#include "lib/channel.h"

namespace viewloom::cli {
namespace {

void addTlsOptions(const usage::Command& app, TlsOptions& tls) {
  app.add("--fingerprint", tls.fingerprint,
          "SHA-256 fingerprint that the server prints, by which it is known instead of by its name")
      .valueName("HEX")
      .environment("VIEWLOOM_SERVER_FINGERPRINT")
      .defaultText("not pinned");
  app.add("--tls-ca", tls.authorities_file,
          "Certificates in PEM of the authorities that the server's certificate comes from")
      .valueName("FILE")
      .environment("VIEWLOOM_SERVER_CA")
      .defaultText("those of the system");
  const usage::Option certificate =
      app.add("--tls-cert", tls.certificate_file,
              "Certificate in PEM of this client, if the server asks for one")
          .valueName("FILE")
          .environment("VIEWLOOM_CLIENT_CERTIFICATE")
          .defaultText("none");
  app.add("--tls-key", tls.key_file, "Private key in PEM of --tls-cert")
      .valueName("FILE")
      .environment("VIEWLOOM_CLIENT_KEY")
      .needs(certificate);
}

void addTokenOption(const usage::Command& app, std::string& token) {
  token = tokenOfEnvironment();
  const auto take = [&token](const std::string& file) {
    const absl::StatusOr<std::string> read = readAccessToken(file);
    if (!read.ok()) throw usage::BadValue(std::string(read.status().message()));
    token = *read;
  };
  app.addTaken("--token-file", take, "File with the access token for the server")
      .valueName("FILE")
      .defaultText("the token in VIEWLOOM_TOKEN");
}

}  // namespace

void addServerOptions(const usage::Command& app, CommonOptions& common) {
  common.server = kDefaultAddress;
  app.add("--server", common.server,
          "Address of the server: HOST:PORT, unix:PATH, or https://HOST:PORT for TLS")
      .valueName("ADDRESS")
      .environment("VIEWLOOM_SERVER_ADDRESS")
      .showDefault();
  addTlsOptions(app, common.tls);
  addTokenOption(app, common.token);
}

std::optional<int> readServerOptions(CommonOptions& common) {
  auto credentials = makeCredentials(common.server, common.tls);
  if (credentials.ok()) {
    common.credentials = *std::move(credentials);
    return std::nullopt;
  }
  const std::string problem(credentials.status().message());
  std::fprintf(stderr, "viewloom: %s\n", printable(problem, true).c_str());
  return kExitUsage;
}

std::shared_ptr<grpc::Channel> channelTo(const CommonOptions& common) {
  return makeChannel(common.server, common.token, common.credentials);
}

}  // namespace viewloom::cli
