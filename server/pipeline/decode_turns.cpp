// SPDX-License-Identifier: Apache-2.0
#include "pipeline/decode_turns.h"

#include "pipeline/within_memory.h"

namespace viewloom {
namespace {

Claim claimToDecode(const FrameOrigin& origin) {
  return {.payers = {origin.publisher}, .stream = origin.stream};
}

}  // namespace

size_t turnToDecode(const FairShares& shares, const std::vector<FrameOrigin>& waiting) {
  if (waiting.size() == 1) return 0;
  std::vector<Claim> claims;
  claims.reserve(waiting.size());
  for (const FrameOrigin& origin : waiting) claims.push_back(claimToDecode(origin));
  const Claim* const next = shares.next(claims, [](const Claim& claim) { return &claim; });
  return size_t(next - claims.data());
}

void payForDecoding(FairShares& shares, const FrameOrigin& origin, int64_t cpu_ns) {
  withinMemory([&] { shares.begin(claimToDecode(origin), cpu_ns); }).IgnoreError();
}

}  // namespace viewloom
