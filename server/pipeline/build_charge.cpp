// SPDX-License-Identifier: Apache-2.0
#include "pipeline/build_charge.h"

#include <utility>

#include "base/thread_time.h"
#include "base/worker_pool.h"

namespace viewloom {
namespace {

// CPU time of this thread's work so far, ns.
int64_t spentNs() {
  return threadTimeNs() + WorkerPool::helpNs();
}

}  // namespace

BuildCharge::BuildCharge(FairShares& shares, const Metrics& metrics, Claim claim,
                         int64_t predicted_ns)
    : shares_(shares),
      metrics_(metrics),
      claim_(std::move(claim)),
      predicted_ns_(predicted_ns),
      begun_ns_(spentNs()) {
  shares_.begin(claim_, predicted_ns_);
}

PreparationEvents BuildCharge::events(std::function<bool()> is_given_up) {
  return {.on_piece =
              [this](const DoneWork& work) {
                device_ns_ += work.measured_ns;
                metrics_.observePiece(
                    EngineWork::kBuild, claim_.payers,
                    {.predicted_ns = work.predicted_ns, .measured_ns = work.measured_ns});
              },
          .is_given_up = std::move(is_given_up)};
}

int64_t BuildCharge::settle() {
  if (measured_ns_ >= 0) return measured_ns_;
  measured_ns_ = device_ns_ + spentNs() - begun_ns_;
  shares_.finish(claim_, predicted_ns_, measured_ns_);
  return measured_ns_;
}

}  // namespace viewloom
