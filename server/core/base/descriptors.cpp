// SPDX-License-Identifier: Apache-2.0
#include "base/descriptors.h"

#include <sys/resource.h>

#include <algorithm>

namespace viewloom {
namespace {

uint32_t shareOf(uint64_t room, uint64_t wanted, uint64_t wanted_by_all) {
  return static_cast<uint32_t>(std::max<uint64_t>(room * wanted / wanted_by_all, 1));
}

}  // namespace

uint64_t raiseDescriptorLimit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < limit.rlim_max) {
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_NOFILE, &limit);  // what holds afterwards is asked for anyway
  }
  return descriptorLimit();
}

uint64_t descriptorLimit() {
  rlimit limit{};
  getrlimit(RLIMIT_NOFILE, &limit);
  return limit.rlim_cur;
}

ConnectionShares shareDescriptors(uint64_t limit, const ConnectionShares& wanted) {
  const uint64_t wanted_by_both = uint64_t{wanted.grpc} + wanted.http;
  const uint64_t room = limit > kOwnDescriptors ? limit - kOwnDescriptors : 0;
  if (wanted_by_both <= room) return wanted;
  return {.grpc = shareOf(room, wanted.grpc, wanted_by_both),
          .http = shareOf(room, wanted.http, wanted_by_both)};
}

}  // namespace viewloom
