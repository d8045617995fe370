// SPDX-License-Identifier: Apache-2.0
#include "rpc/publish_place.h"

#include <utility>

#include "admission/display_price.h"

namespace viewloom {

absl::StatusOr<PublishPlace> takePublishPlace(const v1::PublishSettings& settings,
                                              const Caller& caller, const std::string& host,
                                              std::function<void()> on_takeover,
                                              StreamDirectory& directory, MemoryBudget& memory) {
  auto quota = caller.holdStream(settings.stream());
  VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(quota.status(), "settings"));
  auto reserved = memory.reserve({.use = MemoryUse::kConnections,
                                  .identity = caller.shareName(host),
                                  .bytes = kConnectionBytes},
                                 "a stream", [](uint64_t) { return ""; });
  VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(reserved.status(), "settings.stream"));
  auto claim =
      directory.claim(settings.stream(), settings.session_id(), std::move(on_takeover), host);
  if (!claim.ok()) {
    const bool named = !fieldOf(claim.status()).empty();
    return named ? claim.status() : withFieldPrefix(claim.status(), "settings.stream");
  }
  return PublishPlace{
      .quota = *std::move(quota), .memory = *std::move(reserved), .claim = *std::move(claim)};
}

}  // namespace viewloom
