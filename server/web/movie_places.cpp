// SPDX-License-Identifier: Apache-2.0
#include "web/movie_places.h"

#include <algorithm>
#include <utility>

namespace viewloom {

struct MoviePlaces::Held {
  uint64_t id = 0;
  std::string identity;
  std::function<void()> leave;
};

struct MoviePlaces::State {
  explicit State(uint32_t most) : count_max(most) {}

  const size_t count_max;
  std::mutex mutex;      // guards what follows
  std::list<Held> held;  // newest first
  uint64_t last_id = 0;

  size_t countOf(const std::string& identity) const {
    return size_t(std::ranges::count(held, identity, &Held::identity));
  }
  // The newest place of whoever has most of them, if that leaves no fewer than `identity` then has.
  std::list<Held>::iterator spare(const std::string& identity) {
    const auto most = std::ranges::max_element(
        held, {}, [this](const Held& place) { return countOf(place.identity); });
    const bool is_fairer = most != held.end() && countOf(most->identity) > countOf(identity) + 1;
    return is_fairer ? most : held.end();
  }
};

MoviePlaces::MoviePlaces(uint32_t count_max) : state_(std::make_shared<State>(count_max)) {}

MoviePlaces::PlacePtr MoviePlaces::take(const std::string& identity, std::function<void()> leave) {
  std::list<Held> made;
  made.push_front({.identity = identity, .leave = std::move(leave)});
  std::list<Held> left;  // let go after the lock
  PlacePtr place(new Place(state_));
  std::unique_lock lock(state_->mutex);
  if (state_->held.size() >= state_->count_max) {
    const auto spare = state_->spare(identity);
    if (spare == state_->held.end()) return nullptr;
    left.splice(left.begin(), state_->held, spare);
  }
  made.front().id = place->id_ = ++state_->last_id;
  state_->held.splice(state_->held.begin(), made);
  lock.unlock();
  if (!left.empty()) left.front().leave();
  return place;
}

MoviePlaces::Place::Place(std::shared_ptr<State> state) : state_(std::move(state)) {}

MoviePlaces::Place::~Place() {
  std::list<Held> left;  // let go after the lock
  std::lock_guard lock(state_->mutex);
  const auto mine = std::ranges::find(state_->held, id_, &Held::id);
  if (mine != state_->held.end()) left.splice(left.begin(), state_->held, mine);
}

}  // namespace viewloom
