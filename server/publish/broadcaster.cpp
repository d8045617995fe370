// SPDX-License-Identifier: Apache-2.0
#include "publish/broadcaster.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "base/check.h"
#include "base/str_cat.h"
#include "publish/watched_displays.h"

namespace viewloom {
namespace {

std::shared_ptr<DisplayCoding> codingOf(const EncodingSpec& encoding) {
  return adaptsToLines(encoding) ? std::make_shared<DisplayCoding>(encoding) : nullptr;
}

std::shared_ptr<AtlasChain> chainOf(const EncodingSpec& encoding) {
  return isChained(encoding) ? std::make_shared<AtlasChain>() : nullptr;
}

}  // namespace

struct Broadcaster::State {
  State(BroadcasterLimits limits, MemoryBudget& budget) : memory(budget), displays(limits) {}

  MemoryBudget& memory;
  std::function<void(const std::string&)> on_demand_change;
  std::function<void(const std::string&)> on_eyes_served;

  mutable std::mutex mutex;  // guards what follows; never held while a subscriber is called
  bool is_draining = false;
  WatchedDisplays displays;

  absl::Status checkRoom(bool opens_display, const WatcherPlace& left) const {
    if (is_draining) return absl::UnavailableError("the server is shutting down; try again later");
    return displays.checkRoom(opens_display, left);
  }
  uint64_t takeId() {
    std::lock_guard lock(mutex);
    return displays.takeId();
  }
  absl::StatusOr<Seat> admit(const ActiveDisplay& display, const std::string& key,
                             const Subscriber& subscriber, const WatcherPlace& left) const;
  struct Joined;
  absl::StatusOr<std::optional<Joined>> join(const ActiveDisplay& display, const std::string& key,
                                             const std::shared_ptr<Subscriber>& subscriber,
                                             Seat& seat, const WatcherPlace& left);
  void announce(const std::string& stream) const {
    if (on_demand_change) on_demand_change(stream);
  }
};

// A viewer at its place, and what there is to tell it.
struct Broadcaster::State::Joined {
  MemberPtr member;
  ActiveDisplayPtr display;
  AtlasPtr newest;
  GrowingAtlasPtr growing;
  std::string left;  // stream of the display that has gone with the place left; else empty
};

// Without the lock while memory is asked for: idle memory may have to be given up for it, whose
// owner may ask this broadcaster.
absl::StatusOr<Seat> Broadcaster::State::admit(const ActiveDisplay& display, const std::string& key,
                                               const Subscriber& subscriber,
                                               const WatcherPlace& left) const {
  bool opens = false;
  {
    std::lock_guard lock(mutex);
    opens = !displays.isOpen(key);
    VIEWLOOM_RETURN_IF_ERROR(checkRoom(opens, left));
  }
  return admitSeat(memory, display.spec, display.encoding, subscriber.identity(), opens);
}

// None = the display has been closed since the seat was admitted.
absl::StatusOr<std::optional<Broadcaster::State::Joined>> Broadcaster::State::join(
    const ActiveDisplay& display, const std::string& key,
    const std::shared_ptr<Subscriber>& subscriber, Seat& seat, const WatcherPlace& left) {
  std::lock_guard lock(mutex);
  const bool is_open = displays.isOpen(key);
  if (!is_open && !seat.opens) return std::nullopt;
  VIEWLOOM_RETURN_IF_ERROR(checkRoom(!is_open, left));
  auto member = std::make_shared<Member>(displays.takeId(), subscriber, std::move(seat.viewer));
  WatchedDisplay& joined =
      is_open ? displays.at(key) : displays.open(display, key, std::move(seat.display));
  displays.add(joined, member);
  std::string left_stream;
  displays.remove(left.display_id, left.member_id, left_stream);
  return Joined{std::move(member), joined.active, joined.newest, joined.growing,
                std::move(left_stream)};
}

Broadcaster::Broadcaster(BroadcasterLimits limits, MemoryBudget& memory)
    : state_(std::make_shared<State>(limits, memory)) {}

Broadcaster::~Broadcaster() = default;

absl::StatusOr<std::unique_ptr<Broadcaster::Subscription>> Broadcaster::subscribe(
    const std::string& stream, const DisplaySpec& spec, const EncodingSpec& encoding,
    std::shared_ptr<Subscriber> subscriber, EyeTrackPtr eyes, const Subscription* replaced) {
  VIEWLOOM_CHECK(isTracked(spec) == (eyes != nullptr));
  // A stream's name holds no blank, so that the parts cannot run into each other.
  std::string picture_key = strCat(stream, " ", displayKey(spec), arrangementKey(encoding));
  if (eyes != nullptr) picture_key += strCat("of ", state_->takeId(), " ");
  const std::string key = strCat(picture_key, encodingKey(encoding));
  const ActiveDisplay display{.stream = stream,
                              .spec = spec,
                              .encoding = encoding,
                              .picture_key = std::move(picture_key),
                              .eyes = std::move(eyes),
                              .coding = codingOf(encoding),
                              .chain = chainOf(encoding)};
  WatcherPlace left;
  if (replaced != nullptr) left = {replaced->displayId(), replaced->subscriberId()};
  std::optional<State::Joined> joined;
  while (!joined) {
    absl::StatusOr<Seat> seat = state_->admit(display, key, *subscriber, left);
    VIEWLOOM_RETURN_IF_ERROR(seat.status());
    absl::StatusOr<std::optional<State::Joined>> tried =
        state_->join(display, key, subscriber, *seat, left);
    VIEWLOOM_RETURN_IF_ERROR(tried.status());
    joined = *std::move(tried);
  }
  auto subscription =
      std::make_unique<Subscription>(state_, *joined->display, joined->member->id());
  if (joined->newest != nullptr && joined->newest->reference_sequence == 0) {
    joined->member->offer(joined->newest);
  } else {
    if (joined->newest != nullptr) joined->display->chain->wantAtOnce();
    state_->announce(stream);
  }
  if (!joined->left.empty()) state_->announce(joined->left);
  if (joined->growing != nullptr) joined->member->begin(joined->growing);
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

Broadcaster::Subscription::Subscription(std::shared_ptr<State> state, const ActiveDisplay& display,
                                        uint64_t subscriber_id)
    : state_(std::move(state)),
      display_id_(display.id),
      subscriber_id_(subscriber_id),
      coding_(display.coding),
      chain_(display.chain) {
  if (coding_) coding_->join(subscriber_id_);
}

Broadcaster::Subscription::~Subscription() {
  if (coding_) coding_->leave(subscriber_id_);
  std::string stream;
  bool was_last = false;
  {
    std::lock_guard lock(state_->mutex);
    was_last = state_->displays.remove(display_id_, subscriber_id_, stream);
  }
  if (was_last) state_->announce(stream);
}

}  // namespace viewloom
