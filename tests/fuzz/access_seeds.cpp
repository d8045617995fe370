// SPDX-License-Identifier: Apache-2.0
#include <initializer_list>
#include <string>

#include "fuzz/seeds.h"
#include "support/test_certificates.h"

namespace viewloom {
namespace {

SeedBytes textSeeds(std::initializer_list<std::string> texts) {
  SeedBytes seeds;
  for (const std::string& text : texts) seeds.emplace_back(text.begin(), text.end());
  return seeds;
}

}  // namespace

SeedBytes tokensSeeds() {
  const std::string sha256 =
      R"("sha256":"ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad")";
  return textSeeds(
      {R"({"id":"camera-1",)" + sha256 +
           R"(,"roles":["publish","watch"],"streams":["room.*"],"expires":"2027-01-31T12:00:00Z",)"
           R"("limits":{"streams":2,"connections":4,"pixels_per_s":9000},"note":"\u0077all"})",
       "# ours\n\n{\"id\":\"wall\"," + sha256 + R"(,"roles":"operate","streams":"*"})" +
           "\r\n{\"id\":\"b\"," + sha256 +
           R"(,"roles":["watch"],"streams":["a","b"],"expires":"2027-01-31"})"});
}

// A header, claims, and a token that nobody signed.
SeedBytes jwtSeeds() {
  const std::string unsigned_token = "eyJhbGciOiJub25lIn0.eyJzdWIiOiJhbm5hIn0.AAAA";
  return textSeeds(
      {R"({"alg":"EdDSA","typ":"JWT","kid":"ed"})"
       "\n"
       R"({"sub":"anna","iss":"https://sign.in","aud":"viewloom","exp":1900000000,)"
       R"("nbf":1700000000.5,"roles":["watch"],"streams":["room.*"],"limits":{"displays":2}})"
       "\n" +
           unsigned_token,
       R"({"alg":"EdDSA"})"
       "\n"
       R"({"sub":"b","iss":"https://sign.in","aud":["other","viewloom"],"exp":1.9e9,)"
       R"("roles":"publish","streams":"*"})"});
}

// Keys of RFC 8037 and RFC 7517.
SeedBytes keySetSeeds() {
  const std::string ed25519 = R"({"kty":"OKP","crv":"Ed25519","kid":"ed",)"
                              R"("x":"11qYAYKxCrfVS_7TyWQHOg7hcvPapiMlrwIaaPcHURo"})";
  const std::string p256 = R"({"kty":"EC","crv":"P-256","use":"sig","alg":"ES256",)"
                           R"("x":"MKBCTNIcKUSDii11ySs3526iDZ8AiTo7Tu6KPAqv7D4",)"
                           R"("y":"4Etl6SRW2YiLUrN5vfvVHuhp7x8PxltmWWlbbM4IFyM"})";
  const std::string rsa =
      R"({"kty":"RSA","kid":"2011-04-29","e":"AQAB",)"
      R"("n":"0vx7agoebGcQSuuPiLJXZptN9nndrQmbXEps2aiAFbWhM78LhWx4cbbfAAtVT86zwu1RK7aPFFxuhDR1L6)"
      R"(tSoc_BJECPebWKRXjBZCiFV4n3oknjhMstn64tZ_2W-5JsGY4Hc5n9yBXArwl93lqt7_RN5w6Cf0h4QyQ5v-65)"
      R"(YGjQR0_FDW2QvzqY368QQMicAtaSqzs8KJZgnYb9c7d0zgdAZHzu6qMQvRL5hajrn1n91CbOpbISD08qNLyrdk)"
      R"(t-bFTWhAI4vMQFh6WeZu0fM4lFd2NcRwr3XPksINHaQ-G_xBniIqbw0Ls1jF44-csFCur-kEgU8awapJzKnqDK)"
      R"(gw"})";
  return textSeeds({"{\"keys\":[" + ed25519 + "," + p256 + "]}", "{\"keys\":[" + rsa + "]}",
                    "{\"keys\":[{\"kty\":\"oct\",\"k\":\"AAAA\"}," + p256 + "]}"});
}

SeedBytes linkSeeds() {
  const std::string signature(43, 'A');
  return textSeeds({"1893456000.t.Y2FtZXJhLTE." + signature, "1893456000.j.YW5uYQ." + signature});
}

SeedBytes certificateSeeds() {
  const TestCertificate authority = makeTestCertificate({.name = "lab", .is_authority = true});
  const TestCertificate server = makeTestCertificate({}, &authority);
  const TestCertificate client =
      makeTestCertificate({.name = "publisher-1", .hosts = "", .usage = "clientAuth"});
  return textSeeds({server.pem + authority.pem + server.key_pem, client.key_pem + client.pem,
                    "a name\n" + authority.pem});
}

}  // namespace viewloom
