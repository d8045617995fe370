// SPDX-License-Identifier: Apache-2.0
// Viewers of each display of each stream; hands every atlas to all of them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "admission/coding_room.h"
#include "admission/memory_budget.h"
#include "base/payer.h"
#include "base/status.h"
#include "display/display_spec.h"
#include "eye_poses/eye_track.h"
#include "publish/atlas_chain.h"
#include "publish/display_coding.h"
#include "publish/subscriber.h"

namespace viewloom {

// A display that is watched now, distinct in stream, picture and encoding: what the loops read.
struct ActiveDisplay {
  uint64_t id = 0;
  std::string stream;
  DisplaySpec spec;  // completed
  EncodingSpec encoding;
  // stream + displayKey: displays that share one trace. That of a tracked display is its own.
  std::string picture_key;
  EyeTrackPtr eyes;                       // of a tracked display; else nullptr
  std::shared_ptr<DisplayCoding> coding;  // of video whose quality adapts; else nullptr
  std::shared_ptr<AtlasChain> chain;      // of chained video; else nullptr

  // Its newest atlas is to be made again, finer, or so that it needs no other.
  bool isWantedAgain() const { return (coding && coding->isWanted()) || (chain && chain->isDue()); }
  uint32_t subscriber_count = 0;
  std::vector<Payer> viewers;  // of the subscribers, each once; they pay for it together
};

using ActiveDisplayPtr = std::shared_ptr<const ActiveDisplay>;

// A subscriber's place at a display; 0 = none.
struct WatcherPlace {
  uint64_t display_id = 0;
  uint64_t subscriber_id = 0;
};

// A subscriber is to take its place at the other rung of its display.
struct RungMove {
  WatcherPlace from;
  VideoRung to = VideoRung::kSecond;
};

class Member;

struct BroadcasterLimits {
  uint32_t display_count_max = 64;
  uint32_t subscriber_count_max = 1024;
};

// Thread-safety: all methods may be called from any thread. Subscribers are called without a lock
// held that a subscriber could want.
class Broadcaster {
 public:
  // Displays and viewers take their memory from the budget, and second rungs their time from the
  // room. Both outlive the broadcaster.
  explicit Broadcaster(BroadcasterLimits limits, MemoryBudget& memory = unboundedMemory(),
                       CodingRoom& coding_room = noCodingRoom());
  ~Broadcaster();

  // A place among the watchers of a display; leaving it is destroying it.
  class Subscription;

  // Joins or opens the display. A late joiner is offered the newest whole atlas at once, then told
  // of the one that is being made. Where the newest needs another, one is made that does not.
  // A tracked display is this subscriber's alone, seen by `eyes`, which only such a display has.
  // `replaced`: a place that is left as the new one is taken, so that no limit counts both. It
  // stays where the new one is refused. It may have been left meanwhile.
  // RESOURCE_EXHAUSTED over a limit, or where the budget has no room; UNAVAILABLE while draining.
  absl::StatusOr<std::unique_ptr<Subscription>> subscribe(
      const std::string& stream, const DisplaySpec& spec, const EncodingSpec& encoding,
      const std::shared_ptr<Subscriber>& subscriber, EyeTrackPtr eyes = nullptr,
      const WatcherPlace& replaced = {});

  // Takes the place that Subscription::wantedMove() asks for. It is another display of the same
  // picture, whose sequence is its own. `subscriber` is told as a joiner is, but waits for an atlas
  // that needs no other. The place before is left as the new one is taken, and stays where that is
  // refused. RESOURCE_EXHAUSTED where no processor time is left for a second encoding; others as
  // above.
  absl::StatusOr<std::unique_ptr<Subscription>> moveToRung(
      const RungMove& move, const std::shared_ptr<Subscriber>& subscriber, int64_t now_ns);

  // Called, on the subscriber's thread, whenever the set of displays of a stream changed: a joiner
  // without a finished atlas wants one. Set once, before anybody subscribes.
  void onDemandChange(std::function<void(const std::string& stream)> callback);

  // Called by publish() for an atlas that was seen by eyes, on its thread: other sources may serve
  // them better from now on. Set once, before anybody subscribes.
  void onEyesServed(std::function<void(const std::string& stream)> callback);

  // One snapshot of the displays of a stream; all of them with an empty name. Sorted by id.
  std::vector<ActiveDisplayPtr> displays(const std::string& stream) const;
  // nullptr = nobody watches it any more.
  ActiveDisplayPtr display(uint64_t display_id) const;
  uint32_t subscriberCount(const std::string& stream) const;

  // The layout of the display's next atlas, before that is traced. Told again when it changes.
  void noteLayout(uint64_t display_id, std::shared_ptr<const AtlasLayout> layout);
  // The layout last noted; nullptr = the display has met no frame of its stream yet.
  std::shared_ptr<const AtlasLayout> layout(uint64_t display_id) const;

  // An atlas is being made, of which bands will come. Its sequence is the display's next. Of a
  // display that nobody watches any more, nobody hears of it.
  void begin(const GrowingAtlasPtr& atlas);
  // A finished atlas, begun before or not. Its sequence must grow. Atlases of a display that nobody
  // watches any more are dropped.
  void publish(const AtlasPtr& atlas);
  // The sequence of the next atlas of a display.
  uint64_t nextSequence(uint64_t display_id) const;
  // The display cannot be served: its subscribers end with this status.
  void refuse(uint64_t display_id, const absl::Status& status);
  // The newest complete atlas of a display; nullptr = none yet.
  AtlasPtr newest(uint64_t display_id) const;
  // Atlases published for the display so far.
  uint64_t atlasCount(uint64_t display_id) const;

  // To be called a few times a second: looks at the load of the processors. Displays whose frames
  // stand may want their newest atlas again (DisplayCoding::wantsFiner, AtlasChain::wantsAgain).
  void remakeStanding(int64_t now_ns);

  // Ends every subscriber with OK and refuses new ones.
  void drain();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

class Broadcaster::Subscription {
 public:
  // `line`: what is known of the subscriber's line; none = it is a newcomer.
  Subscription(std::shared_ptr<State> state, const ActiveDisplay& display, const Member& member,
               const std::optional<ReaderLine>& line = std::nullopt);
  ~Subscription();
  uint64_t displayId() const { return place_.display_id; }
  const WatcherPlace& place() const { return place_; }
  VideoRung rung() const { return rung_; }

  // Notes of what the subscriber's connection takes; see DisplayCoding. Nothing happens where the
  // quality of the display does not adapt.
  void beginWrite(uint64_t bytes, int64_t now_ns) {
    if (coding_) coding_->beginWrite(place_.subscriber_id, bytes, now_ns);
  }
  void endWrite(int64_t now_ns) {
    if (coding_) coding_->endWrite(place_.subscriber_id, now_ns);
  }
  void endAtlas(int64_t now_ns) {
    if (coding_) coding_->endAtlas(place_.subscriber_id, now_ns);
  }
  bool mayBegin(int64_t now_ns) const {
    return !coding_ || coding_->mayBegin(place_.subscriber_id, now_ns);
  }
  // To be called a few times a second, if the subscriber can move: whether its line asks for the
  // other rung of the display. A move that is not made is asked for again after a while.
  std::optional<RungMove> wantedMove(int64_t now_ns);
  // The subscriber has fallen out of chained video: it waits for an atlas that needs no other, and
  // could take it now. Such atlases are large, and all readers get them: nothing happens where it
  // may not begin one.
  void wantSelfContained(int64_t now_ns) {
    if (chain_ && mayBegin(now_ns)) chain_->want();
  }

 private:
  LineFit fitOfFirstRung(int64_t now_ns) const;

  std::shared_ptr<State> state_;
  WatcherPlace place_;
  VideoRung rung_;
  std::shared_ptr<DisplayCoding> coding_;
  std::shared_ptr<AtlasChain> chain_;
};

}  // namespace viewloom
