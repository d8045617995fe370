// SPDX-License-Identifier: Apache-2.0
#include "pipeline/encode_pool.h"

#include <algorithm>
#include <utility>

namespace viewloom {
namespace {

// Packed bands that wait for reuse; more than any server has on their way, far fewer than matter.
constexpr size_t kKeptBandCount = 1024;

template <typename Sample>
std::span<const uint8_t> bytesOf(std::span<const Sample> samples) {
  return {reinterpret_cast<const uint8_t*>(samples.data()), samples.size_bytes()};
}

std::span<const uint8_t> planeBytes(const TraceSlot& slot, AtlasPlane plane) {
  switch (plane) {
    case AtlasPlane::kColor:
      return bytesOf(slot.color());
    case AtlasPlane::kDepth:
      return bytesOf(slot.depth());
    case AtlasPlane::kMask:
      break;
  }
  return slot.mask();
}

// A plane of the whole strip, once its trace is done.
BandPixels tracedPixels(const TracedStrip& strip, AtlasPlane plane) {
  const uint32_t row_count = strip.run->rowCount(strip.strip);
  const std::span<const uint8_t> bytes = planeBytes(strip.trace->slot, plane);
  return {.plane = plane,
          .first_row = strip.run->firstRow(strip.strip),
          .row_count = row_count,
          .width_px = strip.run->picture->layout->size_px.width,
          .bytes = bytes,
          .stride_bytes = bytes.size() / row_count};
}

// Up to `row_count` rows from `row` of the strip on.
BandPixels rowsOf(const BandPixels& strip, uint32_t row, uint32_t row_count) {
  BandPixels band = strip;
  band.first_row += row;
  band.row_count = std::min(row_count, strip.row_count - row);
  band.bytes = strip.bytes.subspan(row * strip.stride_bytes, band.row_count * strip.stride_bytes);
  return band;
}

}  // namespace

EncodePool::EncodePool(const PipelineLinks& links, const Timeline& timeline,
                       AtlasPublisher& publisher, uint32_t thread_count, uint32_t queued_count_max)
    : links_(links),
      timeline_(timeline),
      publisher_(publisher),
      bytes_(kKeptBandCount),
      strips_(queued_count_max) {
  for (uint32_t i = 0; i < thread_count; ++i) {
    threads_.emplace_back([this] {
      try {
        run();
      } catch (const std::exception& error) {
        links_.on_failure(error);
      }
    });
  }
}

void EncodePool::stop() {
  strips_.close();
  for (std::jthread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
  while (strips_.pop()) {  // what threads that failed have left
  }
}

void EncodePool::run() {
  BandEncoder encoder(bytes_);
  while (auto strip = strips_.pop()) encode(*std::move(strip), encoder);
}

void EncodePool::encode(TracedStrip strip, BandEncoder& encoder) {
  timeline_.wait(strip.timeline_value);
  AtlasRun& run = *strip.run;
  run.noteTraced(strip.trace->slot.coverage(), links_.clock.nowNs());
  for (AtlasOutput& output : run.outputs) encodeOutput(strip, output, encoder);
  strip.trace.reset();  // room for the next strip before the atlas goes out
  if (run.noteEncoded()) publisher_.complete(run);
}

void EncodePool::encodeOutput(const TracedStrip& strip, AtlasOutput& output, BandEncoder& encoder) {
  const EncodingSpec& encoding = output.display->encoding;
  uint32_t plane_rank = 0;
  for (const AtlasPlane plane : {AtlasPlane::kColor, AtlasPlane::kDepth, AtlasPlane::kMask}) {
    if (plane == AtlasPlane::kDepth && !encoding.with_depth) continue;
    if (plane == AtlasPlane::kMask && !encoding.with_mask) continue;
    const BandPixels pixels = tracedPixels(strip, plane);
    for (uint32_t row = 0; row < pixels.row_count; row += output.band_row_count) {
      const BandPixels band = rowsOf(pixels, row, output.band_row_count);
      const uint32_t index = band.first_row / output.band_row_count;
      EncodedBand packed = encoder.encode(band, encoding, *strip.run->picture->layout);
      links_.metrics.bands_encoded.add();
      links_.metrics.encoded_bytes.add(static_cast<double>(packed.bytes->size()));
      output.bands[plane_rank * output.bands_per_plane + index] = std::move(packed);
    }
    ++plane_rank;
  }
}

}  // namespace viewloom
