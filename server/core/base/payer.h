// SPDX-License-Identifier: Apache-2.0
// The party that work is accounted to.
#pragma once

#include <compare>
#include <string>
#include <utility>

namespace viewloom {

// A small value; equal payers share one part of the engines' time. Thread-safety: as a string.
class Payer {
 public:
  // The server itself, for work that nobody asked for.
  Payer() = default;
  // A client: the id of a proven identity, or the name that identityOfHost gives.
  explicit Payer(std::string name) : name_(std::move(name)) {}

  bool isServer() const { return name_.empty(); }
  // A client on this machine that has proven no identity.
  bool isLocal() const;
  // For logs and comparisons; empty for the server itself.
  const std::string& name() const { return name_; }

  auto operator<=>(const Payer&) const = default;

 private:
  std::string name_;
};

}  // namespace viewloom
