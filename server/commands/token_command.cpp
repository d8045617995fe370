// SPDX-License-Identifier: Apache-2.0
// viewloomd token: adds, lists and revokes access tokens.
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "absl/strings/str_split.h"
#include "access/rights_json.h"
#include "access/token_file.h"
#include "access/utc_time.h"
#include "base/printable.h"
#include "base/str_cat.h"
#include "commands/command.h"
#include "usage/command_line.h"

namespace viewloom {
namespace {

constexpr uint32_t kDaysMax = 36'500;
constexpr int64_t kSecondsPerDay = 86'400;

struct TokenOptions {
  std::string action;
  std::string name;
  std::string roles;
  std::string streams = "*";
  std::string limits;
  std::string note;
  uint32_t days = 0;  // 0 = never expires
};

[[noreturn]] void refuse(std::string_view problem) {
  throw std::runtime_error(strCat("token: ", problem));
}

void require(const absl::Status& status) {
  if (!status.ok()) refuse(std::string(status.message()));
}

// "displays=4,streams=2" as the JSON of the token file.
nlohmann::json limitsJson(const std::string& text) {
  nlohmann::json limits = nlohmann::json::object();
  const std::vector<std::string> parts = absl::StrSplit(text, ',', absl::SkipEmpty());
  for (const std::string& part : parts) {
    const size_t equals = part.find('=');
    const std::string number = equals == std::string::npos ? "" : part.substr(equals + 1);
    const nlohmann::json value = nlohmann::json::parse(number, nullptr, false);
    if (!value.is_number_unsigned()) {
      refuse(strCat("--limits: got \"", printable(part),
                    "\"; accepted are a name, = and a whole number, as in displays=4"));
    }
    limits[part.substr(0, equals)] = value;
  }
  return limits;
}

Rights rightsOf(const TokenOptions& options) {
  const std::vector<std::string> roles = absl::StrSplit(options.roles, ',', absl::SkipEmpty());
  const std::vector<std::string> streams = absl::StrSplit(options.streams, ',', absl::SkipEmpty());
  absl::StatusOr<Rights> rights = rightsFromJson(
      {{"roles", roles}, {"streams", streams}, {"limits", limitsJson(options.limits)}});
  require(rights.status());
  return *std::move(rights);
}

int addToken(const TokenOptions& options, const std::string& file) {
  require(validateTokenId(options.name));
  const std::string token = makeToken();
  Identity identity{.id = options.name,
                    .proof = Proof::kToken,
                    .rights = rightsOf(options),
                    .digest = sha256(token),
                    .expires_s = {}};
  if (options.days > 0) identity.expires_s = systemSeconds() + options.days * kSecondsPerDay;
  require(addToTokenFile(file, {.identity = std::make_shared<const Identity>(std::move(identity)),
                                .note = options.note}));
  std::fprintf(stderr,
               "The token follows. It is shown only now: keep it as a secret.\n"
               "Use it with `viewloom --token-file FILE` or in VIEWLOOM_TOKEN.\n");
  std::printf("%s\n", token.c_str());
  return 0;
}

int listTokens(const std::string& file) {
  const absl::StatusOr<TokenList> list = readTokenFile(file);
  require(list.status());
  std::printf("%-20s %-24s %-24s %-21s %s\n", "NAME", "ROLES", "STREAMS", "EXPIRES", "NOTE");
  for (const TokenEntry& entry : list->entries()) {
    const Identity& identity = *entry.identity;
    const bool is_over = identity.expires_s && *identity.expires_s <= systemSeconds();
    const std::string expires = !identity.expires_s ? "never"
                                : is_over           ? "has expired"
                                                    : utcText(*identity.expires_s);
    std::printf("%-20s %-24s %-24s %-21s %s\n", identity.id.c_str(),
                identity.rights.rolesText().c_str(), identity.rights.streams.text().c_str(),
                expires.c_str(), printable(entry.note).c_str());
  }
  return 0;
}

int revokeToken(const std::string& name, const std::string& file) {
  require(removeFromTokenFile(file, name));
  std::printf("revoked %s; a server that runs notices it within a second\n", name.c_str());
  return 0;
}

int runToken(const TokenOptions& options, const Config& config) {
  const std::string& file = config.access.token_file;
  if (file.empty()) {
    refuse("no token file is named. Give --access.token_file FILE, as to the server");
  }
  const bool needs_name = options.action != "list";
  if (needs_name && options.name.empty()) {
    refuse(strCat("the name of the token is missing. Give `viewloomd token ", options.action,
                  " NAME`"));
  }
  if (!needs_name && !options.name.empty()) refuse("list takes no name; leave it out");
  if (options.action == "list") return listTokens(file);
  if (options.action == "revoke") return revokeToken(options.name, file);
  if (options.roles.empty()) {
    refuse(
        "--role is missing. Give publish, watch, operate, or some of them: --role publish,watch");
  }
  return addToken(options, file);
}

}  // namespace

void addTokenCommand(const usage::Command& app, RunCommand& chosen) {
  const usage::Command command =
      app.addCommand("token", "Add, list or revoke access tokens in the file access.token_file");
  const auto options = std::make_shared<TokenOptions>();
  command.footer(
      "Examples:\n"
      "  viewloomd token add camera-1 --role publish --streams 'room.*'\n"
      "  viewloomd token add wall --role watch --days 30 --limits displays=4\n"
      "  viewloomd token list\n"
      "  viewloomd token revoke camera-1\n"
      "Each needs --access.token_file FILE, or --config FILE with that setting.");
  command.add("action", options->action, "Task").oneOf({"add", "list", "revoke"}).required();
  command.add("name", options->name, "Name of the token: letters, digits, '.', '_' and '-'");
  command.add("--role", options->roles, "Roles of a new token: publish, watch, operate")
      .valueName("ROLE,ROLE");
  command.add("--streams", options->streams, "Streams of a new token; * stands for any characters")
      .valueName("PATTERN,PATTERN")
      .showDefault();
  command.add("--days", options->days, "Days until a new token expires; 0 is never")
      .valueName("DAYS")
      .between(0U, kDaysMax)
      .showDefault();
  command
      .add("--limits", options->limits,
           "Limits of a new token: connections, streams, displays, pixels_per_s, bytes_per_s")
      .valueName("NAME=N,NAME=N")
      .defaultText("none");
  command.add("--note", options->note, "Note for a new token").valueName("TEXT");
  command.onChosen([&chosen, options] {
    chosen = [options](const Config& config) { return runToken(*options, config); };
  });
}

}  // namespace viewloom
