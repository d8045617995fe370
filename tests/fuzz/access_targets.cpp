// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "access/jwt.h"
#include "access/key_set.h"
#include "access/signed_link.h"
#include "access/token_list.h"
#include "base/check.h"
#include "certificates/authorities.h"
#include "certificates/certified_key.h"
#include "fuzz/memory_file.h"
#include "fuzz/script.h"
#include "fuzz/targets.h"
#include "support/test_certificates.h"
#include "unit/access/jwt_maker.h"

namespace viewloom {
namespace {

constexpr const char* kFile = "fuzz";
const LinkTarget kLinked{.stream = "s", .display = "quilt 8 6"};

// A refusal says what is wrong.
bool isAdmitted(const absl::Status& status) {
  VIEWLOOM_CHECK(status.ok() || !status.message().empty());
  return status.ok();
}

// Text before the first line break; it is taken off.
std::string_view takeLine(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(line.size() + 1, text.size()));
  return line;
}

bool areSame(const TokenEntry& one, const TokenEntry& other) {
  return one.identity->id == other.identity->id && one.identity->digest == other.identity->digest &&
         one.identity->rights == other.identity->rights &&
         one.identity->expires_s == other.identity->expires_s && one.note == other.note;
}

// A server with one key, and the sign-in service that has it.
class SignIn {
 public:
  bool isKnown(std::string_view token) const {
    const absl::StatusOr<IdentityPtr> identity = verifyJwt(token, keys_, kRules, kTestDay_s);
    if (!isAdmitted(identity.status())) return false;
    VIEWLOOM_CHECK(!(*identity)->id.empty() && (*identity)->proof == Proof::kJwt);
    VIEWLOOM_CHECK((*identity)->expires_s > kTestDay_s && !(*identity)->rights.roles.empty());
    return true;
  }
  std::string signedToken(std::string_view header, std::string_view claims) const {
    const std::string bytes = base64Url(header) + "." + base64Url(claims);
    return bytes + "." + base64Url(key_.sign(bytes));
  }

 private:
  static inline const JwtRules kRules{.audience = "viewloom", .issuer = "https://sign.in"};
  const SigningKey key_ = SigningKey::ed25519();
  const std::vector<PublicKey> keys_ =
      parseKeySet(keySetText(nlohmann::json::array({key_.jwk("ed")})), kFile).value();
};

void describe(const Certificate& certificate) {
  certificate.subject();
  certificate.isSelfSigned();
  certificate.isFor("localhost");
  certificate.isFor("127.0.0.1");
  for (const std::string& name : certificate.names()) VIEWLOOM_CHECK(!name.empty());
  dayText(certificate.beginS());
  dayText(certificate.endS());
  const absl::StatusOr<Fingerprint> again = Fingerprint::parse(certificate.fingerprint().text());
  VIEWLOOM_CHECK(again.ok() && *again == certificate.fingerprint());
}

}  // namespace

bool fuzzTokens(FuzzBytes bytes) {
  const absl::StatusOr<TokenList> list = TokenList::parse(asText(bytes), kFile);
  if (!isAdmitted(list.status())) return false;
  list->find(asText(bytes));
  for (const TokenEntry& entry : list->entries()) {
    VIEWLOOM_CHECK(list->named(entry.identity->id) == &entry);
    const absl::StatusOr<TokenList> again = TokenList::parse(tokenLine(entry), kFile);
    VIEWLOOM_CHECK(again.ok() && areSame(again->entries().front(), entry));
  }
  return !list->entries().empty();
}

bool fuzzJwt(FuzzBytes bytes) {
  static const SignIn sign_in;
  std::string_view text = asText(bytes);
  const std::string_view header = takeLine(text);
  const std::string_view claims = takeLine(text);
  VIEWLOOM_CHECK(!sign_in.isKnown(text));  // nobody signed it
  return sign_in.isKnown(sign_in.signedToken(header, claims));
}

bool fuzzKeySet(FuzzBytes bytes) {
  const absl::StatusOr<std::vector<PublicKey>> keys = parseKeySet(asText(bytes), kFile);
  if (!isAdmitted(keys.status())) return false;
  VIEWLOOM_CHECK(!keys->empty() && keys->size() <= 32);
  for (const PublicKey& key : *keys) {
    VIEWLOOM_CHECK(
        !isSignedBy(key, "text", asText(bytes.first(std::min<size_t>(64, bytes.size())))));
  }
  return true;
}

bool fuzzLink(FuzzBytes bytes) {
  static const LinkSigner signer;
  const absl::StatusOr<LinkClaim> claim = parseLink(asText(bytes));
  if (!isAdmitted(claim.status())) return false;
  const Identity identity{.id = claim->id, .proof = claim->proof, .rights = allRights()};
  VIEWLOOM_CHECK(!signer.isSigned(*claim, identity, kLinked));  // nobody signed it
  const absl::StatusOr<LinkClaim> ours =
      parseLink(signer.sign(identity, kLinked, claim->expires_s));
  VIEWLOOM_CHECK(ours.ok() && signer.isSigned(*ours, identity, kLinked));
  VIEWLOOM_CHECK(ours->id == claim->id && ours->expires_s == claim->expires_s);
  return true;
}

bool fuzzCertificate(FuzzBytes bytes) {
  const absl::StatusOr<std::vector<Certificate>> chain = parseCertificates(asText(bytes));
  if (isAdmitted(chain.status())) {
    for (const Certificate& certificate : *chain) describe(certificate);
  }
  const MemoryFile file(bytes);
  const NamedFile named{.option = "tls.certificate", .path = file.path().string()};
  bool is_accepted = isAdmitted(readAuthorities(named, kTestDay_s).status());
  for (const CertificatePurpose purpose :
       {CertificatePurpose::kServer, CertificatePurpose::kClient}) {
    is_accepted |= isAdmitted(
        readCertifiedKey({.certificate = named, .key = named}, purpose, kTestDay_s).status());
  }
  return is_accepted;
}

}  // namespace viewloom
