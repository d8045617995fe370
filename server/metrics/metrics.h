// SPDX-License-Identifier: Apache-2.0
// Counters and timers of the server, under their Prometheus names.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/memory_use.h"
#include "base/payer.h"
#include "base/trace_method.h"
#include "base/video_rung.h"

namespace prometheus {
class Counter;
class Gauge;
class Histogram;
}  // namespace prometheus

namespace viewloom {

// The three kinds of metric. Handles into a Metrics, valid as long as it lives; cheap to copy.
// Thread-safety: all methods may be called from any thread and do not block.
class Counter {
 public:
  explicit Counter(prometheus::Counter& counter) : counter_(&counter) {}
  void add(double amount = 1) const;
  double value() const;

 private:
  prometheus::Counter* counter_;
};

class Gauge {
 public:
  explicit Gauge(prometheus::Gauge& gauge) : gauge_(&gauge) {}
  void set(double value) const;
  void add(double amount) const;  // may be negative
  double value() const;

 private:
  prometheus::Gauge* gauge_;
};

// Thread-safety: as above, but observe() takes a lock for a moment.
class Histogram {
 public:
  explicit Histogram(prometheus::Histogram& histogram) : histogram_(&histogram) {}
  void observe(double value) const;

 private:
  prometheus::Histogram* histogram_;
};

// One handle per value of an enum whose last value is kCount.
template <typename Label, typename Handle>
class Labelled {
 public:
  static constexpr size_t kSize = static_cast<size_t>(Label::kCount);
  explicit Labelled(const std::array<Handle, kSize>& handles) : handles_(handles) {}
  const Handle& operator[](Label label) const { return handles_[static_cast<size_t>(label)]; }

 private:
  std::array<Handle, kSize> handles_;
};

// Where the time of an atlas goes; the fields of StageTimes.
enum class Stage : uint8_t {
  kReceive,
  kDecode,
  kUpload,
  kBuild,
  kRetime,
  kWait,
  kTrace,
  kEncode,
  kTotal,
  kCount
};
// Where something newer replaces something that waits: ingest to decoding, decoded frames to the
// structure loop, trace jobs, atlases to a gRPC client, atlases to a browser.
enum class HandOver : uint8_t { kDecode, kStructure, kTrace, kGrpc, kWeb, kCount };
enum class Transport : uint8_t { kGrpc, kWeb, kCount };
// How a ray ended; the fields of Coverage.
enum class RayAnswer : uint8_t { kHit, kHitAssumed, kHidden, kOutside, kEmpty, kCount };
// Outcome of a change of the certificate's files.
enum class CertificateChange : uint8_t { kTaken, kRefused, kCount };
// Kinds of pieces that engines' time is shared out in: of a device, of worker threads that make
// pictures, that pack them, of builds of structures.
enum class EngineWork : uint8_t { kTrace, kPiece, kPack, kBuild, kCount };
// Whom work was for: the server itself, peers on this machine, all others.
enum class PayerClass : uint8_t { kServer, kLocal, kRemote, kCount };
enum class HttpAnswer : uint8_t { kSuccess, kRedirect, kClientError, kServerError, kCount };

// Whether metrics name clients. Where none has to prove who it is, names are addresses, which are
// nobody else's concern.
enum class ClientNames : uint8_t { kHidden, kShown };

struct PieceTimes {
  int64_t predicted_ns = 0;
  int64_t measured_ns = 0;
};

// All metrics of a server, made once by whoever composes it. Each field is named like its metric:
// frames_received is viewloom_frames_received_total.
// Thread-safety: fields and methods may be used from any thread.
class Metrics {
  struct Store;
  std::unique_ptr<Store> store_;  // before the handles, which point into it

 public:
  explicit Metrics(ClientNames names = ClientNames::kHidden);
  ~Metrics();

  // Everything in Prometheus' text format.
  std::string text() const;

  Counter frames_received;   // whole
  Counter frames_refused;    // by the checks of their header or bytes
  Counter frames_unchanged;  // the same as the resident one
  Counter received_bytes;    // of planes, as they came on the wire
  Counter structures_built;
  Counter structures_retimed;  // of those, for times between frames: things move by themselves
  Labelled<TraceMethod, Counter> atlases_traced;  // {method}
  Counter atlases_encoded;
  Counter atlases_given_up;  // begun, but not finished: nobody watched them any more
  Counter bands_encoded;
  Counter video_pictures;  // of those
  Counter coarse_atlases;
  Labelled<VideoRung, Counter> rung_moves;  // {to}; of viewers, by the rung that they moved to
  Counter encoded_bytes;
  Labelled<RayAnswer, Counter> rays;          // {answer}; shares are ratios of their rates
  Labelled<HandOver, Counter> replaced;       // {hand_over}; drops, newest wins
  Labelled<Transport, Counter> atlases_sent;  // {transport}
  Labelled<Transport, Counter> sent_bytes;    // {transport}
  Counter output_ticks_skipped;  // of displays with a rate: another of its atlases was on its way
  Counter atlases_presented;     // shown, as gRPC clients say
  Histogram motion_to_image;     // of tracked displays; seconds
  Histogram eye_poses_age;       // when their atlas begins; seconds
  Labelled<HttpAnswer, Counter> http_responses;  // {answer}
  Labelled<Transport, Gauge> subscribers;        // {transport}; now
  Gauge streams_live;                            // now
  Gauge displays;                                // watched now
  Gauge http_connections;                        // open now
  Gauge certificate_end;  // viewloom_certificate_end_seconds; since 1970, 0 = no TLS
  Labelled<CertificateChange, Counter> certificate_changes;  // {outcome}
  Gauge memory_budget_bytes;                                 // memory.budget
  Gauge memory_idle_bytes;                                   // wait for reuse now
  Gauge memory_resident_bytes;                               // of the process, as the system counts
  Gauge memory_heap_bytes;                                   // lent by the C library now
  Labelled<MemoryUse, Gauge> memory_reserved_bytes;          // {use}; now
  Labelled<MemoryUse, Counter> memory_refused;               // {use}; no room in the budget
  Labelled<Stage, Histogram> stage;                          // viewloom_stage_seconds{stage}

  Histogram
      output_delay;  // viewloom_output_delay_seconds; from tick to atlas: jitter is its spread

  Gauge grpc_connections;                            // open now
  Labelled<Transport, Counter> connections_refused;  // {transport}; over the limit of their port
  Histogram call_refusal;  // viewloom_call_refusal_seconds; from a message to its refusal

  Labelled<PayerClass, Counter> engine_seconds;     // {payer}; of engines and their threads
  Labelled<EngineWork, Histogram> piece;            // viewloom_piece_seconds{work}; as measured
  Labelled<EngineWork, Histogram> predicted_piece;  // {work}; as predicted when they began
  Labelled<EngineWork, Gauge> longest_piece;        // {work}; since the start, seconds

  // Time of work for any of these, which is no piece of an engine's work. If clients
  // are named, also their viewloom_client_engine_seconds_total{client}.
  void observeTime(const std::vector<Payer>& payers, int64_t duration_ns) const;
  // A piece of work for any of these. Its time counts as above.
  void observePiece(EngineWork work, const std::vector<Payer>& payers,
                    const PieceTimes& times) const;
  void observeOutputDelay(int64_t duration_ns) const;
  void observeStage(Stage which, int64_t duration_ns) const;
};

}  // namespace viewloom
