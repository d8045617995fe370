// SPDX-License-Identifier: Apache-2.0
#include "access/token_list.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "absl/strings/ascii.h"
#include "absl/strings/str_join.h"
#include "access/json_object.h"
#include "access/rights_json.h"
#include "access/utc_time.h"
#include "base/nearest_name.h"
#include "base/printable.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr std::string_view kTokenPrefix = "viewloom_";
constexpr size_t kTokenBytes = kTokenPrefix.size() + 43;
constexpr size_t kLineBytesMax = 8192;
// Every token is compared with all of them.
constexpr size_t kTokenCountMax = 10'000;
constexpr size_t kIdLengthMax = 64;

const std::vector<std::string> kTokenFields = {"id",     "sha256",  "roles", "streams",
                                               "limits", "expires", "note"};

absl::Status checkTokenFields(const nlohmann::json& object) {
  for (const auto& [name, value] : object.items()) {
    if (std::ranges::find(kTokenFields, name) != kTokenFields.end()) continue;
    const std::string meant = didYouMean(name, kTokenFields);
    return invalidField(printable(name), strCat("there is no such field; accepted are ",
                                                absl::StrJoin(kTokenFields, ", "),
                                                meant.empty() ? "" : "; ", meant));
  }
  return absl::OkStatus();
}

absl::Status readExpiry(const nlohmann::json& object, Identity& identity) {
  if (!object.contains("expires")) return absl::OkStatus();
  const absl::StatusOr<std::string> text = textField(object, "expires");
  VIEWLOOM_RETURN_IF_ERROR(text.status());
  identity.expires_s = secondsFromUtc(*text);
  if (identity.expires_s) return absl::OkStatus();
  return invalidField("expires", "is no time; accepted is one such as 2027-01-31T12:00:00Z");
}

absl::StatusOr<TokenEntry> entryOf(std::string_view line) {
  if (line.size() > kLineBytesMax) {
    return absl::InvalidArgumentError(
        strCat("the line has ", line.size(), " bytes; accepted are up to ", kLineBytesMax));
  }
  const absl::StatusOr<nlohmann::json> parsed = parseJsonObject(line);
  VIEWLOOM_RETURN_IF_ERROR(parsed.status());
  const nlohmann::json& object = *parsed;
  VIEWLOOM_RETURN_IF_ERROR(checkTokenFields(object));
  auto identity = std::make_shared<Identity>();
  identity->proof = Proof::kToken;
  absl::StatusOr<std::string> id = textField(object, "id");
  VIEWLOOM_RETURN_IF_ERROR(id.status());
  VIEWLOOM_RETURN_IF_ERROR(validateTokenId(*id));
  identity->id = *std::move(id);
  const absl::StatusOr<std::string> hash = textField(object, "sha256");
  VIEWLOOM_RETURN_IF_ERROR(hash.status());
  const std::optional<Digest> digest = digestFromHex(*hash);
  if (!digest) return invalidField("sha256", "is not 64 hexadecimal digits in lower case");
  identity->digest = *digest;
  absl::StatusOr<Rights> rights = rightsFromJson(object);
  VIEWLOOM_RETURN_IF_ERROR(rights.status());
  identity->rights = *std::move(rights);
  VIEWLOOM_RETURN_IF_ERROR(readExpiry(object, *identity));
  absl::StatusOr<std::string> note = textField(object, "note");
  VIEWLOOM_RETURN_IF_ERROR(note.status());
  return TokenEntry{.identity = std::move(identity), .note = *std::move(note)};
}

}  // namespace

std::string makeToken() {
  return strCat(kTokenPrefix, base64Url(randomSecret()));
}

bool isTokenForm(std::string_view text) {
  return text.size() == kTokenBytes && text.starts_with(kTokenPrefix);
}

absl::Status validateTokenId(std::string_view id) {
  const auto is_of_ids = [](char c) {
    return absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' || c == '-';
  };
  const bool fits = !id.empty() && id.size() <= kIdLengthMax;
  if (fits && std::ranges::all_of(id, is_of_ids)) return absl::OkStatus();
  return invalidField(
      "id", strCat("is no name of 1 to ", kIdLengthMax, " characters from A-Z a-z 0-9 . _ -"));
}

std::string tokenLine(const TokenEntry& entry) {
  const Identity& identity = *entry.identity;
  nlohmann::ordered_json object;
  object["id"] = identity.id;
  object["sha256"] = hexText(identity.digest);
  addRights(identity.rights, object);
  if (identity.expires_s) object["expires"] = utcText(*identity.expires_s);
  if (!entry.note.empty()) object["note"] = entry.note;
  return object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

absl::StatusOr<TokenList> TokenList::parse(std::string_view text, std::string_view file_name) {
  TokenList list;
  for (size_t number = 1; !text.empty(); ++number) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (line.find_first_not_of(" \t\r") == std::string_view::npos || line.front() == '#') continue;
    const std::string place = strCat(file_name, ":", number);
    absl::StatusOr<TokenEntry> entry = entryOf(line);
    if (!entry.ok()) {
      return absl::InvalidArgumentError(strCat(place, ": ", std::string(entry.status().message())));
    }
    if (!list.places_.emplace(entry->identity->id, list.entries_.size()).second) {
      return invalidField(
          place, strCat("the id \"", entry->identity->id, "\" is there twice; accepted is once"));
    }
    if (list.places_.size() > kTokenCountMax) {
      return invalidField(place, strCat("there are too many tokens; accepted are up to ",
                                        kTokenCountMax, ". Use JWTs for more"));
    }
    list.entries_.push_back(*std::move(entry));
  }
  return list;
}

IdentityPtr TokenList::find(std::string_view token) const {
  const Digest digest = sha256(token);
  IdentityPtr found;
  for (const TokenEntry& entry : entries_) {
    if (areEqual(entry.identity->digest, digest)) found = entry.identity;
  }
  return found;
}

const TokenEntry* TokenList::named(std::string_view id) const {
  const auto found = places_.find(id);
  return found == places_.end() ? nullptr : &entries_[found->second];
}

}  // namespace viewloom
