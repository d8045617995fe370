// SPDX-License-Identifier: Apache-2.0
#include "bench/bare_work.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <thread>

#include "base/worker_pool.h"

namespace viewloom::bench {
namespace {

using Clock = std::chrono::steady_clock;

// So many a core, as rows are shared: a core that is late has less of the work.
constexpr uint32_t kPiecesPerCore = 32;

void calculate(uint64_t step_count) {
  volatile double result = 1;
  double value = result;
  for (uint64_t i = 0; i < step_count; ++i) value = value * 1.0000001 + 1e-9;
  result = value;
}

void work(uint64_t steps_per_piece, WorkerPool& workers) {
  workers.forEach(kPiecesPerCore * workers.workerCount(),
                  [&](uint32_t, uint32_t) { calculate(steps_per_piece); });
}

double msSince(Clock::time_point begun) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
}

// The least disturbed of several tries counts.
uint64_t stepsPerPiece(double work_ms, WorkerPool& workers) {
  constexpr uint64_t kTriedSteps = 1 << 15;
  double least_ms = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 20; ++i) {
    const Clock::time_point begun = Clock::now();
    work(kTriedSteps, workers);
    least_ms = std::min(least_ms, msSince(begun));
  }
  return uint64_t(std::max(1.0, std::round(double(kTriedSteps) * work_ms / least_ms)));
}

}  // namespace

load::Percentiles measureBareWork(double work_ms, double rate_hz, double seconds) {
  WorkerPool workers;
  const uint64_t step_count = stepsPerPiece(work_ms, workers);
  load::Percentiles taken;
  const Clock::time_point begin = Clock::now();
  Clock::time_point due = begin;
  while (msSince(begin) < 1e3 * seconds) {
    std::this_thread::sleep_until(due);
    work(step_count, workers);
    const Clock::time_point end = Clock::now();
    taken.add(std::chrono::nanoseconds(end - due).count());
    due = std::max(due + std::chrono::nanoseconds(int64_t(1e9 / rate_hz)), end);
  }
  return taken;
}

}  // namespace viewloom::bench
