// SPDX-License-Identifier: Apache-2.0
#include "pipeline/encode_pool.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/thread_name.h"

namespace viewloom {
namespace {

// Packed bands that wait for reuse; more than any server has on their way, far fewer than matter.
constexpr size_t kKeptBandCount = 1024;

template <typename Sample>
std::span<const uint8_t> bytesOf(std::span<const Sample> samples) {
  return {reinterpret_cast<const uint8_t*>(samples.data()), samples.size_bytes()};
}

// Woken, this thread then takes no core from one that is at work: those that begin atlases, receive
// poses and send bands need one for microseconds. Where that is not allowed all take their turns.
void computeInBatches() {
  constexpr sched_param kNoPriority{};
  pthread_setschedparam(pthread_self(), SCHED_BATCH, &kNoPriority);
}

}  // namespace

struct EncodePool::StripPlanes {
  uint32_t image = 0;
  BandPixels color;  // rows counted in its image
  std::span<const float> depth;
  std::span<const uint8_t> mask;
  const AtlasLayout& layout;

  // A plane of the whole strip.
  BandPixels pixels(AtlasPlane plane) const {
    BandPixels pixels = color;
    pixels.plane = plane;
    if (isColor(plane)) return pixels;
    pixels.form = ColorForm::kRgba;
    pixels.bytes = plane == AtlasPlane::kMask ? mask : bytesOf(depth);
    if (plane == AtlasPlane::kDepthCodes) pixels.depth_scale = scaleOf(*layout.depth_codes);
    pixels.stride_bytes = pixels.bytes.size() / pixels.row_count;
    return pixels;
  }
};

EncodePool::EncodePool(const PipelineLinks& links, const Timeline& timeline,
                       AtlasPublisher& publisher, uint32_t thread_count, uint32_t queued_count_max)
    : links_(links),
      timeline_(timeline),
      publisher_(publisher),
      bytes_(kKeptBandCount),
      tasks_(queued_count_max) {
  for (uint32_t i = 0; i < thread_count; ++i) {
    threads_.emplace_back([this] {
      nameThread("encode");
      computeInBatches();
      try {
        run();
      } catch (const std::exception& error) {
        // What this thread had in hand will never be done: the others must not wait for it.
        tasks_.close();
        tasks_.clear();
        links_.on_failure(error);
      }
    });
  }
}

void EncodePool::stop() {
  tasks_.close();
  for (std::jthread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
  tasks_.clear();  // what came after a thread had failed
}

void EncodePool::run() {
  Worker worker{.encoder = BandEncoder(bytes_), .sweeper = {}, .gatherer = {}};
  while (auto task = tasks_.pop()) {
    const bool is_tracked =
        (task->part.sweep ? task->part.sweep->run() : task->traced.run)->isTracked();
    // By a clock that nobody turns by hand: it is no time that anybody is told.
    const auto begin = std::chrono::steady_clock::now();
    if (task->part.sweep)
      serve(std::move(task->part), worker);
    else
      serve(std::move(task->traced), worker);
    const auto duration = std::chrono::steady_clock::now() - begin;
    tasks_.noteServed(is_tracked, std::chrono::nanoseconds(duration).count());
  }
}

// True when the strip's px are as they are to be shown.
bool EncodePool::gatherPiece(TracedStrip& strip, BandGatherer& gatherer) {
  const AtlasRun& run = *strip.run;
  if (!run.picture->gathers_on_host) return true;
  const uint32_t row_count = run.rowCount(strip.strip);
  const BandRows rest = {run.firstRow(strip.strip) + strip.gathered_rows,
                         row_count - strip.gathered_rows};
  const BandRows piece = firstGathered(*run.picture->layout, rest);
  gatherer.gather(hostStructure(run.job.structure->build->walked->structure.firstPart()),
                  *run.picture,
                  bandOf(strip.trace->slot, *run.picture->layout, piece, strip.gathered_rows));
  strip.gathered_rows += piece.row_count;
  return strip.gathered_rows == row_count;
}

void EncodePool::serve(TracedStrip strip, Worker& worker) {
  timeline_.wait(strip.timeline_value);
  AtlasRun& run = *strip.run;
  if (!gatherPiece(strip, worker.gatherer)) return tasks_.resume(std::move(strip));
  const TraceSlot& slot = strip.trace->slot;
  run.noteTraced(slot.coverage(), links_.clock.nowNs(), slot.reflections());
  const SizePx size_px = {run.picture->layout->size_px.width, run.rowCount(strip.strip)};
  BandPixels color = colorPixels(slot.color(), slot.ycbcr(), size_px, run.planes.color);
  color.first_row = run.rowInImage(strip.strip);
  encode(run, {run.imageOf(strip.strip), color, slot.depth(), slot.mask(), *run.picture->layout},
         worker.encoder);
  strip.trace.reset();  // room for the next strip before the atlas goes out
  if (run.noteEncoded()) publisher_.complete(run);
}

void EncodePool::serve(SweepPart part, Worker& worker) {
  const AtlasRunPtr run = part.sweep->run();
  if (!part.is_strip) {
    const Coverage coverage = part.sweep->sweepPiece(part.index, worker.sweeper);
    run->noteTraced(coverage, links_.clock.nowNs());
    tasks_.noteSwept(*part.sweep);  // after the last, others may pack and publish at once
    return;
  }
  const SweptAtlas& atlas = part.sweep->atlas();
  const SizePx size_px = run->picture->layout->size_px;
  const size_t first = size_t{run->firstRow(part.index)} * size_px.width;
  const size_t count = size_t{run->rowCount(part.index)} * size_px.width;
  const auto rowsOfStrip = [&]<typename T>(const std::vector<T>& plane) {
    return plane.empty() ? std::span<const T>() : std::span<const T>(plane).subspan(first, count);
  };
  BandPixels color = rowsOf(colorPixels(atlas.color, atlas.ycbcr, size_px, run->planes.color),
                            run->firstRow(part.index), run->rowCount(part.index));
  color.first_row = run->rowInImage(part.index);
  encode(*run,
         {run->imageOf(part.index), color, rowsOfStrip(atlas.depth), rowsOfStrip(atlas.mask),
          *run->picture->layout},
         worker.encoder);
  part.sweep.reset();  // room for the next sweep before the atlas goes out
  if (run->noteEncoded()) publisher_.complete(*run);
}

void EncodePool::encode(AtlasRun& run, const StripPlanes& planes, BandEncoder& encoder) {
  for (AtlasOutput& output : run.outputs) encodeOutput(run, planes, output, encoder);
}

void EncodePool::encodeOutput(AtlasRun& run, const StripPlanes& planes, AtlasOutput& output,
                              BandEncoder& encoder) {
  const EncodingSpec& encoding = output.display->encoding;
  uint32_t plane_rank = 0;
  for (const AtlasPlane plane : planesOf(encoding)) {
    const BandPixels pixels = planes.pixels(plane);
    for (uint32_t row = 0; row < pixels.row_count; row += output.band_row_count) {
      const BandPixels band = rowsOf(pixels, row, output.band_row_count);
      const uint32_t index =
          planes.image * output.bands_per_image + band.first_row / output.band_row_count;
      EncodedBand packed = encoder.encode(band, encoding, *run.picture->layout);
      packed.image_index = planes.image;
      links_.metrics.bands_encoded.add();
      links_.metrics.encoded_bytes.add(static_cast<double>(packed.bytes->size()));
      output.bands[plane_rank * output.bands_per_plane + index] = std::move(packed);
    }
    ++plane_rank;
  }
}

}  // namespace viewloom
