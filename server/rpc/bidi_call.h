// SPDX-License-Identifier: Apache-2.0
// The mechanics of a bidirectional call on raw bytes: one read and one write at a time, one finish.
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include "base/status.h"
#include "metrics/metrics.h"
#include "rpc/liveness.h"

namespace viewloom {

// Message of calls that end with UNAVAILABLE.
inline constexpr const char* kDrainMessage =
    "the server is shutting down; try again later, or use another server";

// Derived classes say what a message means and what is written next. The call keeps itself alive
// from open() to OnDone; others hold it weakly and may lock it after its end, when nothing happens
// any more. Thread-safety: public methods may be called from any thread. mutex_ guards everything
// that is not said to belong to the reads, of which one runs at a time.
class BidiCall : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                 public std::enable_shared_from_this<BidiCall> {
 public:
  // The library's side of the call, which lives until OnDone. To be called before open().
  void setContext(const grpc::CallbackServerContext& context);
  // Observes how long refusals take. To be called before open(); the histogram outlives the call.
  void timeRefusals(const Histogram& seconds) { refusal_seconds_ = &seconds; }
  // Starts to read; call once, on a call that a shared_ptr owns.
  void open();
  // Ends the call once takeMessage has nothing more to write; the first status wins.
  void end(const absl::Status& status);
  // To be called every kTick: cancels the call once its client has not taken a message for so many
  // ticks. Otherwise a client that reads nothing would keep its place, and the end would wait for
  // it.
  void cutIfUnread(uint32_t ticks_max);

  void OnReadDone(bool ok) final;
  void OnWriteDone(bool ok) final;
  void OnCancel() final;
  void OnDone() final;

 protected:
  // A message came. An error ends the call with it. Without the lock, one at a time.
  virtual absl::Status handleMessage(grpc::ByteBuffer& bytes) = 0;
  // The client sends no more. As above.
  virtual absl::Status handleHalfClose() = 0;
  // A message was written. Without the lock, one at a time.
  virtual void handleWritten() {}
  // The call has begun to end: lets go of what others wait for. Without the lock, once.
  virtual void release() = 0;
  // No message is handled any more: lets go of what they left behind. Without the lock, once.
  virtual void dropReads() {}
  // The next message to write. With the lock.
  virtual std::optional<grpc::ByteBuffer> takeMessage() = 0;
  // Whether takeMessage has another to give right after the one it gave last, which then need not
  // leave alone. With the lock.
  virtual bool moreFollows() const { return false; }
  // Whether the message that takeMessage gave last counts as written only once the socket has taken
  // it, with all before it. Others count as written while up to a megabyte of them waits. With the
  // lock.
  virtual bool waitsForSocket() const { return false; }
  // False holds the next read back until a message is written. With the lock.
  virtual bool wantsToRead() const { return true; }
  // False holds the end back although there is nothing to write yet. With the lock.
  virtual bool mayFinish() const { return true; }

  // Writes, reads or finishes if there is reason to. A call whose message cannot be made ends
  // with RESOURCE_EXHAUSTED for want of memory, else with INTERNAL. Never throws. With the lock.
  void advance();
  bool ending() const { return end_status_.has_value(); }
  bool halfClosed() const { return half_closed_; }

  std::mutex mutex_;

 private:
  // Never throws.
  void endWith(grpc::Status status);
  void handle(bool ok);
  // Ends a call whose message was refused.
  void refuse(const absl::Status& status, std::chrono::steady_clock::time_point begun);
  // Calls release(): nobody is there who could be told about an exception.
  void letGo();
  std::optional<grpc::ByteBuffer> nextMessage();

  std::shared_ptr<BidiCall> self_;
  const Histogram* refusal_seconds_ = nullptr;
  grpc::ByteBuffer incoming_;
  grpc::ByteBuffer outgoing_;
  bool opened_ = false;
  bool reading_ = false;
  bool handling_ = false;  // a message; the end waits for it
  bool half_closed_ = false;
  bool writing_ = false;
  TicksSince unread_;  // since the message that is being written
  bool cancelled_ = false;
  bool finished_ = false;
  bool releases_when_done_ = false;  // it ended with the lock held, without release()
  std::optional<grpc::Status> end_status_;

  std::mutex context_mutex_;  // guards context_
  const grpc::CallbackServerContext* context_ = nullptr;
};

}  // namespace viewloom
