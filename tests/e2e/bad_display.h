// SPDX-License-Identifier: Apache-2.0
// Displays that cannot be served, and the promise that asking for them costs nobody else anything.
#pragma once

#include <functional>
#include <vector>

#include "e2e/refusal.h"
#include "e2e/test_watcher.h"

namespace viewloom {

struct BadDisplay {
  const char* name;
  std::function<void(v1::OpenDisplay&)> spoil;  // a small quilt that can be served
  Refusal refusal;
};

// Each is refused as it says while a bystander goes on.
void expectRefused(const std::vector<BadDisplay>& cases);

}  // namespace viewloom
