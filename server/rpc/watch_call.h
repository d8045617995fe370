// SPDX-License-Identifier: Apache-2.0
// One client's call: watches a display and writes its atlases, the next whenever the last one is
// through.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/clock.h"
#include "display/atlas_layout.h"
#include "display/display_spec.h"
#include "eye_poses/eye_track.h"
#include "metrics/metrics.h"
#include "publish/broadcaster.h"
#include "publish/fall_outs.h"
#include "publish/stream_directory.h"
#include "rpc/asked_picture.h"
#include "rpc/atlas_outbox.h"
#include "rpc/bidi_call.h"
#include "rpc/call_access.h"
#include "rpc/clock_replies.h"
#include "rpc/liveness.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom {

// Parts of the server that watching a stream touches. They outlive the calls.
struct DisplayParts {
  StreamDirectory& directory;
  Broadcaster& broadcaster;
  EyeSink& eyes;
  const Clock& clock;
  const Metrics& metrics;
  AtlasLimits limits;
};

// Thread-safety: as BidiCall.
class WatchCall final : public BidiCall {
 public:
  // `host`: of the client, or the subject of its certificate. Its display takes its share of the
  // memory.
  WatchCall(const DisplayParts& parts, Caller caller, const std::string& host)
      : parts_(parts),
        caller_(std::move(caller)),
        identity_(caller_->shareName(host)),
        outbox_(parts_.metrics) {}

  // Name of the client whose share it takes (Caller::shareName).
  const std::string& identity() const { return identity_; }
  // UNAVAILABLE for a call that was never opened; the broadcaster ends the others.
  void endUnlessWatching();
  // To be called every kTick: sends heartbeats to a client that wants them, ends the call of a
  // client whose identity does not hold any more, moves one that keeps falling out of chained video
  // to atlases that need no other, and one whose line is slow to the second rung of its display.
  void tick();

 private:
  // A place in the broadcaster. What an earlier one still offers after a change is ignored.
  class Seat;

  absl::Status handleMessage(grpc::ByteBuffer& bytes) override;
  absl::Status handleHalfClose() override;
  void handleWritten() override;
  void release() override;
  std::optional<grpc::ByteBuffer> takeMessage() override;
  bool moreFollows() const override { return outbox_.hasMore(); }
  // The next atlas is chosen once the socket has this one: a newer one may have come by then.
  bool waitsForSocket() const override { return writes_end_; }

  absl::Status handleOpen(const v1::OpenDisplay& request);
  absl::Status handleChange(const v1::ChangeDisplay& request);
  absl::Status handleEyePoses(const v1::EyePoses& request, int64_t received_ns);
  void notePresented(const v1::Presented& presented);
  void noteProbe(const v1::ClockProbe& probe, int64_t received_ns);
  DisplayUse displayUse(const EncodingSpec& encoding) const;
  // Leaves its place, and takes the one that was asked for.
  absl::Status takeSeat(const std::string& field);
  // Stays in its chain where it cannot move.
  void leaveChainIfLost();
  // Moves to the other rung of the display where the line asks for that, and stays where it cannot.
  // Comes back where its place is lost; errors as of takeSeat().
  absl::Status followLine();
  absl::Status moveTo(const AskedPicture& asked);
  void moveToRung(const RungMove& move);

  // A move that the client has not asked for: the call stays at its place until it is granted the
  // new one.
  struct Departure {
    WatcherPlace from;
    QuotaPartPtr quota;  // of the place so far
    std::shared_ptr<Seat> seat;
  };
  Departure depart();
  // False where the call ends. What the new place has told already is told again.
  bool arrive(std::shared_ptr<Seat> seat, std::unique_ptr<Broadcaster::Subscription> subscription,
              QuotaPartPtr quota);
  // With mutex_. Of the next number.
  std::shared_ptr<Seat> nextSeat(const std::string& field);

  void leave(std::unique_ptr<Broadcaster::Subscription> subscription);
  void begin(uint64_t seat_number, GrowingAtlasPtr atlas);
  void noteGrowth(uint64_t seat_number);
  void offer(uint64_t seat_number, AtlasPtr atlas);
  // A whole atlas waits to be sent.
  void keep(AtlasPtr atlas);
  void endSeat(uint64_t seat_number, const absl::Status& status);
  std::optional<grpc::ByteBuffer> takeOfAtlas();
  std::optional<grpc::ByteBuffer> takeReply();
  std::optional<grpc::ByteBuffer> takeHeartbeat();

  const DisplayParts parts_;
  LiveCaller caller_;
  const std::string identity_;

  // Held by the reads while they handle a message, and by ticks that take a seat. Guards what
  // follows. Before mutex_.
  std::mutex seat_mutex_;
  FallOuts fall_outs_;
  std::string stream_;  // empty before the call was opened
  AskedPicture asked_;
  EyeTrackPtr eyes_;  // while the display is tracked; a changed one is seen by the same eyes

  // Under mutex_.
  std::unique_ptr<Broadcaster::Subscription> subscription_;
  QuotaPartPtr quota_;  // of its display
  uint64_t seat_number_ = 0;
  // The second rung has ended, and the first may go on; or a new place ended before the call had
  // arrived.
  bool is_place_lost_ = false;
  bool draining_ = false;  // what waits is still written
  AtlasOutbox outbox_;
  ClockReplies clock_replies_;
  bool replied_last_ = false;  // the last message written is one of them
  bool writes_end_ = false;    // the message being written is the last one of an atlas
  bool wants_heartbeats_ = false;
  bool heartbeat_is_due_ = false;
  TicksSince told_;  // to the client
};

}  // namespace viewloom
