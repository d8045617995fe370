// SPDX-License-Identifier: Apache-2.0
#include "cli/server_options.h"

#include <string>

#include "lib/access_token.h"

namespace viewloom::cli {

void addServerOptions(const usage::Command& app, CommonOptions& common) {
  common = {.server = kDefaultAddress, .token = tokenOfEnvironment()};
  app.add("--server", common.server, "Address of the server: HOST:PORT or unix:PATH")
      .valueName("ADDRESS")
      .environment("VIEWLOOM_SERVER_ADDRESS")
      .showDefault();
  const auto take = [&common](const std::string& file) {
    const absl::StatusOr<std::string> token = readAccessToken(file);
    if (!token.ok()) throw usage::BadValue(std::string(token.status().message()));
    common.token = *token;
  };
  app.addTaken("--token-file", take, "File with the access token for the server")
      .valueName("FILE")
      .defaultText("the token in VIEWLOOM_TOKEN");
}

std::shared_ptr<grpc::Channel> channelTo(const CommonOptions& common) {
  return makeChannel(common.server, common.token);
}

}  // namespace viewloom::cli
