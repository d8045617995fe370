// SPDX-License-Identifier: Apache-2.0
// Engine time by client, where clients have names.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "base/payer.h"

namespace prometheus {
class Counter;
template <typename Metric>
class Family;
class Registry;
}  // namespace prometheus

namespace viewloom {

// Counters of a registry, which outlives it, one for each client. Beyond kNamedClients, all others
// share the counter of kOtherClients: clients choose the names in the tokens of some issuers, and a
// counter is kept until the server ends. Thread-safety: all methods may be called from any thread.
class ClientSeconds {
 public:
  static constexpr size_t kNamedClients = 256;
  static constexpr const char* kOtherClients = "others";

  explicit ClientSeconds(prometheus::Registry& registry);

  // Work that was for all of them, each to an equal part. That of the server itself is left out.
  void add(const std::vector<Payer>& payers, double seconds);

 private:
  prometheus::Counter& counterOf(const std::string& client);

  prometheus::Family<prometheus::Counter>& family_;
  std::mutex mutex_;  // guards what follows
  std::map<std::string, prometheus::Counter*> counters_;
};

}  // namespace viewloom
