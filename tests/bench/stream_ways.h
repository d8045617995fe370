// SPDX-License-Identifier: Apache-2.0
// The ways that `viewloom-bench ingest` compares: of a frame's bytes into a server, and of an
// atlas's bytes out to a viewer.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bench/measured_process.h"
#include "lib/wire_frame.h"

namespace viewloom::bench {

// One way of getting frames, or atlases, from one process to another. Thread-safety: none.
class Way {
 public:
  virtual ~Way() = default;
  // Returns when all have arrived. Throws std::runtime_error where one does not.
  virtual void send(int frame_count) = 0;
  // CPU time of the other process so far.
  virtual double thereCpuTime_s() const { return 0; }
};

// The arguments of all of them must outlive the way.
std::unique_ptr<Way> copyWay(const WireFrame& frame);
std::unique_ptr<Way> bareSendingWay(const WireFrame& frame, const MeasuredProcess& there);
std::unique_ptr<Way> publishingWay(const WireFrame& frame, const MeasuredProcess& there);
std::unique_ptr<Way> bareReceivingWay(uint64_t atlas_bytes, const MeasuredProcess& there);
// The same, and copies each message into memory that lives as long as the atlas.
std::unique_ptr<Way> bareKeepingWay(uint64_t atlas_bytes, const MeasuredProcess& there);
// Way of atlases of so many pixels, in colour.
std::unique_ptr<Way> watchingWay(uint32_t width_px, uint32_t height_px,
                                 const MeasuredProcess& there);

uint64_t byteCount(const WireFrame& frame);

}  // namespace viewloom::bench
