// SPDX-License-Identifier: Apache-2.0
#include "e2e/bad_header.h"

#include <gtest/gtest.h>

#include "e2e/bystander.h"

namespace viewloom {

void expectRefused(const std::vector<BadHeader>& cases) {
  TestServer server;
  Bystander bystander(server);
  for (const BadHeader& bad : cases) {
    SCOPED_TRACE(bad.name);
    TestPublisher publisher(server.connect(), "bad");
    v1::FrameHeader header = smallHeader(1);
    bad.spoil(header);
    publisher.sendHeader(header);
    EXPECT_EQ(refusalOf(publisher.finish()), (Refusal{bad.code, bad.field}));
    bystander.expectUndisturbed();
  }
}

}  // namespace viewloom
