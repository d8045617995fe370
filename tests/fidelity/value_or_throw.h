// SPDX-License-Identifier: Apache-2.0
// For a program that has nothing to do without its files.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "base/status.h"

namespace viewloom::fidelity {

template <typename Value>
Value valueOrThrow(absl::StatusOr<Value> value) {
  if (!value.ok()) throw std::runtime_error(std::string(value.status().message()));
  return *std::move(value);
}

}  // namespace viewloom::fidelity
