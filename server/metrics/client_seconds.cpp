// SPDX-License-Identifier: Apache-2.0
#include "metrics/client_seconds.h"

#include <prometheus/counter.h>
#include <prometheus/registry.h>

namespace viewloom {

ClientSeconds::ClientSeconds(prometheus::Registry& registry)
    : family_(prometheus::BuildCounter()
                  .Name("viewloom_client_engine_seconds_total")
                  .Help("Time of engines and their threads, by the client it was for.")
                  .Register(registry)) {}

void ClientSeconds::add(const std::vector<Payer>& payers, double seconds) {
  std::lock_guard lock(mutex_);
  for (const Payer& payer : payers) {
    if (!payer.isServer()) counterOf(payer.name()).Increment(seconds / double(payers.size()));
  }
}

prometheus::Counter& ClientSeconds::counterOf(const std::string& client) {
  const auto found = counters_.find(client);
  if (found != counters_.end()) return *found->second;
  if (counters_.size() >= kNamedClients && client != kOtherClients) return counterOf(kOtherClients);
  prometheus::Counter& counter = family_.Add({{"client", client}});
  counters_.emplace(client, &counter);
  return counter;
}

}  // namespace viewloom
