// SPDX-License-Identifier: Apache-2.0
#include "pipeline/encode_pool.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "base/idle_memory.h"
#include "base/processor_count.h"
#include "base/thread_name.h"
#include "base/thread_time.h"
#include "pipeline/within_memory.h"

namespace viewloom {
namespace {

// Packed bands that wait for reuse; more than any server has on their way, far fewer than matter.
constexpr size_t kKeptBandCount = 1024;

template <typename Sample>
std::span<const uint8_t> bytesOf(std::span<const Sample> samples) {
  return {reinterpret_cast<const uint8_t*>(samples.data()), samples.size_bytes()};
}

// Time that other threads have spent on the work of this one, ns.
thread_local int64_t helpers_ns = 0;

int64_t spentWithHelpNs() {
  return threadTimeNs() + helpers_ns;
}

// Pictures of videos that wait for reuse.
constexpr size_t kKeptPictureCount = 64;

// Codes the next picture of a video. It packs no strip.
class PictureCoding final : public StripWork {
 public:
  PictureCoding(int64_t predicted_ns, std::function<void()> code,
                std::function<void(int64_t measured_ns)> note)
      : StripWork({.strip_count = 0, .piece_count = 1, .piece_ns = predicted_ns}),
        code_(std::move(code)),
        note_(std::move(note)) {}

  void makePiece(uint32_t) override { code_(); }
  void notePiece(int64_t measured_ns) override { note_(measured_ns); }
  RayCounts counts() const override { return {}; }
  StripPlanes planes(uint32_t) const override { return {}; }

 private:
  const std::function<void()> code_;
  const std::function<void(int64_t measured_ns)> note_;
};

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
  uint32_t place = 0;  // of its image, in the order of the pictures
  BandPixels color;    // rows counted in its image

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

EncodePool::EncodePool(const PipelineLinks& links, AtlasPublisher& publisher, FairShares& shares,
                       const EncodePoolOptions& options)
    : links_(links),
      publisher_(publisher),
      bytes_(kKeptBandCount),
      planes_(kKeptPictureCount),
      video_encoders_(options.video_thread_count, options.video_encoders),
      tasks_(shares),
      has_all_cores_(options.thread_count >= processorCount()),
      on_cores_free_(options.on_cores_free) {
  links_.memory.addIdle(bytes_.idleMemory());
  links_.memory.addIdle(planes_.idleMemory());
  links_.memory.addIdle(video_encoders_.idleMemory());
  for (uint32_t i = 0; i < options.thread_count; ++i) {
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
    if (are_cores_awaited_.exchange(false)) on_cores_free_();
    const int64_t begun_ns = spentWithHelpNs();
    serve(*task, encoder);
    note(*task, spentWithHelpNs() - begun_ns);
    finish(*std::move(task));
  }
}

// With fewer threads than cores, one may be idle. Whoever takes what waits after the second look
// sees that a device waits.
bool EncodePool::keepsCores(const Claim& claim) {
  if (!has_all_cores_ || !tasks_.hasForOthersWithLess(claim)) return false;
  are_cores_awaited_ = true;
  return tasks_.hasForOthersWithLess(claim);
}

void EncodePool::note(const EncodeTask& task, int64_t duration_ns) {
  tasks_.noteServed(task, duration_ns);
  links_.metrics.observePiece(task.is_strip ? EngineWork::kPack : EngineWork::kPiece,
                              task.batch->run->claim.payers,
                              {.predicted_ns = task.predicted_ns, .measured_ns = duration_ns});
}

// Work that runs out of memory costs its own atlas alone.
void EncodePool::serve(const EncodeTask& task, BandEncoder& encoder) {
  const absl::Status status = withinMemory(
      [&] { task.is_strip ? pack(task, encoder) : task.batch->work->makePiece(task.index); });
  if (!status.ok()) publisher_.giveUp(*task.batch->run, status);
}

// Room for the next atlas before this one goes out.
void EncodePool::finish(EncodeTask task) {
  const AtlasRunPtr run = task.batch->run;
  if (!task.is_strip) return tasks_.noteMade(*task.batch);  // after the last, others may pack
  task.batch.reset();
  const PackedPlane& packed = run->packs[task.pack];
  const bool is_coded_later = run->outputs[packed.output].video && isColor(packed.plane);
  if (!is_coded_later) finishRows(run, task.rows.row_count);
}

void EncodePool::finishRows(const AtlasRunPtr& run, uint32_t row_count) {
  if (!run->noteEncoded(row_count) || run->isGivenUp()) return;
  run->releaseVideo();  // the next one may need it
  const absl::Status status = withinMemory([&] { publisher_.complete(*run); });
  if (!status.ok()) publisher_.giveUp(*run, status);
}

void EncodePool::putIntoVideo(const AtlasRunPtr& run, const EncodeTask& task,
                              const StripPixels& strip) {
  const size_t output = run->packs[task.pack].output;
  const BandPixels rows = rowsOf(strip.color, task.rows.first_row, task.rows.row_count);
  if (run->outputs[output].video->put(strip.place, rows, planes_)) pushCoding(run, output);
}

void EncodePool::pushCoding(const AtlasRunPtr& run, size_t output) {
  const uint64_t px_count = run->picture->layout->imageSize().area();
  PackCosts& costs = tasks_.packCosts();
  tasks_.pushFirst(std::make_shared<StripBatch>(
      run,
      std::make_unique<PictureCoding>(
          costs.predictCodingNs(px_count), [this, run, output] { codePicture(run, output); },
          [&costs, px_count](int64_t measured_ns) { costs.noteCoding(px_count, measured_ns); })));
}

// The rows of the picture count as packed only now.
void EncodePool::codePicture(const AtlasRunPtr& run, size_t output) {
  if (run->isGivenUp()) return;
  AtlasOutput& of = run->outputs[output];
  absl::StatusOr<CodedPicture> coded = of.video->codeNext(video_encoders_, bytes_);
  if (!coded.ok()) return publisher_.giveUp(*run, coded.status());
  helpers_ns += coded->help_ns;
  links_.metrics.encoded_bytes.add(static_cast<double>(coded->bytes->size()));
  links_.metrics.bands_encoded.add();
  links_.metrics.video_pictures.add();
  of.atlas->put(coded->place, std::move(coded->bytes));
  if (coded->is_next_ready) pushCoding(run, output);
  finishRows(run, run->picture->layout->imageSize().height);
}

void EncodePool::pack(const EncodeTask& task, BandEncoder& encoder) {
  AtlasRun& run = *task.batch->run;
  const StripWork& work = *task.batch->work;
  if (task.index == 0 && task.pack == 0 && task.rows.first_row == 0) {
    run.noteTraced(work.counts(), links_.clock.nowNs());
  }
  const uint32_t strip = work.shape.first_strip + task.index;
  const StripPlanes planes = work.planes(strip);
  BandPixels color =
      rowsOf(colorPixels(planes.rgba, planes.ycbcr, planes.color_px, run.planes.color),
             planes.first_row, run.strips.rowsOf(strip).row_count);
  color.first_row = run.strips.rowInImage(strip);
  encode(task, {*run.picture->layout, planes, run.strips.placeOf(strip), color}, encoder);
}

void EncodePool::encode(const EncodeTask& task, const StripPixels& strip, BandEncoder& encoder) {
  AtlasRun& run = *task.batch->run;
  const PackedPlane& packed = run.packs[task.pack];
  AtlasOutput& output = run.outputs[packed.output];
  if (output.video && isColor(packed.plane)) return putIntoVideo(task.batch->run, task, strip);
  const EncodingSpec& encoding = output.display->encoding;
  const BandPixels pixels = strip.pixels(packed.plane);
  const uint32_t band_rows = output.band_row_count;
  const uint32_t slice_rows = std::min(task.slice_row_count, band_rows);
  const uint32_t end = task.rows.first_row + task.rows.row_count;
  for (uint32_t row = task.rows.first_row; row < end; row += slice_rows) {
    const BandPixels slice = rowsOf(pixels, row, std::min(slice_rows, end - row));
    const uint32_t in_band = row % band_rows;
    const uint32_t rows_of_band = std::min(band_rows, pixels.row_count - (row - in_band));
    const uint32_t index = strip.place * output.bands_per_image + slice.first_row / band_rows;
    const size_t band = output.firstBandOf(packed.rank) + index;
    EncodedBand encoded = encoder.encode(slice, encoding, *run.picture->layout);
    links_.metrics.encoded_bytes.add(static_cast<double>(encoded.bytes->size()));
    SharedBytes bytes = run.sliced_bands.add(
        {.output = packed.output, .index = band},
        {.index = in_band / slice_rows, .count = (rows_of_band + slice_rows - 1) / slice_rows},
        std::move(encoded.bytes), bytes_);
    if (!bytes) continue;
    links_.metrics.bands_encoded.add();
    output.atlas->put(band, std::move(bytes));
  }
}

}  // namespace viewloom
