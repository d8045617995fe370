// SPDX-License-Identifier: Apache-2.0
#include "publish/broadcaster.h"

#include <algorithm>
#include <set>
#include <utility>

#include "base/check.h"
#include "publish/broadcaster_state.h"

namespace viewloom {

Broadcaster::Broadcaster(BroadcasterLimits limits, MemoryBudget& memory, CodingRoom& coding_room)
    : state_(std::make_shared<State>(limits, memory, coding_room)) {}

Broadcaster::~Broadcaster() = default;

void Broadcaster::onDemandChange(std::function<void(const std::string& stream)> callback) {
  state_->on_demand_change = std::move(callback);
}

void Broadcaster::onEyesServed(std::function<void(const std::string& stream)> callback) {
  state_->on_eyes_served = std::move(callback);
}

std::vector<ActiveDisplayPtr> Broadcaster::displays(const std::string& stream) const {
  std::lock_guard lock(state_->mutex);
  std::vector<ActiveDisplayPtr> wanted;
  for (const auto& [id, display] : state_->displays.all()) {
    if (stream.empty() || display.active->stream == stream) wanted.push_back(display.active);
  }
  return wanted;
}

ActiveDisplayPtr Broadcaster::display(uint64_t display_id) const {
  std::lock_guard lock(state_->mutex);
  WatchedDisplay* const found = state_->displays.find(display_id);
  return found == nullptr ? nullptr : found->active;
}

uint32_t Broadcaster::subscriberCount(const std::string& stream) const {
  uint32_t count = 0;
  for (const ActiveDisplayPtr& display : displays(stream)) count += display->subscriber_count;
  return count;
}

void Broadcaster::noteLayout(uint64_t display_id, std::shared_ptr<const AtlasLayout> layout) {
  std::lock_guard lock(state_->mutex);
  WatchedDisplay* const found = state_->displays.find(display_id);
  if (found != nullptr) found->layout.swap(layout);
}

std::shared_ptr<const AtlasLayout> Broadcaster::layout(uint64_t display_id) const {
  std::lock_guard lock(state_->mutex);
  WatchedDisplay* const found = state_->displays.find(display_id);
  return found == nullptr ? nullptr : found->layout;
}

void Broadcaster::begin(const GrowingAtlasPtr& atlas) {
  std::vector<MemberPtr> members;
  GrowingAtlasPtr previous;  // freed after the lock
  {
    std::lock_guard lock(state_->mutex);
    WatchedDisplay* const found = state_->displays.find(atlas->atlas().display_id);
    if (found == nullptr) return;
    WatchedDisplay& display = *found;
    VIEWLOOM_CHECK(atlas->atlas().sequence > display.last_sequence);
    display.last_sequence = atlas->atlas().sequence;
    previous = std::exchange(display.growing, atlas);
    members = display.members;
  }
  for (const MemberPtr& member : members) member->begin(atlas);
}

void Broadcaster::publish(const AtlasPtr& atlas) {
  std::vector<MemberPtr> members;
  std::string stream;
  AtlasPtr previous;           // freed after the lock
  GrowingAtlasPtr has_become;  // the same
  {
    std::lock_guard lock(state_->mutex);
    WatchedDisplay* const found = state_->displays.find(atlas->display_id);
    if (found == nullptr) return;
    WatchedDisplay& display = *found;
    VIEWLOOM_CHECK(display.newest == nullptr || atlas->sequence > display.newest->sequence);
    previous = std::exchange(display.newest, atlas);
    display.last_sequence = std::max(display.last_sequence, atlas->sequence);
    if (display.growing && display.growing->atlas().sequence <= atlas->sequence) {
      has_become.swap(display.growing);
    }
    ++display.atlas_count;
    members = display.members;
    stream = display.active->stream;
  }
  for (const MemberPtr& member : members) member->offer(atlas);
  const bool is_by_eyes = atlas->eye_poses_latched_ns != 0;
  if (is_by_eyes && state_->on_eyes_served) state_->on_eyes_served(stream);
}

void Broadcaster::refuse(uint64_t display_id, const absl::Status& status) {
  std::vector<MemberPtr> members;
  {
    std::lock_guard lock(state_->mutex);
    members = state_->displays.close(display_id);
  }
  for (const MemberPtr& member : members) member->end(status);
}

AtlasPtr Broadcaster::newest(uint64_t display_id) const {
  std::lock_guard lock(state_->mutex);
  WatchedDisplay* const found = state_->displays.find(display_id);
  return found == nullptr ? nullptr : found->newest;
}

uint64_t Broadcaster::nextSequence(uint64_t display_id) const {
  std::lock_guard lock(state_->mutex);
  WatchedDisplay* const found = state_->displays.find(display_id);
  return found == nullptr ? 1 : found->last_sequence + 1;
}

uint64_t Broadcaster::atlasCount(uint64_t display_id) const {
  std::lock_guard lock(state_->mutex);
  WatchedDisplay* const found = state_->displays.find(display_id);
  return found == nullptr ? 0 : found->atlas_count;
}

void Broadcaster::remakeStanding(int64_t now_ns) {
  state_->coding_room.look(now_ns);
  std::set<std::string> streams;
  for (const ActiveDisplayPtr& display : displays("")) {
    const bool wants_finer = display->coding && display->coding->wantsFiner(now_ns);
    const bool wants_again = display->chain && display->chain->wantsAgain(now_ns);
    if (wants_finer || wants_again) streams.insert(display->stream);
  }
  for (const std::string& stream : streams) state_->announce(stream);
}

void Broadcaster::drain() {
  std::vector<MemberPtr> members;
  {
    std::lock_guard lock(state_->mutex);
    state_->is_draining = true;
    while (!state_->displays.all().empty()) {
      for (MemberPtr& member : state_->displays.close(state_->displays.all().begin()->first)) {
        members.push_back(std::move(member));
      }
    }
  }
  for (const MemberPtr& member : members) member->end(absl::OkStatus());
}

}  // namespace viewloom
