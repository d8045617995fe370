// SPDX-License-Identifier: Apache-2.0
// A server whose atlases cost nothing to make: what remains is the way out to a viewer.
#pragma once

#include <string>
#include <thread>
#include <vector>

#include "e2e/test_server.h"

namespace viewloom::bench {

// Gives the one viewer of a display the next atlas while the last one leaves: the same bytes again
// and again, as uncompressed colour.
class EndlessAtlases {
 public:
  EndlessAtlases();

  std::string address() const { return server_.address(); }

 private:
  void run(const std::stop_token& stop);
  void publish(const ActiveDisplay& display);

  TestServer server_;
  std::vector<EncodedBand> bands_;  // made for the first display
  std::jthread thread_;             // last: it uses what stands above
};

}  // namespace viewloom::bench
