// SPDX-License-Identifier: Apache-2.0
#include "access/access_control.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "base/log.h"
#include "base/printable.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr uint64_t kTokenFileBytesMax = uint64_t{8} << 20;
constexpr uint64_t kKeyFileBytesMax = uint64_t{256} << 10;
constexpr int64_t kLookNs = 1'000'000'000;
constexpr size_t kLinkedCountMax = 4096;

absl::Status noToken() {
  return absl::UnauthenticatedError(
      "no access token came; accepted is the header \"authorization: Bearer TOKEN\". Give viewloom "
      "a token with --token-file or VIEWLOOM_TOKEN");
}

absl::Status unknownToken() {
  return absl::UnauthenticatedError(
      "the access token is unknown or was revoked; ask the operator of the server for a new one");
}

absl::Status expired(std::string_view what) {
  return absl::UnauthenticatedError(
      strCat(what, " has expired; ask the operator of the server for a new one"));
}

bool hasExpired(const Identity& identity, int64_t now_s) {
  return identity.expires_s && now_s >= *identity.expires_s;
}

IdentityPtr anybody() {
  static const auto identity = std::make_shared<const Identity>(Identity{
      .id = "", .proof = Proof::kNothing, .rights = allRights(), .digest = {}, .expires_s = {}});
  return identity;
}

std::optional<WatchedFile> watch(const std::string& path, uint64_t bytes_max) {
  if (path.empty()) return std::nullopt;
  return WatchedFile(path, bytes_max);
}

absl::Status checkRole(const Identity& identity, const std::optional<Operation>& operation) {
  if (!operation) return absl::PermissionDeniedError("nobody may do this");
  if (operation->need != Need::kRole || identity.rights.has(operation->role)) {
    return absl::OkStatus();
  }
  return absl::PermissionDeniedError(strCat("this needs the role ", wordOf(operation->role),
                                            "; the access token of \"", printable(identity.id),
                                            "\" has ", identity.rights.rolesText(),
                                            ". Ask the operator of the server for another token"));
}

}  // namespace

AccessControl::AccessControl(AccessOptions options, const Clock& clock)
    : options_(std::move(options)),
      clock_(clock),
      audit_(options_.audit_file, options_.now_s),
      quotas_(clock),
      tokens_file_(watch(options_.token_file, kTokenFileBytesMax)),
      keys_file_(watch(options_.jwks_file, kKeyFileBytesMax)),
      sources_(std::make_shared<const Sources>()) {
  if (keys_file_ && (options_.audience.empty() || options_.issuer.empty())) {
    throw std::runtime_error(
        "access.jwks_file is set without access.audience and access.issuer: JWTs for other "
        "services would be accepted; set both");
  }
  auto first = std::make_shared<Sources>();
  const auto textOf = [](WatchedFile& file) {
    absl::StatusOr<std::optional<std::string>> text = file.readIfChanged();
    if (!text.ok()) throw std::runtime_error(std::string(text.status().message()));
    return **std::move(text);
  };
  if (tokens_file_) {
    absl::StatusOr<TokenList> tokens = TokenList::parse(textOf(*tokens_file_), options_.token_file);
    if (!tokens.ok()) throw std::runtime_error(std::string(tokens.status().message()));
    first->tokens = *std::move(tokens);
  }
  if (keys_file_) {
    auto keys = parseKeySet(textOf(*keys_file_), options_.jwks_file);
    if (!keys.ok()) throw std::runtime_error(std::string(keys.status().message()));
    first->keys = *std::move(keys);
  }
  sources_ = std::move(first);
  next_look_ns_ = clock_.nowNs() + kLookNs;
}

AccessControl::SourcesPtr AccessControl::sources() {
  std::lock_guard lock(mutex_);
  if (clock_.nowNs() >= next_look_ns_) reload();
  return sources_;
}

// With the lock.
void AccessControl::reload() {
  next_look_ns_ = clock_.nowNs() + kLookNs;
  const auto take = [&](std::optional<WatchedFile>& file, const auto& parse, auto member) {
    if (!file) return;
    absl::StatusOr<std::optional<std::string>> text = file->readIfChanged();
    absl::Status status = text.status();
    if (status.ok() && !text->has_value()) return;
    if (status.ok()) {
      auto parsed = parse(**text, file->path());
      status = parsed.status();
      if (parsed.ok()) {
        auto changed = std::make_shared<Sources>(*sources_);
        (*changed).*member = *std::move(parsed);
        sources_ = std::move(changed);
      }
    }
    const std::string reason = status.ok() ? file->path()
                                           : strCat(std::string(status.message()),
                                                    "; what was read before stays in force");
    if (status.ok()) log(LogLevel::kInfo, printable(file->path()), " was read anew");
    if (!status.ok()) log(LogLevel::kError, reason);
    audit({.outcome = status.ok() ? AuditOutcome::kChanged : AuditOutcome::kRefused,
           .operation = "reload",
           .peer = "",
           .identity = nullptr,
           .stream = "",
           .reason = reason});
  };
  take(tokens_file_, TokenList::parse, &Sources::tokens);
  take(keys_file_, parseKeySet, &Sources::keys);
}

absl::StatusOr<IdentityPtr> AccessControl::identify(std::string_view token) {
  if (!isOn()) return anybody();
  if (token.empty()) return noToken();
  const SourcesPtr known = sources();
  const int64_t now_s = options_.now_s();
  if (keys_file_ && isJwtForm(token)) {
    return verifyJwt(token, known->keys, {options_.audience, options_.issuer}, now_s);
  }
  IdentityPtr found = isTokenForm(token) ? known->tokens.find(token) : nullptr;
  if (found == nullptr) return unknownToken();
  if (hasExpired(*found, now_s)) return expired("the access token");
  return found;
}

absl::StatusOr<Caller> AccessControl::grant(std::string_view operation, std::string peer,
                                            const absl::StatusOr<IdentityPtr>& identity) {
  const std::optional<Operation> known = operationOf(operation);
  absl::Status status = identity.status();
  if (status.ok()) status = checkRole(**identity, known);
  if (status.ok() && known->reach == Reach::kStream) status = quotas_.checkRates(**identity);
  AuditEvent event{.outcome = AuditOutcome::kRefused,
                   .operation = known ? known->name : "unknown",
                   .peer = peer,
                   .identity = identity.ok() ? *identity : nullptr,
                   .stream = "",
                   .reason = std::string(status.message())};
  if (!status.ok()) {
    audit(event);
    return status;
  }
  event.outcome = AuditOutcome::kGranted;
  // Lists and streams: the former are asked for every few seconds, the latter follow in mayUse().
  const bool is_told = known->need == Need::kRole && known->reach == Reach::kServer;
  if (is_told || known->name == kApiSession) audit(event);
  return Caller(*this, known->name, std::move(peer), *identity);
}

absl::StatusOr<Caller> AccessControl::admit(std::string_view operation, std::string peer,
                                            std::string_view token) {
  const std::optional<Operation> known = operationOf(operation);
  const bool is_open = known && known->need == Need::kNothing;
  return grant(operation, std::move(peer), is_open ? anybody() : identify(token));
}

absl::StatusOr<Caller> AccessControl::admitLink(std::string_view operation, std::string peer,
                                                std::string_view link, const LinkTarget& target) {
  const absl::StatusOr<LinkClaim> claim = parseLink(link);
  if (!claim.ok()) return grant(operation, std::move(peer), claim.status());
  absl::StatusOr<Caller> caller = grant(operation, std::move(peer), linkedIdentity(*claim, target));
  if (caller.ok() && isOn()) caller->link_expires_s_ = claim->expires_s;
  return caller;
}

absl::StatusOr<IdentityPtr> AccessControl::linkedIdentity(const LinkClaim& claim,
                                                          const LinkTarget& target) {
  if (!isOn()) return anybody();
  const absl::Status refusal = absl::UnauthenticatedError(
      "the link does not fit: it is for another picture, its token was revoked, or the server has "
      "restarted; ask for a new link");
  const SourcesPtr known = sources();
  IdentityPtr identity;
  if (claim.proof == Proof::kToken) {
    const TokenEntry* const entry = known->tokens.named(claim.id);
    if (entry != nullptr) identity = entry->identity;
  } else {
    std::lock_guard lock(mutex_);
    const auto found = linked_.find(claim.id);
    if (found != linked_.end()) identity = found->second;
  }
  if (identity == nullptr || !signer_.isSigned(claim, *identity, target)) return refusal;
  VIEWLOOM_RETURN_IF_ERROR(checkLinkTime(claim.expires_s));
  VIEWLOOM_RETURN_IF_ERROR(recheck(*identity));
  return identity;
}

absl::StatusOr<AccessControl::Link> AccessControl::sign(const Caller& caller,
                                                        const LinkTarget& target, int64_t seconds) {
  if (seconds < 1 || seconds > kLinkSecondsMax) {
    return fieldError(absl::StatusCode::kInvalidArgument, "seconds",
                      strCat("got ", seconds, "; accepted is 1 to ", kLinkSecondsMax, " s"));
  }
  const IdentityPtr& identity = caller.identity_;
  const int64_t now_s = options_.now_s();
  Link link{.signature = "", .expires_s = now_s + seconds};
  if (identity->expires_s) link.expires_s = std::min(link.expires_s, *identity->expires_s);
  if (identity->proof == Proof::kJwt) {
    std::lock_guard lock(mutex_);
    std::erase_if(linked_, [now_s](const auto& entry) { return hasExpired(*entry.second, now_s); });
    if (linked_.size() >= kLinkedCountMax && !linked_.contains(identity->id)) {
      return absl::ResourceExhaustedError(
          "too many identities have links; try again when some have expired");
    }
    linked_[identity->id] = identity;
  }
  link.signature = signer_.sign(*identity, target, link.expires_s);
  return link;
}

absl::Status AccessControl::checkLinkTime(int64_t expires_s) const {
  return options_.now_s() < expires_s ? absl::OkStatus() : expired("the link");
}

absl::Status AccessControl::recheck(const Identity& identity) {
  if (identity.proof == Proof::kNothing) return absl::OkStatus();
  const SourcesPtr known = sources();
  if (hasExpired(identity, options_.now_s())) return expired("the access token");
  if (identity.proof == Proof::kJwt) {
    const bool has_key = std::ranges::any_of(
        known->keys, [&](const PublicKey& key) { return key.digest == identity.digest; });
    return has_key ? absl::OkStatus() : unknownToken();
  }
  const TokenEntry* const entry = known->tokens.named(identity.id);
  if (entry == nullptr || entry->identity->digest != identity.digest) return unknownToken();
  if (hasExpired(*entry->identity, options_.now_s())) return expired("the access token");
  if (entry->identity->rights == identity.rights) return absl::OkStatus();
  return absl::UnauthenticatedError("the rights of the access token have changed; call again");
}

}  // namespace viewloom
