// SPDX-License-Identifier: Apache-2.0
#include "publish/broadcaster.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

#include "base/check.h"
#include "base/str_cat.h"
#include "publish/member.h"

namespace viewloom {
namespace {

struct WatchedDisplay {
  ActiveDisplayPtr active;
  std::string key;  // stream, picture and encoding
  std::vector<MemberPtr> members;
  std::shared_ptr<const AtlasLayout> layout;
  AtlasPtr newest;
  GrowingAtlasPtr growing;     // the newest that has begun, unless it is whole
  uint64_t last_sequence = 0;  // of all that have begun
  uint64_t atlas_count = 0;
};

}  // namespace

struct Broadcaster::State {
  explicit State(BroadcasterLimits given) : limits(given) {}

  const BroadcasterLimits limits;
  std::function<void(const std::string&)> on_demand_change;
  std::function<void(const std::string&)> on_eyes_served;

  mutable std::mutex mutex;  // guards what follows; never held while a subscriber is called
  bool is_draining = false;
  uint64_t next_id = 1;  // of displays and subscribers
  uint32_t subscriber_count = 0;
  std::map<uint64_t, WatchedDisplay> displays;  // by id
  std::map<std::string, uint64_t> id_of_key;

  absl::Status checkRoom(bool is_new_display) const;
  WatchedDisplay& openDisplay(ActiveDisplay display, const std::string& key);
  std::vector<MemberPtr> closeDisplay(uint64_t id);
  bool removeMember(uint64_t display_id, uint64_t subscriber_id, std::string& stream);
  void noteSubscriberCount(WatchedDisplay& display);
  void announce(const std::string& stream) const {
    if (on_demand_change) on_demand_change(stream);
  }
};

absl::Status Broadcaster::State::checkRoom(bool is_new_display) const {
  if (is_draining) return absl::UnavailableError("the server is shutting down; try again later");
  if (subscriber_count >= limits.subscriber_count_max) {
    return absl::ResourceExhaustedError(
        strCat("too many subscribers: this server accepts up to ", limits.subscriber_count_max,
               " viewers; close one, or raise limits.subscribers_max"));
  }
  if (is_new_display && displays.size() >= limits.display_count_max) {
    return absl::ResourceExhaustedError(
        strCat("too many distinct displays: this server accepts up to ", limits.display_count_max,
               "; choose one that is watched already, or raise limits.displays_max"));
  }
  return absl::OkStatus();
}

WatchedDisplay& Broadcaster::State::openDisplay(ActiveDisplay active, const std::string& key) {
  active.id = next_id++;
  id_of_key[key] = active.id;
  WatchedDisplay& display = displays[active.id];
  display.key = key;
  display.active = std::make_shared<ActiveDisplay>(std::move(active));
  return display;
}

// Snapshots are immutable: a changed count is a new snapshot.
void Broadcaster::State::noteSubscriberCount(WatchedDisplay& display) {
  auto changed = std::make_shared<ActiveDisplay>(*display.active);
  changed->subscriber_count = static_cast<uint32_t>(display.members.size());
  display.active = std::move(changed);
}

std::vector<MemberPtr> Broadcaster::State::closeDisplay(uint64_t id) {
  const auto found = displays.find(id);
  if (found == displays.end()) return {};
  std::vector<MemberPtr> members = std::move(found->second.members);
  subscriber_count -= static_cast<uint32_t>(members.size());
  id_of_key.erase(found->second.key);
  displays.erase(found);
  return members;
}

// True when the display went with its last member.
bool Broadcaster::State::removeMember(uint64_t display_id, uint64_t subscriber_id,
                                      std::string& stream) {
  std::lock_guard lock(mutex);
  const auto found = displays.find(display_id);
  if (found == displays.end()) return false;
  WatchedDisplay& display = found->second;
  std::erase_if(display.members, [&](const MemberPtr& member) {
    if (member->id() != subscriber_id) return false;
    member->leave();
    --subscriber_count;
    return true;
  });
  if (!display.members.empty()) {
    noteSubscriberCount(display);
    return false;
  }
  stream = display.active->stream;
  closeDisplay(display_id);
  return true;
}

Broadcaster::Broadcaster(BroadcasterLimits limits) : state_(std::make_shared<State>(limits)) {}

Broadcaster::~Broadcaster() = default;

absl::StatusOr<std::unique_ptr<Broadcaster::Subscription>> Broadcaster::subscribe(
    const std::string& stream, const DisplaySpec& spec, const EncodingSpec& encoding,
    std::shared_ptr<Subscriber> subscriber, EyeTrackPtr eyes) {
  VIEWLOOM_CHECK(isTracked(spec) == (eyes != nullptr));
  // A stream's name holds no blank, so that the parts cannot run into each other.
  std::string picture_key = strCat(stream, " ", displayKey(spec));
  MemberPtr member;
  AtlasPtr newest;
  GrowingAtlasPtr growing;
  uint64_t display_id = 0;
  {
    std::lock_guard lock(state_->mutex);
    if (eyes != nullptr) picture_key += strCat("of ", state_->next_id, " ");
    const std::string key = strCat(picture_key, encodingKey(encoding));
    const auto known = state_->id_of_key.find(key);
    const bool is_new = known == state_->id_of_key.end();
    VIEWLOOM_RETURN_IF_ERROR(state_->checkRoom(is_new));
    WatchedDisplay& display = is_new ? state_->openDisplay({.stream = stream,
                                                            .spec = spec,
                                                            .encoding = encoding,
                                                            .picture_key = std::move(picture_key),
                                                            .eyes = std::move(eyes)},
                                                           key)
                                     : state_->displays.at(known->second);
    member = std::make_shared<Member>(state_->next_id++, std::move(subscriber));
    display.members.push_back(member);
    ++state_->subscriber_count;
    state_->noteSubscriberCount(display);
    display_id = display.active->id;
    newest = display.newest;
    growing = display.growing;
  }
  auto subscription = std::make_unique<Subscription>(state_, display_id, member->id());
  if (newest != nullptr) {
    member->offer(newest);
  } else {
    state_->announce(stream);
  }
  if (growing != nullptr) member->begin(growing);
  return subscription;
}

void Broadcaster::onDemandChange(std::function<void(const std::string& stream)> callback) {
  state_->on_demand_change = std::move(callback);
}

void Broadcaster::onEyesServed(std::function<void(const std::string& stream)> callback) {
  state_->on_eyes_served = std::move(callback);
}

std::vector<ActiveDisplayPtr> Broadcaster::displays(const std::string& stream) const {
  std::lock_guard lock(state_->mutex);
  std::vector<ActiveDisplayPtr> wanted;
  for (const auto& [id, display] : state_->displays) {
    if (stream.empty() || display.active->stream == stream) wanted.push_back(display.active);
  }
  return wanted;
}

ActiveDisplayPtr Broadcaster::display(uint64_t display_id) const {
  std::lock_guard lock(state_->mutex);
  const auto found = state_->displays.find(display_id);
  return found == state_->displays.end() ? nullptr : found->second.active;
}

uint32_t Broadcaster::subscriberCount(const std::string& stream) const {
  uint32_t count = 0;
  for (const ActiveDisplayPtr& display : displays(stream)) count += display->subscriber_count;
  return count;
}

void Broadcaster::noteLayout(uint64_t display_id, std::shared_ptr<const AtlasLayout> layout) {
  std::lock_guard lock(state_->mutex);
  const auto found = state_->displays.find(display_id);
  if (found != state_->displays.end()) found->second.layout.swap(layout);
}

std::shared_ptr<const AtlasLayout> Broadcaster::layout(uint64_t display_id) const {
  std::lock_guard lock(state_->mutex);
  const auto found = state_->displays.find(display_id);
  return found == state_->displays.end() ? nullptr : found->second.layout;
}

void Broadcaster::begin(const GrowingAtlasPtr& atlas) {
  std::vector<MemberPtr> members;
  GrowingAtlasPtr previous;  // freed after the lock
  {
    std::lock_guard lock(state_->mutex);
    const auto found = state_->displays.find(atlas->atlas().display_id);
    if (found == state_->displays.end()) return;
    WatchedDisplay& display = found->second;
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
    const auto found = state_->displays.find(atlas->display_id);
    if (found == state_->displays.end()) return;
    WatchedDisplay& display = found->second;
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
    members = state_->closeDisplay(display_id);
  }
  for (const MemberPtr& member : members) member->end(status);
}

AtlasPtr Broadcaster::newest(uint64_t display_id) const {
  std::lock_guard lock(state_->mutex);
  const auto found = state_->displays.find(display_id);
  return found == state_->displays.end() ? nullptr : found->second.newest;
}

uint64_t Broadcaster::nextSequence(uint64_t display_id) const {
  std::lock_guard lock(state_->mutex);
  const auto found = state_->displays.find(display_id);
  return found == state_->displays.end() ? 1 : found->second.last_sequence + 1;
}

uint64_t Broadcaster::atlasCount(uint64_t display_id) const {
  std::lock_guard lock(state_->mutex);
  const auto found = state_->displays.find(display_id);
  return found == state_->displays.end() ? 0 : found->second.atlas_count;
}

void Broadcaster::drain() {
  std::vector<MemberPtr> members;
  {
    std::lock_guard lock(state_->mutex);
    state_->is_draining = true;
    while (!state_->displays.empty()) {
      for (MemberPtr& member : state_->closeDisplay(state_->displays.begin()->first)) {
        members.push_back(std::move(member));
      }
    }
  }
  for (const MemberPtr& member : members) member->end(absl::OkStatus());
}

Broadcaster::Subscription::Subscription(std::shared_ptr<State> state, uint64_t display_id,
                                        uint64_t subscriber_id)
    : state_(std::move(state)), display_id_(display_id), subscriber_id_(subscriber_id) {}

Broadcaster::Subscription::~Subscription() {
  std::string stream;
  if (state_->removeMember(display_id_, subscriber_id_, stream)) state_->announce(stream);
}

}  // namespace viewloom
