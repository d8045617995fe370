// SPDX-License-Identifier: Apache-2.0
#include "base/worker_pool.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "base/processor_count.h"
#include "base/thread_time.h"

namespace viewloom::worker_pool_test {
namespace {

TEST(WorkerPool, givesEveryIndexOnce) {
  for (const uint32_t worker_count : {1U, 2U, 3U, 8U}) {
    WorkerPool pool(worker_count);
    for (const uint32_t count : {1U, 2U, 7U, 1000U}) {
      std::vector<std::atomic<uint32_t>> given(count);
      pool.forEach(count, [&](uint32_t index, uint32_t) { ++given.at(index); });
      for (const std::atomic<uint32_t>& times : given) EXPECT_EQ(times, 1u);
    }
  }
}

// Sums per worker need no lock, because a worker runs one piece at a time. TSan checks that.
TEST(WorkerPool, givesAWorkerOnePieceAtATime) {
  constexpr uint32_t kPieces = 2000;
  WorkerPool pool(4);
  ASSERT_EQ(pool.workerCount(), 4u);
  std::vector<uint64_t> sums(pool.workerCount());
  pool.forEach(kPieces, [&](uint32_t index, uint32_t worker) { sums.at(worker) += index; });
  EXPECT_EQ(std::accumulate(sums.begin(), sums.end(), uint64_t{0}), kPieces * (kPieces - 1) / 2);
}

// Keeps the core of the calling thread for so long.
void work(int64_t time_ns) {
  const int64_t end_ns = threadTimeNs() + time_ns;
  while (threadTimeNs() < end_ns) {
  }
}

TEST(WorkerPool, tellsWhatWorkersHaveSpentOnTasksOfAThread) {
  constexpr uint32_t kPieces = 40;
  constexpr int64_t kPiece_ns = 1'000'000;
  WorkerPool pool(3);
  const auto costOf = [&](int64_t piece_ns) {
    const int64_t begun_ns = threadTimeNs() + WorkerPool::helpNs();
    pool.forEach(kPieces, [&](uint32_t, uint32_t) { work(piece_ns); });
    return threadTimeNs() + WorkerPool::helpNs() - begun_ns;
  };
  std::jthread other([&] {
    for (int task = 0; task < 3; ++task) costOf(kPiece_ns);
  });
  EXPECT_GE(costOf(kPiece_ns), kPieces * kPiece_ns) << "workers have helped";
  EXPECT_LT(costOf(0), kPieces * kPiece_ns / 2) << "of other threads' pieces nothing counts";
}

TEST(WorkerPool, returnsWhenAllPiecesHave) {
  WorkerPool pool(3);
  std::vector<uint32_t> squares(64);
  for (uint32_t round = 0; round < 500; ++round) {
    pool.forEach(64, [&](uint32_t index, uint32_t) { squares[index] = index * index + round; });
    for (uint32_t index = 0; index < 64; ++index) {
      ASSERT_EQ(squares[index], index * index + round);
    }
  }
}

TEST(WorkerPool, runsPiecesOfOneCallerAtATime) {
  constexpr uint32_t kPieces = 20;
  constexpr uint32_t kRounds = 100;
  WorkerPool pool(3);
  std::array<std::atomic<int>, 4> running_counts = {};
  std::atomic<uint32_t> mixed_count = 0;
  std::vector<uint64_t> sums(pool.workerCount());  // no lock: one task at a time
  {
    std::vector<std::jthread> callers;
    for (size_t caller = 0; caller < running_counts.size(); ++caller) {
      callers.emplace_back([&, caller] {
        for (uint32_t round = 0; round < kRounds; ++round) {
          std::atomic<uint32_t> done_count = 0;
          pool.forEach(kPieces, [&](uint32_t index, uint32_t worker) {
            ++running_counts[caller];
            sums.at(worker) += index;
            for (size_t other = 0; other < running_counts.size(); ++other) {
              mixed_count += other != caller && running_counts[other] > 0;
            }
            --running_counts[caller];
            ++done_count;
          });
          EXPECT_EQ(done_count, kPieces);
        }
      });
    }
  }
  EXPECT_EQ(mixed_count, 0u);
  EXPECT_EQ(std::accumulate(sums.begin(), sums.end(), uint64_t{0}),
            4 * kRounds * kPieces * (kPieces - 1) / 2);
}

// A caller with a task of a second does not keep one with a short task waiting for so long.
TEST(WorkerPool, letsCallersTakeTurns) {
  WorkerPool pool(2);
  std::atomic<bool> has_begun = false;
  std::atomic<uint32_t> long_count = 0;
  const std::jthread long_caller([&] {
    pool.forEach(1000, [&](uint32_t, uint32_t) {
      has_begun = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      ++long_count;
    });
  });
  while (!has_begun) std::this_thread::yield();
  uint32_t short_count = 0;
  pool.forEach(1, [&](uint32_t, uint32_t) { ++short_count; });
  EXPECT_EQ(short_count, 1u);
  EXPECT_LT(long_count, 900u) << "it waited for all of the other task";
}

TEST(WorkerPool, hasNothingToDoForNoPieces) {
  WorkerPool pool(3);
  pool.forEach(0, [](uint32_t, uint32_t) { FAIL(); });
  uint32_t given_count = 0;
  pool.forEach(1, [&](uint32_t, uint32_t) { ++given_count; });
  EXPECT_EQ(given_count, 1u);
}

TEST(WorkerPool, oneWorkerIsTheCaller) {
  WorkerPool pool(1);
  EXPECT_EQ(pool.workerCount(), 1u);
  pool.forEach(5, [caller = std::this_thread::get_id()](uint32_t, uint32_t worker) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    EXPECT_EQ(worker, 0u);
  });
}

TEST(WorkerPool, hasAWorkerAProcessorIfNotTold) {
  EXPECT_EQ(WorkerPool().workerCount(), processorCount());
}

TEST(WorkerPool, servesTheNextTaskAfterAPieceThatThrew) {
  WorkerPool pool(3);
  const auto fail = [](uint32_t, uint32_t) { throw std::runtime_error("no memory"); };
  EXPECT_THROW(pool.forEach(20, fail), std::runtime_error);
  std::atomic<uint32_t> count = 0;
  pool.forEach(20, [&](uint32_t, uint32_t) { ++count; });
  EXPECT_EQ(count, 20U);
}

TEST(WorkerPool, endsWithoutEverHavingWorked) {
  for (int i = 0; i < 100; ++i) const WorkerPool pool(4);
}

}  // namespace
}  // namespace viewloom::worker_pool_test
