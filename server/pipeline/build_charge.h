// SPDX-License-Identifier: Apache-2.0
// The price of one build, in time of the engines, and its payers.
#pragma once

#include <cstdint>
#include <functional>

#include "engine/engine.h"
#include "metrics/metrics.h"
#include "schedule/fair_shares.h"

namespace viewloom {

// Charges a claim for a build: the time that it keeps a device, the calling thread and the workers
// that help this. Its waits for any of them cost nothing: others are served meanwhile, and pay for
// that. Thread-safety: none; the thread's that builds.
class BuildCharge {
 public:
  // The build begins, and will take about so long. The shares and metrics outlive it.
  BuildCharge(FairShares& shares, const Metrics& metrics, Claim claim, int64_t predicted_ns);
  // Settles, unless that is done.
  ~BuildCharge() { settle(); }
  BuildCharge(const BuildCharge&) = delete;
  BuildCharge& operator=(const BuildCharge&) = delete;

  // For the preparation of a frame, which the charge outlives.
  PreparationEvents events(std::function<bool()> is_given_up);

  // The build is done, has failed or is given up. Returns how long it took, ns.
  int64_t settle();

 private:
  FairShares& shares_;
  const Metrics& metrics_;
  const Claim claim_;
  const int64_t predicted_ns_;
  const int64_t begun_ns_;  // CPU time
  int64_t device_ns_ = 0;
  int64_t measured_ns_ = -1;  // until it is settled
};

}  // namespace viewloom
