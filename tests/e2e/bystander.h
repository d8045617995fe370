// SPDX-License-Identifier: Apache-2.0
// Somebody else's stream and display on the same server, which nothing may disturb.
#pragma once

#include "e2e/test_publisher.h"
#include "e2e/test_server.h"
#include "e2e/test_watcher.h"

namespace viewloom {

class Bystander {
 public:
  explicit Bystander(TestServer& server);
  // One more frame goes in and comes out as the next atlas, none skipped. Expects, as gtest does.
  void expectUndisturbed();

 private:
  TestPublisher publisher_;
  TestWatcher watcher_;
  uint64_t number_ = 0;
};

}  // namespace viewloom
