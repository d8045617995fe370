// SPDX-License-Identifier: Apache-2.0
#include "web/atlas_inbox.h"

#include <utility>

namespace viewloom {

AtlasInbox::AtlasInbox(const Clock& clock, Counter replaced, std::function<void()> on_change)
    : clock_(clock), replaced_(replaced), on_change_(std::move(on_change)) {}

void AtlasInbox::offer(AtlasPtr atlas) {
  if (mailbox_.push({std::move(atlas), clock_.nowNs()})) replaced_.add();
  on_change_();
}

void AtlasInbox::end(const absl::Status& status) {
  {
    std::lock_guard lock(mutex_);
    ended_ = status;
  }
  on_change_();
}

std::optional<absl::Status> AtlasInbox::ended() const {
  std::lock_guard lock(mutex_);
  return ended_;
}

}  // namespace viewloom
