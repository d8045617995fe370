// SPDX-License-Identifier: Apache-2.0
#include "schedule/fair_shares.h"

#include <algorithm>

#include "base/cost_estimate.h"

namespace viewloom {
namespace {

// Most that are remembered: payers, streams of one payer, displays of one stream. No budget counts
// them, and clients choose the names of streams and the pictures of displays.
constexpr size_t kKeptPayers = 1024;
constexpr size_t kKeptStreams = 64;
constexpr size_t kKeptDisplays = 128;

const Payer kServer;

template <typename Map, typename Key>
auto* findIn(Map& map, const Key& key) {
  const auto found = map.find(key);
  return found == map.end() ? nullptr : &found->second;
}

// Keeps the candidates that start no more than `slack_ns` after the first one.
template <typename Candidates>
void keepEarliest(Candidates& candidates, int64_t slack_ns) {
  const auto startOf = [](const auto& candidate) { return candidate.start_ns; };
  const int64_t least_ns = startOf(*std::ranges::min_element(candidates, {}, startOf));
  std::erase_if(candidates,
                [&](const auto& candidate) { return candidate.start_ns > least_ns + slack_ns; });
}

template <typename Candidates>
const auto& soonest(const Candidates& candidates) {
  return *std::ranges::min_element(
      candidates, {}, [](const auto& candidate) { return candidate.claim->deadline_ns; });
}

// Forgets the half with the least debts. Debts are small beside kCredit_ns: whoever has one is not
// served before the others.
template <typename Map>
void forgetHalf(Map& nodes) {
  std::vector<int64_t> finishes_ns;
  finishes_ns.reserve(nodes.size());
  for (const auto& [key, node] : nodes) finishes_ns.push_back(node.finish_ns);
  const auto middle = finishes_ns.begin() + std::ptrdiff_t(finishes_ns.size() / 2);
  std::ranges::nth_element(finishes_ns, middle);
  std::erase_if(nodes, [&](const auto& entry) { return entry.second.finish_ns <= *middle; });
}

// The node of a key, which may be new.
template <typename Map>
auto& nodeOf(Map& nodes, const typename Map::key_type& key, size_t kept_count) {
  const auto found = nodes.find(key);
  if (found != nodes.end()) return found->second;
  if (nodes.size() >= kept_count) forgetHalf(nodes);
  return nodes[key];
}

}  // namespace

int64_t FairShares::Level::startOf(const Node& node) const {
  return std::max(node.finish_ns, now_ns - kCredit_ns);
}

void FairShares::Level::move(Node& node, int64_t time_ns) {
  const int64_t start_ns = startOf(node);
  node.finish_ns = start_ns + time_ns;
  now_ns = std::max(now_ns, start_ns);
}

const FairShares::Account* FairShares::find(const Payer& payer) const {
  return findIn(accounts_, payer);
}

FairShares::Place FairShares::placeOf(const Payer& payer) const {
  const Account* const account = find(payer);
  return {level_.startOf(account), account == nullptr ? 0 : account->finish_ns};
}

const Payer& FairShares::payerOf(const Claim& claim) const {
  if (claim.payers.empty()) return kServer;
  return *std::ranges::min_element(claim.payers, {},
                                   [&](const Payer& payer) { return placeOf(payer); });
}

std::optional<size_t> FairShares::nextOf(const std::vector<const Claim*>& claims) const {
  const auto waits = [](const Claim* claim) { return claim != nullptr; };
  const auto only = std::ranges::find_if(claims, waits);
  if (only == claims.end()) return std::nullopt;
  if (std::none_of(only + 1, claims.end(), waits)) return size_t(only - claims.begin());
  std::lock_guard lock(mutex_);
  return choose(claims);
}

bool FairShares::goesBefore(const Claim& first, const Claim& second) const {
  return nextOf({&second, &first}) == 1U;
}

bool FairShares::hasHadLess(const Claim& first, const Claim& second) const {
  std::lock_guard lock(mutex_);
  return placeOf(payerOf(first)) < placeOf(payerOf(second));
}

std::optional<size_t> FairShares::choose(const std::vector<const Claim*>& claims) const {
  std::vector<Candidate> candidates;
  for (size_t i = 0; i < claims.size(); ++i) {
    if (claims[i] == nullptr) continue;
    const Payer& payer = payerOf(*claims[i]);
    candidates.push_back({i, claims[i], &payer, placeOf(payer)});
  }
  // If two identities have equal shares, the one goes first that is asked about first.
  const Payer payer = *std::ranges::min_element(candidates, {}, &Candidate::place)->payer;
  std::erase_if(candidates, [&](const Candidate& candidate) { return *candidate.payer != payer; });
  const Account* const account = find(payer);
  keepTurnOfEyes(account, candidates);
  keepOneStream(account, candidates);
  keepLeastDisplays(account, candidates);
  return soonest(candidates).index;
}

void FairShares::keepTurnOfEyes(const Account* account, std::vector<Candidate>& candidates) {
  const auto isTracked = [](const Candidate& candidate) { return candidate.claim->is_tracked; };
  const auto tracked_count = size_t(std::ranges::count_if(candidates, isTracked));
  if (tracked_count == 0 || tracked_count == candidates.size()) return;
  const bool is_others_turn = account != nullptr && account->eyes.isOver();
  std::erase_if(candidates,
                [&](const Candidate& candidate) { return isTracked(candidate) == is_others_turn; });
}

// If two streams have equal shares, the one goes first whose deadline is sooner.
void FairShares::keepOneStream(const Account* account, std::vector<Candidate>& candidates) {
  if (candidates.size() == 1) return;
  if (account != nullptr) {
    for (Candidate& candidate : candidates) {
      candidate.start_ns =
          account->level.startOf(findIn(account->streams, candidate.claim->stream));
    }
    keepEarliest(candidates, 0);
  }
  const std::string& stream = soonest(candidates).claim->stream;
  std::erase_if(candidates,
                [&](const Candidate& candidate) { return candidate.claim->stream != stream; });
}

void FairShares::keepLeastDisplays(const Account* account, std::vector<Candidate>& candidates) {
  if (account == nullptr || candidates.size() == 1) return;
  const Stream* const stream = findIn(account->streams, candidates.front().claim->stream);
  if (stream == nullptr) return;
  for (Candidate& candidate : candidates) {
    candidate.start_ns = stream->level.placeOf(findIn(stream->displays, candidate.claim->display));
  }
  keepEarliest(candidates, kInOrder_ns);
}

FairShares::Account& FairShares::accountOf(const Payer& payer) {
  return nodeOf(accounts_, payer, kKeptPayers);
}

FairShares::Stream& FairShares::streamOf(Account& account, const Claim& claim) {
  return nodeOf(account.streams, claim.stream, kKeptStreams);
}

FairShares::Node& FairShares::displayOf(Stream& stream, const Claim& claim) {
  return nodeOf(stream.displays, claim.display, kKeptDisplays);
}

void FairShares::move(const Claim& claim, int64_t time_ns) {
  Account& account = accountOf(payerOf(claim));
  level_.move(account, time_ns);
  Stream& stream = streamOf(account, claim);
  account.level.move(stream, time_ns);
  stream.level.move(displayOf(stream, claim), time_ns);
}

void FairShares::enter(const Claim& claim) {
  std::lock_guard lock(mutex_);
  const Payers payers = claim.payers.empty() ? Payers{kServer} : claim.payers;
  for (const Payer& payer : payers) {
    Stream& stream = streamOf(accountOf(payer), claim);
    Node& display = displayOf(stream, claim);
    display.finish_ns = stream.level.startOf(display);
  }
}

void FairShares::begin(const Claim& claim, int64_t predicted_ns) {
  std::lock_guard lock(mutex_);
  move(claim, predicted_ns);
}

// Corrects the prediction. Where several pay, others may have come first since the piece began: the
// correction is then theirs, and they have the next piece.
void FairShares::finish(const Claim& claim, int64_t predicted_ns, int64_t measured_ns) {
  std::lock_guard lock(mutex_);
  Account& account = accountOf(payerOf(claim));
  const int64_t paid_ns = std::min(measured_ns, kPaidMax * std::max(predicted_ns, kPiece_ns));
  const int64_t more_ns = paid_ns - predicted_ns;
  account.eyes.note(claim.is_tracked, paid_ns);
  account.finish_ns += more_ns;
  Stream& stream = streamOf(account, claim);
  stream.finish_ns += more_ns;
  displayOf(stream, claim).finish_ns += more_ns;
}

}  // namespace viewloom
