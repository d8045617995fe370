// SPDX-License-Identifier: Apache-2.0
// Parts of the server that a publisher holds, besides its frames.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "access/caller.h"
#include "admission/memory_budget.h"
#include "publish/stream_directory.h"
#include "viewloom/v1/ingest_service.pb.h"

namespace viewloom {

// Given back by the destructor.
struct PublishPlace {
  QuotaPartPtr quota;  // of the caller; null = it has none
  Reservation memory;  // of the call
  std::unique_ptr<StreamDirectory::Claim> claim;
};

// Takes the stream that the settings name, for a caller at `host` who may use it. Errors as of
// StreamDirectory::claim and Caller::holdStream, and RESOURCE_EXHAUSTED without memory; they name
// the field of the settings.
absl::StatusOr<PublishPlace> takePublishPlace(const v1::PublishSettings& settings,
                                              const Caller& caller, const std::string& host,
                                              std::function<void()> on_takeover,
                                              StreamDirectory& directory, MemoryBudget& memory);

}  // namespace viewloom
