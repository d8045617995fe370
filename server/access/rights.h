// SPDX-License-Identifier: Apache-2.0
// Rights of an identity: roles, streams and quotas.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace viewloom {

enum class Role : uint8_t {
  kPublish,  // sends frames
  kWatch,    // opens displays, asks for stills, makes links to them
  kOperate   // reads the metrics
};

// "publish", "watch", "operate".
std::string_view wordOf(Role role);
std::optional<Role> roleOf(std::string_view word);

// Names of streams, such as "room.*". '*' stands for any characters, also none.
class StreamPatterns {
 public:
  StreamPatterns() = default;  // matches no stream

  // INVALID_ARGUMENT for a pattern that is not [A-Za-z0-9._*-]{1,64}, or for more than 32.
  static absl::StatusOr<StreamPatterns> parse(std::vector<std::string> patterns);
  static StreamPatterns all();

  // The time grows with the product of both lengths at most.
  bool matches(std::string_view stream) const;
  const std::vector<std::string>& texts() const { return texts_; }
  // "room.*, hall"; "none".
  std::string text() const;

  friend bool operator==(const StreamPatterns&, const StreamPatterns&) = default;

 private:
  explicit StreamPatterns(std::vector<std::string> texts) : texts_(std::move(texts)) {}

  std::vector<std::string> texts_;
};

// Most that one identity may use at a time. Empty: only the limits of the server hold.
struct Quota {
  std::optional<uint64_t> connections;   // gRPC calls that stay, WebSockets and players
  std::optional<uint64_t> streams;       // published
  std::optional<uint64_t> displays;      // that differ
  std::optional<uint64_t> pixels_per_s;  // of atlases that are made for it
  std::optional<uint64_t> bytes_per_s;   // in both directions together

  friend bool operator==(const Quota&, const Quota&) = default;
};

struct Rights {
  std::vector<Role> roles;  // each once, in the order of Role
  StreamPatterns streams;
  Quota quota;

  bool has(Role role) const;
  // "publish, watch".
  std::string rolesText() const;

  friend bool operator==(const Rights&, const Rights&) = default;
};

// All roles and streams, without a quota.
Rights allRights();

// Sorted, each once. INVALID_ARGUMENT for an unknown word, or for none.
absl::StatusOr<std::vector<Role>> rolesFromWords(const std::vector<std::string>& words);

}  // namespace viewloom
