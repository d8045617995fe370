// SPDX-License-Identifier: Apache-2.0
// Makes pictures of frames. All engines give the same answers: one oracle judges them alike.
//
// A frame is prepared once, for all pictures of it. A picture is planned once, for all frames that
// it is made of alike. An atlas is then made part by part: on a device, whose queue one thread of
// the pipeline fills (Making::step), and by the pipeline's worker threads (StripWork::makePiece).
// Nobody outside server/engine asks how.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/trace_method.h"
#include "display/color_form.h"
#include "frame/depth_spread.h"
#include "frame/frame.h"
#include "frame/stage_times.h"
#include "picture/atlas_strips.h"
#include "picture/trace_job.h"

namespace viewloom {

// An engine, or the budget, has no memory left for what it was asked for; others may be served. The
// text is for users.
class EngineOutOfMemory : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A piece of work that is done.
struct DoneWork {
  int64_t predicted_ns = 0;
  int64_t measured_ns = 0;
};

// The preparation of a frame is given up.
class PreparationGivenUp : public std::runtime_error {
 public:
  PreparationGivenUp() : std::runtime_error("the server is shutting down") {}
};

// Calls between two pieces of a preparation, on its thread.
struct PreparationEvents {
  std::function<void(const DoneWork& work)> on_piece = [](const DoneWork&) {};
  std::function<bool()> is_given_up = [] { return false; };
};

// Measurements of a prepared frame.
struct FrameMeasures {
  SourceStats stats;   // of the first source
  DepthSpread depths;  // likewise
};

// A frame in the form that one engine takes it in. Keeps its memory from frame to frame.
// Thread-safety: none; the owner decides which thread has it. Once prepared, it is only read.
class PreparedFrame {
 public:
  virtual ~PreparedFrame() = default;

  // The frame that it is for from now on; not prepared yet. The engine takes such frames.
  virtual void take(FramePtr frame) = 0;
  // Makes room for that frame, unless there is some. Throws EngineOutOfMemory.
  virtual void reserve() = 0;
  // Prepares it, unless it is, piece by piece. Returns how much of that time it took to copy the
  // frame to a device, ns. Throws EngineOutOfMemory and PreparationGivenUp.
  virtual int64_t prepare(const Clock& clock, const PreparationEvents& events) = 0;
  // Once it is prepared.
  virtual FrameMeasures measures() const = 0;
};

// Gives the frames of one stream their form. Those are prepared one after the other, and share what
// only the preparation needs. Thread-safety: make() from one thread at a time.
class FramePreparer {
 public:
  virtual ~FramePreparer() = default;
  virtual std::unique_ptr<PreparedFrame> make() = 0;
};

// How an engine makes a picture of frames. Immutable.
class Plan {
 public:
  virtual ~Plan() = default;
  // Whether the same picture is made of this frame, too, by the same plan.
  virtual bool holdsFor(const PreparedFrame& frame) const = 0;
};

using PlanPtr = std::shared_ptr<const Plan>;

// Planes of a strip in host memory. Those that were not asked for are empty.
struct StripPlanes {
  std::span<const uint32_t> rgba;  // uint32_t[rows][width]: R, G, B, any, in memory order
  std::span<const uint8_t> ycbcr;  // as YcbcrLayout; of both forms of colour one is empty
  SizePx color_px;                 // what those hold
  uint32_t first_row = 0;          // the strip's first row in that
  std::span<const float> depth;    // float[rows of the strip][width], 1/Z of the view, 1/m
  std::span<const uint8_t> mask;   // uint8_t[rows of the strip][width], RayClass
};

// Counts of the rays of an atlas, or of a part of it, by what they saw.
struct RayCounts {
  Coverage coverage;
  ReflectionCounts reflections;
};

// How much of an atlas worker threads are to finish.
struct StripWorkShape {
  uint32_t first_strip = 0;
  uint32_t strip_count = 1;
  uint32_t piece_count = 0;
  int64_t piece_ns = 0;  // prediction for each piece
  // The others wait until the first piece is made.
  bool begins_with_one = false;
};

// Strips of one atlas that worker threads finish: first all pieces, then the planes can be read.
// Thread-safety: makePiece() from several threads at once, each piece once. The frames and the
// picture that it is made of outlive it.
class StripWork {
 public:
  explicit StripWork(const StripWorkShape& given_shape) : shape(given_shape) {}
  virtual ~StripWork() = default;

  virtual void makePiece(uint32_t piece) = 0;
  // A piece has taken so long: engines learn from it. From any thread.
  virtual void notePiece(int64_t measured_ns) = 0;
  // Once all pieces are made: of all its strips together, and the planes of one of them.
  virtual RayCounts counts() const = 0;
  virtual StripPlanes planes(uint32_t strip) const = 0;

  const StripWorkShape shape;
};

using StripWorkPtr = std::unique_ptr<StripWork>;
// Takes over strips for the worker threads. Called on any thread, for all strips of an atlas in
// their order.
using HandOn = std::function<void(StripWorkPtr work)>;

// An atlas to be made.
struct AtlasOrder {
  PicturePtr picture;
  PlanPtr plan;
  // The frame, and where the picture is made of two, the one before it. Prepared.
  std::vector<const PreparedFrame*> frames;
  AtlasStrips strips;
  TraceOutputs planes;       // colour in the form that encoders take most directly
  bool is_for_eyes = false;  // of a tracked display
  std::string picture_key;   // atlases of one picture share it
  std::string payer;         // pictures of one viewer share it
  // Called on any thread, once for each step with a prediction.
  std::function<void(const DoneWork& work)> note_work;
};

// Result of Making::step().
struct MakingStep {
  bool has_room = true;      // else nothing: all memory is lent (EngineEvents::on_room)
  int64_t predicted_ns = 0;  // time of a device that was taken; 0 = none
  bool is_last = false;      // everything is handed on, or will be
};

// One atlas that is being made. Thread-safety: none; the thread's that began it.
class Making {
 public:
  virtual ~Making() = default;
  // Planes of its strips: colour in the form that was asked for, or kRgba.
  virtual const TraceOutputs& planes() const = 0;
  // Whether it has begun a strip, and so holds memory that others may wait for.
  virtual bool holdsRoom() const = 0;
  // Makes the next part, of kPiece_ns at most as far as can be foreseen.
  virtual MakingStep step() = 0;
  // Nothing more will be made of it. Waits until a device is done with what was submitted.
  virtual void giveUp() = 0;
};

// Calls that an engine makes to its user.
struct EngineEvents {
  std::function<void()> on_room;  // memory came back; called on any thread, must not throw
  std::function<void(const std::exception& error)> on_failure;  // nothing more will be handed on
};

// Thread-safety: takes(), plan(), preparer() and isReadyFor() from any thread; begin(),
// hasRoomForEyes(), workAhead() and the steps of what was begun from one thread.
class Engine {
 public:
  virtual ~Engine() = default;

  virtual TraceMethod method() const = 0;
  // Whether the device that it fills computes on the cores of this machine, which worker threads
  // need as well.
  virtual bool takesCores() const { return false; }
  // Before anything is begun.
  virtual void connect(EngineEvents events) = 0;

  virtual bool takes(const Frame& frame) const = 0;
  // Memory of this machine that a frame of this format takes here once it is prepared, beside its
  // planes, bytes at most. 0 where the engine does not take such frames.
  virtual uint64_t preparedBytes(const FrameFormat& format) const = 0;
  virtual std::unique_ptr<FramePreparer> preparer() = 0;
  // Whether such a frame can be prepared at once. If not, the engine makes what it lacks, and calls
  // `then` on any thread when that is there. Most engines lack nothing.
  virtual bool isReadyFor(const Frame& /*frame*/, std::function<void()> /*then*/) { return true; }

  // nullptr where it cannot make such a picture of such a frame, which need not be prepared unless
  // it is the first engine that takes it.
  virtual PlanPtr plan(const PicturePtr& picture, const PreparedFrame& frame) const = 0;

  // Whether such an atlas can be made at once. If not, the engine prepares what it lacks, and calls
  // `then` on any thread when that is there. Called by the thread of begin().
  virtual bool isReady(const AtlasOrder& order, std::function<void()> then) = 0;
  // Whether the atlas of another tracked display of this payer could begin.
  virtual bool hasRoomForEyes(const std::string& payer) = 0;
  // nullptr: all memory is lent (EngineEvents::on_room). There is always memory for one small atlas
  // of each picture, and for one large atlas of each payer.
  virtual std::unique_ptr<Making> begin(AtlasOrder order, HandOn hand_on) = 0;
  // Does one piece of work that lets first pictures come sooner, unless somebody has needed the
  // engine right before: he will soon again. Returns after how long there may be more; empty =
  // there is no more. Called by the thread of begin() while nothing is begun.
  virtual std::optional<std::chrono::nanoseconds> workAhead() = 0;
  // Waits until everything is handed on, and forgets who waits to be ready.
  virtual void drain() = 0;
};

}  // namespace viewloom
