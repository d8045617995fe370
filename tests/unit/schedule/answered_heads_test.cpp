// SPDX-License-Identifier: Apache-2.0
// Simulation of moving heads before a server that cannot answer all their poses.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "schedule/job_queue.h"
#include "unit/schedule/head_jobs.h"

namespace viewloom::answered_heads_test {
namespace {

// A client that sends poses at a fixed interval.
struct Head {
  int64_t interval_ns = kHeadset_ns;
  int64_t phase_ns = 0;
};

constexpr int64_t kServed_ns = 60 * kSecond_ns;

// Results of a simulated server that makes one answer at a time.
struct Served {
  std::vector<int64_t> ages_ns;  // of the poses, when their answer began
  std::vector<size_t> answers;   // of each head
  size_t passed_count_max = 0;   // answers to others that began while one head waited

  int64_t ageNs(double share) const {
    std::vector<int64_t> sorted = ages_ns;
    std::sort(sorted.begin(), sorted.end());
    return sorted[size_t(share * double(sorted.size() - 1))];
  }
  double answersPerSecond() const {
    return double(ages_ns.size()) * double(kSecond_ns) / double(kServed_ns);
  }
  // Answers of the luckiest head, divided by those of the unluckiest.
  double unevenness() const {
    const auto [least, most] = std::minmax_element(answers.begin(), answers.end());
    return double(*most) / double(*least);
  }
  // Share of the time spent on answers.
  double busyShare(int64_t answer_ns) const {
    return double(answer_ns) * double(ages_ns.size()) / double(kServed_ns);
  }
};

Served serve(const std::vector<Head>& heads, int64_t answer_ns) {
  JobQueue queue;
  const FairShares shares;
  std::vector<int64_t> next_ns, newest_ns(heads.size());
  std::vector<size_t> passed_count(heads.size());
  for (const Head& head : heads) next_ns.push_back(head.phase_ns);
  Served served;
  served.answers.resize(heads.size());
  // The duration of answers varies a little, so that nothing stays in step.
  std::mt19937 random(1);
  std::uniform_int_distribution<int64_t> more_ns(-answer_ns / 20, answer_ns / 20);
  std::vector<bool> waits(heads.size());
  int64_t now_ns = 0;
  while (now_ns < kServed_ns) {
    for (size_t i = 0; i < heads.size(); ++i) {
      for (; next_ns[i] <= now_ns; next_ns[i] += heads[i].interval_ns) {
        newest_ns[i] = next_ns[i];
        waits[i] = true;
        queue.push(jobOf(std::to_string(i), {newest_ns[i], heads[i].interval_ns}, newest_ns[i]));
      }
    }
    if (queue.next(shares) == nullptr) {
      now_ns = *std::min_element(next_ns.begin(), next_ns.end());
      continue;
    }
    if (const auto until_ns = queue.eyesWaitUntilNs(now_ns)) {
      now_ns = std::min(*until_ns, *std::min_element(next_ns.begin(), next_ns.end()));
      continue;
    }
    const std::string key = queue.beginTracked(now_ns).picture_key;
    const size_t head = std::stoul(key);
    served.ages_ns.push_back(now_ns - newest_ns[head]);
    ++served.answers[head];
    waits[head] = false;
    passed_count[head] = 0;
    for (size_t i = 0; i < heads.size(); ++i) {
      if (waits[i]) ++passed_count[i];
      served.passed_count_max = std::max(served.passed_count_max, passed_count[i]);
    }
    now_ns += answer_ns + more_ns(random);
    queue.finish(key);
  }
  return served;
}

constexpr size_t kHeadCount = 8;
// Duration of an answer: 2.4 of eight heads at 90 Hz can be answered in each interval.
constexpr int64_t kAnswer_ns = 4'670'000;

TEST(ServerOfMovingHeads, answersFreshPosesOfHeadsThatMoveEachAtItsOwnTime) {
  std::vector<Head> heads(kHeadCount);
  for (size_t i = 0; i < heads.size(); ++i) {
    const double turns = double(i) * std::numbers::phi;
    heads[i].phase_ns = int64_t((turns - std::floor(turns)) * double(kHeadset_ns));
  }
  const Served served = serve(heads, kAnswer_ns);
  EXPECT_LE(served.ageNs(0.5), kHeadset_ns / 16);
  EXPECT_LE(served.ageNs(0.99), kHeadset_ns / 8);
  EXPECT_GE(served.busyShare(kAnswer_ns), 0.9) << "waits cost more than they should";
}

TEST(ServerOfMovingHeads, answersHeadsThatMoveAtOnceInTurn) {
  const Served served = serve(std::vector<Head>(kHeadCount), kAnswer_ns);
  EXPECT_LE(served.passed_count_max, kHeadCount);
}

// A server that waits for some heads keeps their phase. Another head's poses may never fit it.
TEST(ServerOfMovingHeads, answersOneWhosePosesNeverComeWhenSomebodyIsNext) {
  constexpr int64_t kInterval_ns = kSecond_ns / 60;
  const Served served =
      serve({{kInterval_ns, 0}, {kInterval_ns, 6'000'000}, {kInterval_ns, 6'200'000}}, 15'500'000);
  EXPECT_LT(served.passed_count_max, (kRoundsPassed + 2) * 3);
}

// Independent heads, all at 90 Hz or each at a random rate.
std::vector<Head> headsAtRandom(std::mt19937& random, bool is_any_rate) {
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Head> heads(kHeadCount);
  for (Head& head : heads) {
    if (is_any_rate) head.interval_ns = int64_t(double(kSecond_ns) / (60 + 84 * share(random)));
    head.phase_ns = int64_t(share(random) * double(head.interval_ns));
  }
  return heads;
}

// Prints the distribution of a value over several sets of heads.
void tell(const char* name, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::cout << name << ": half of the sets below " << values[values.size() / 2]
            << ", nine in ten below " << values[values.size() * 9 / 10] << ", all from "
            << values.front() << " to " << values.back() << "\n";
}

TEST(ServerOfMovingHeads, answersEverybodyWhateverTheirPhasesAndRates) {
  std::mt19937 random(2026);
  for (const bool is_any_rate : {false, true}) {
    std::vector<double> ages_ms, answers, unevenness, passed;
    for (int set = 0; set < 50; ++set) {
      SCOPED_TRACE(testing::Message() << set << (is_any_rate ? ", any rate" : ", 90 Hz"));
      const std::vector<Head> heads = headsAtRandom(random, is_any_rate);
      const int64_t longest_ns = std::ranges::max(heads, {}, &Head::interval_ns).interval_ns;
      const Served served = serve(heads, kAnswer_ns);
      EXPECT_LT(served.passed_count_max, (kRoundsPassed + 2) * kHeadCount);
      EXPECT_LE(served.ageNs(0.5), longest_ns / 8);
      EXPECT_LE(served.ageNs(0.99), longest_ns / 2);
      EXPECT_GE(served.busyShare(kAnswer_ns), 0.6);
      ages_ms.push_back(double(served.ageNs(0.99)) / double(kMs_ns));
      answers.push_back(served.answersPerSecond());
      unevenness.push_back(served.unevenness());
      passed.push_back(double(served.passed_count_max));
    }
    std::cout << (is_any_rate ? "60 to 144 Hz\n" : "90 Hz\n");
    tell("p99 of age, ms", ages_ms);
    tell("answers a second", answers);
    tell("luckiest to unluckiest", unevenness);
    tell("passed over at most", passed);
  }
}

}  // namespace
}  // namespace viewloom::answered_heads_test
