// SPDX-License-Identifier: Apache-2.0
#include "pipeline/encode_pool.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/thread_name.h"
#include "pipeline/within_memory.h"

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

struct EncodePool::StripPixels {
  const AtlasLayout& layout;
  const StripPlanes planes;
  uint32_t image = 0;
  BandPixels color;  // rows counted in its image

  // A plane of the whole strip.
  BandPixels pixels(AtlasPlane plane) const {
    BandPixels pixels = color;
    pixels.plane = plane;
    if (isColor(plane)) return pixels;
    pixels.form = ColorForm::kRgba;
    pixels.bytes = plane == AtlasPlane::kMask ? planes.mask : bytesOf(planes.depth);
    if (plane == AtlasPlane::kDepthCodes) pixels.depth_scale = scaleOf(*layout.depth_codes);
    pixels.stride_bytes = pixels.bytes.size() / pixels.row_count;
    return pixels;
  }
};

EncodePool::EncodePool(const PipelineLinks& links, AtlasPublisher& publisher, uint32_t thread_count)
    : links_(links), publisher_(publisher), bytes_(kKeptBandCount) {
  links_.memory.addIdle(bytes_.idleMemory());
  for (uint32_t i = 0; i < thread_count; ++i) {
    threads_.emplace_back([this] {
      nameThread("encode");
      computeInBatches();
      try {
        run();
      } catch (const std::exception& error) {
        // The work of this thread will never be done, so the others must not wait for it.
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
  BandEncoder encoder(bytes_);
  while (auto task = tasks_.pop()) {
    const AtlasRunPtr run = task->batch->run;
    // By a clock that nobody turns by hand: it is no time that anybody is told.
    const auto begin = std::chrono::steady_clock::now();
    serve(*task, encoder);
    finish(*std::move(task));
    const auto duration = std::chrono::steady_clock::now() - begin;
    tasks_.noteServed(*run, std::chrono::nanoseconds(duration).count());
  }
}

// Work that runs out of memory costs its own atlas alone.
void EncodePool::serve(const EncodeTask& task, BandEncoder& encoder) {
  AtlasRun& run = *task.batch->run;
  const absl::Status status = withinMemory([&] {
    if (!run.isAbandoned()) task.is_strip ? packStrip(task, encoder) : makePiece(task);
  });
  if (!status.ok()) publisher_.giveUp(run, status);
}

// Room for the next atlas before this one goes out.
void EncodePool::finish(EncodeTask task) {
  const AtlasRunPtr run = task.batch->run;
  if (!task.is_strip) return tasks_.noteMade(*task.batch);  // others may pack and publish at once
  task.batch.reset();
  if (!run->noteEncoded() || run->isAbandoned()) return;
  const absl::Status status = withinMemory([&] { publisher_.complete(*run); });
  if (!status.ok()) publisher_.giveUp(*run, status);
}

void EncodePool::makePiece(const EncodeTask& task) {
  task.batch->work->makePiece(task.index);
}

void EncodePool::packStrip(const EncodeTask& task, BandEncoder& encoder) {
  AtlasRun& run = *task.batch->run;
  const StripWork& work = *task.batch->work;
  if (task.index == 0) run.noteTraced(work.counts(), links_.clock.nowNs());
  const uint32_t strip = work.shape.first_strip + task.index;
  const StripPlanes planes = work.planes(strip);
  BandPixels color =
      rowsOf(colorPixels(planes.rgba, planes.ycbcr, planes.color_px, run.planes.color),
             planes.first_row, run.strips.rowsOf(strip).row_count);
  color.first_row = run.strips.rowInImage(strip);
  encode(run, {*run.picture->layout, planes, run.strips.imageOf(strip), color}, encoder);
}

void EncodePool::encode(AtlasRun& run, const StripPixels& strip, BandEncoder& encoder) {
  for (AtlasOutput& output : run.outputs) encodeOutput(run, strip, output, encoder);
}

void EncodePool::encodeOutput(AtlasRun& run, const StripPixels& strip, AtlasOutput& output,
                              BandEncoder& encoder) {
  const EncodingSpec& encoding = output.display->encoding;
  uint32_t plane_rank = 0;
  for (const AtlasPlane plane : planesOf(encoding)) {
    const BandPixels pixels = strip.pixels(plane);
    for (uint32_t row = 0; row < pixels.row_count; row += output.band_row_count) {
      const BandPixels band = rowsOf(pixels, row, output.band_row_count);
      const uint32_t index =
          strip.image * output.bands_per_image + band.first_row / output.band_row_count;
      EncodedBand packed = encoder.encode(band, encoding, *run.picture->layout);
      links_.metrics.bands_encoded.add();
      links_.metrics.encoded_bytes.add(static_cast<double>(packed.bytes->size()));
      output.atlas->put(plane_rank * output.bands_per_plane + index, std::move(packed.bytes));
    }
    ++plane_rank;
  }
}

}  // namespace viewloom
