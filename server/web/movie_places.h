// SPDX-License-Identifier: Apache-2.0
// Places of live videos, each of which costs an encoder.
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>

namespace viewloom {

// Whoever holds the most places gives one to somebody who would still hold fewer. So no client
// keeps all others out. Thread-safety: all methods may be called from any thread.
class MoviePlaces {
 public:
  // Given back by the destructor, which may run after the places are gone.
  class Place;
  using PlacePtr = std::unique_ptr<Place>;

  explicit MoviePlaces(uint32_t count_max);

  // nullptr: all are taken. `leave` is called at most once, on the thread of another's take(), when
  // the place has gone to that; it must not block, and may be called after the place is given back.
  PlacePtr take(const std::string& identity, std::function<void()> leave);

 private:
  struct Held;
  struct State;

  const std::shared_ptr<State> state_;
};

class MoviePlaces::Place {
 public:
  ~Place();
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

 private:
  friend class MoviePlaces;
  explicit Place(std::shared_ptr<State> state);

  const std::shared_ptr<State> state_;
  uint64_t id_ = 0;  // 0 = it has none
};

}  // namespace viewloom
