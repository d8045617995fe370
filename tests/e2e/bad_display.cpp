// SPDX-License-Identifier: Apache-2.0
#include "e2e/bad_display.h"

#include <gtest/gtest.h>

#include "e2e/bystander.h"

namespace viewloom {

void expectRefused(const std::vector<BadDisplay>& cases) {
  TestServer server;
  Bystander bystander(server);
  for (const BadDisplay& bad : cases) {
    SCOPED_TRACE(bad.name);
    v1::OpenDisplay open = smallQuilt("healthy");
    bad.spoil(open);
    TestWatcher watcher(server.connect(), open);
    EXPECT_EQ(refusalOf(watcher.finish()), bad.refusal);
    bystander.expectUndisturbed();
  }
}

}  // namespace viewloom
