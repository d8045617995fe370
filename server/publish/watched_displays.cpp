// SPDX-License-Identifier: Apache-2.0
#include "publish/watched_displays.h"

#include <algorithm>
#include <set>
#include <utility>

#include "admission/display_price.h"
#include "base/str_cat.h"

namespace viewloom {

absl::StatusOr<Seat> admitSeat(MemoryBudget& memory, const DisplaySpec& spec,
                               const EncodingSpec& encoding, const std::string& identity,
                               bool opens) {
  Seat seat{.opens = opens, .display = {}, .viewer = {}};
  if (opens) {
    absl::StatusOr<Reservation> display = admitDisplay(memory, spec, encoding, identity);
    VIEWLOOM_RETURN_IF_ERROR(display.status());
    seat.display = *std::move(display);
  }
  absl::StatusOr<Reservation> viewer = admitViewer(memory, spec, encoding, identity);
  VIEWLOOM_RETURN_IF_ERROR(viewer.status());
  seat.viewer = *std::move(viewer);
  return seat;
}

absl::Status WatchedDisplays::checkRoom(bool opens_display, const WatcherPlace& left) const {
  const WatchedDisplay* const before = find(left.display_id);
  const bool leaves =
      before != nullptr && std::ranges::any_of(before->members, [&](const auto& it) {
        return it->id() == left.subscriber_id;
      });
  const uint32_t left_members = leaves ? 1 : 0;
  const size_t left_displays = leaves && before->members.size() == 1 ? 1 : 0;
  if (member_count_ - left_members >= limits_.subscriber_count_max) {
    return absl::ResourceExhaustedError(
        strCat("too many subscribers: this server accepts up to ", limits_.subscriber_count_max,
               " viewers; close one, or raise limits.subscribers_max"));
  }
  if (opens_display && displays_.size() - left_displays >= limits_.display_count_max) {
    return absl::ResourceExhaustedError(
        strCat("too many distinct displays: this server accepts up to ", limits_.display_count_max,
               "; choose one that is watched already, or raise limits.displays_max"));
  }
  return absl::OkStatus();
}

WatchedDisplay& WatchedDisplays::open(ActiveDisplay active, const std::string& key,
                                      Reservation memory) {
  active.id = takeId();
  id_of_key_[key] = active.id;
  WatchedDisplay& display = displays_[active.id];
  display.key = key;
  display.memory = std::move(memory);
  display.active = std::make_shared<ActiveDisplay>(std::move(active));
  return display;
}

WatchedDisplay* WatchedDisplays::find(uint64_t id) {
  const auto found = displays_.find(id);
  return found == displays_.end() ? nullptr : &found->second;
}

const WatchedDisplay* WatchedDisplays::find(uint64_t id) const {
  const auto found = displays_.find(id);
  return found == displays_.end() ? nullptr : &found->second;
}

// Snapshots are immutable: changed members are a new snapshot.
void WatchedDisplays::noteMembers(WatchedDisplay& display) {
  auto changed = std::make_shared<ActiveDisplay>(*display.active);
  changed->subscriber_count = static_cast<uint32_t>(display.members.size());
  std::set<Payer> viewers;
  for (const MemberPtr& member : display.members) viewers.insert(member->payer());
  changed->viewers.assign(viewers.begin(), viewers.end());
  display.active = std::move(changed);
}

void WatchedDisplays::add(WatchedDisplay& display, MemberPtr member) {
  display.members.push_back(std::move(member));
  ++member_count_;
  noteMembers(display);
}

bool WatchedDisplays::remove(const WatcherPlace& place, std::string& stream) {
  WatchedDisplay* const display = find(place.display_id);
  if (display == nullptr) return false;
  std::erase_if(display->members, [&](const MemberPtr& member) {
    if (member->id() != place.subscriber_id) return false;
    member->leave();
    --member_count_;
    return true;
  });
  if (!display->members.empty()) {
    noteMembers(*display);
    return false;
  }
  stream = display->active->stream;
  close(place.display_id);
  return true;
}

std::vector<MemberPtr> WatchedDisplays::close(uint64_t id) {
  const auto found = displays_.find(id);
  if (found == displays_.end()) return {};
  std::vector<MemberPtr> members = std::move(found->second.members);
  member_count_ -= static_cast<uint32_t>(members.size());
  id_of_key_.erase(found->second.key);
  displays_.erase(found);
  return members;
}

}  // namespace viewloom
