// SPDX-License-Identifier: Apache-2.0
#include "pipeline/atlas_publisher.h"

#include <algorithm>
#include <utility>

#include "base/log.h"
#include "video/annex_b.h"

namespace viewloom {
namespace {

StageTimes stageTimes(const AtlasRun& run, int64_t encoded_ns) {
  const ResidentStructure& structure = *run.job.structure;
  const FrameTimes& frame = structure.times;
  const int64_t traced_ns = run.tracedNs();
  // A frame stands as long as it likes before a display asks for it: that is nobody's delay.
  const int64_t stood_ns = std::max<int64_t>(0, run.job.asked_ns - structure.built_at_ns);
  return {.receive_ns = frame.last_chunk_ns - frame.first_chunk_ns,
          .decode_ns = frame.decoded_ns - frame.last_chunk_ns,
          .upload_ns = structure.upload_ns,
          .build_ns = structure.build_ns,
          .retime_ns = structure.retime_ns + (run.job.before ? run.job.before->retime_ns : 0),
          .wait_ns = run.begun_ns - structure.built_at_ns - stood_ns,
          .trace_ns = traced_ns - run.begun_ns,
          .encode_ns = encoded_ns - traced_ns,
          .total_ns = encoded_ns - frame.first_chunk_ns - stood_ns};
}

bool isSeenByEyes(const AtlasRun& run) {
  return run.outputs.front().atlas->atlas().eye_poses_latched_ns != 0;
}

void count(const Metrics& metrics, const AtlasRun& run, const StageTimes& times,
           const Coverage& coverage) {
  // Eyes move and time goes on before one frame: how long that took is no answer to a frame.
  if (!isSeenByEyes(run) && !run.job.tick) {
    metrics.observeStage(Stage::kWait, times.wait_ns);
    metrics.observeStage(Stage::kTotal, times.total_ns);
  }
  metrics.observeStage(Stage::kTrace, times.trace_ns);
  metrics.observeStage(Stage::kEncode, times.encode_ns);
  metrics.atlases_traced[run.method].add();
  metrics.rays[RayAnswer::kHit].add(static_cast<double>(coverage.hit));
  metrics.rays[RayAnswer::kHitAssumed].add(static_cast<double>(coverage.hit_assumed));
  metrics.rays[RayAnswer::kHidden].add(static_cast<double>(coverage.hidden));
  metrics.rays[RayAnswer::kOutside].add(static_cast<double>(coverage.outside));
  metrics.rays[RayAnswer::kEmpty].add(static_cast<double>(coverage.empty));
}

// No view looks past a cube map.
std::vector<double> sharesOutside(const AtlasLayout& layout, const Pose& display_pose,
                                  const ResidentStructure& structure) {
  const SeenSource& source = structure.sources.front();
  if (source.is_cube_map) return {};
  const Pose& source_pose = source.camera.pose;
  // Exact where a display stands in its source: rounding must not look like a step aside.
  const Pose from_display =
      display_pose == source_pose ? Pose{} : compose(inverse(source_pose), display_pose);
  return outsideShares(layout, from_display, source.camera.intrinsics, source.size_px,
                       {.far = structure.stats.inv_z_far, .near = structure.stats.inv_z_near});
}

// The bands that the output will have, without their bytes.
std::vector<EncodedBand> bandsOf(const AtlasOutput& output, const AtlasLayout& layout,
                                 const AtlasStrips& strips) {
  const EncodingSpec& encoding = output.display->encoding;
  const uint32_t image_height = layout.imageSize().height;
  std::vector<EncodedBand> bands;
  for (const AtlasPlane plane : planesOf(encoding)) {
    const bool is_video = output.video && plane == AtlasPlane::kColor;
    const uint32_t band_row_count = is_video ? image_height : output.band_row_count;
    for (uint32_t place = 0; place < layout.image_count; ++place) {
      for (uint32_t row = 0; row < image_height; row += band_row_count) {
        bands.push_back({.image_index = strips.imageAt(place),
                         .plane = plane,
                         .first_row = row,
                         .row_count = std::min(band_row_count, image_height - row),
                         .encoding = isColor(plane) ? encoding.color : encoding.planes,
                         .bytes = nullptr});
      }
    }
  }
  return bands;
}

// The facts about the run's atlases that do not depend on display and encoding.
EncodedAtlas begunAtlas(const AtlasRun& run) {
  const ResidentStructure& structure = *run.job.structure;
  EncodedAtlas atlas;
  atlas.frame_number = structure.frame_number;
  atlas.capture_time_ns = structure.capture_time_ns;
  const std::optional<OutputTick>& tick = run.job.tick;
  atlas.shown_time_ns = tick ? tick->shown.time_ns : atlas.capture_time_ns;
  if (tick) atlas.timing = tick->shown.timing;
  const EyeTrackPtr& track = run.outputs.front().display->eyes;
  if (const EyePosesPtr eyes = track ? track->used() : nullptr) {
    atlas.eye_poses_time_ns = eyes->time_ns;
    atlas.predicted_display_time_ns = eyes->predicted_display_time_ns;
    atlas.eye_poses_latched_ns = run.begun_ns;
    atlas.eye_poses_age_ns = run.begun_ns - eyes->received_ns;
  }
  atlas.source_camera = structure.sources.front().camera;
  atlas.display_pose = run.display_pose;
  atlas.layout = run.picture->layout;
  atlas.method = run.method;
  atlas.picture_order = run.strips.order();
  atlas.stats = structure.stats;
  atlas.taking = structure.taking;
  atlas.depth_budget = depthBudget(*atlas.layout, structure.stats, structure.depths);
  atlas.outside_shares = sharesOutside(*atlas.layout, atlas.display_pose, structure);
  return atlas;
}

// Its quantisation, and the atlas that it refers to.
void beginVideo(const AtlasOutput& output, int64_t now_ns, EncodedAtlas& atlas) {
  const ActiveDisplay& display = *output.display;
  VideoStart start{.qp = display.encoding.video_qp};
  if (display.coding) {
    const bool is_again = display.chain && display.chain->isDue();
    start.qp = is_again ? display.coding->beginAgain(now_ns) : display.coding->beginAtlas(now_ns);
  }
  atlas.video_qp = start.qp;
  if (display.chain) {
    atlas.reference_sequence = display.chain->begin(atlas.sequence, now_ns, atlas.picture_order);
    start.chain = display.chain->coder();
    start.is_self_contained = atlas.reference_sequence == 0;
  }
  output.video->begin(std::move(start));
}

bool beginsAnew(const EncodedAtlas& atlas) {
  return std::ranges::any_of(nalUnits(*atlas.bands.front().bytes),
                             [](const NalUnit& unit) { return unit.type() == NalType::kIdrSlice; });
}

// Readers learn what an atlas takes by those before it. Of a chain, those that begin anew are few
// and large, and say nothing about the rest: also where an encoder had to, unasked.
void noteCoded(const AtlasOutput& output, const EncodedAtlas& atlas) {
  const ActiveDisplay& display = *output.display;
  if (display.chain) display.chain->noteWhole(atlas.sequence);
  const bool is_usual = !display.chain || !beginsAnew(atlas);
  if (display.coding && is_usual) display.coding->noteCoded(atlas.video_qp, atlas.byteCount());
  if (display.coding) display.coding->noteCodingTime(output.video->codingNs());
}

}  // namespace

void AtlasPublisher::open(AtlasRun& run) const {
  const EncodedAtlas begun = begunAtlas(run);
  for (AtlasOutput& output : run.outputs) {
    EncodedAtlas atlas = begun;
    atlas.display_id = output.display->id;
    atlas.sequence = links_.broadcaster.nextSequence(atlas.display_id);
    atlas.encoding = output.display->encoding;
    if (output.video) beginVideo(output, links_.clock.nowNs(), atlas);
    atlas.bands = bandsOf(output, *atlas.layout, run.strips);
    output.atlas = std::make_shared<GrowingAtlas>(std::move(atlas));
    links_.broadcaster.begin(output.atlas);
  }
}

void AtlasPublisher::begin(AtlasRunPtr run) {
  std::lock_guard lock(mutex_);
  std::deque<Pending>& of_picture = pending_[run->job.picture_key];
  const bool has_older =
      std::ranges::any_of(of_picture, [](const Pending& pending) { return !pending.is_complete; });
  if (has_older) run->noteOlder();
  of_picture.push_back({std::move(run)});
}

void AtlasPublisher::complete(const AtlasRun& run) {
  publishInOrder(run);
  on_complete_(run);
}

void AtlasPublisher::publishInOrder(const AtlasRun& run) {
  // Published under the lock: two threads must not overtake each other.
  std::lock_guard lock(mutex_);
  const auto of_picture = pending_.find(run.job.picture_key);
  if (of_picture == pending_.end()) return;  // given up
  std::deque<Pending>& runs = of_picture->second;
  for (Pending& pending : runs) pending.is_complete |= pending.run.get() == &run;
  publishCompleted(runs);
  if (runs.empty()) pending_.erase(of_picture);
}

void AtlasPublisher::publishCompleted(std::deque<Pending>& runs) {
  while (!runs.empty() && runs.front().is_complete) {
    publish(*runs.front().run);
    runs.pop_front();
  }
}

void AtlasPublisher::giveUp(AtlasRun& run, const absl::Status& status) {
  AtlasRunPtr given_up;  // let go after the lock: its ticket may report
  {
    std::lock_guard lock(mutex_);
    const auto of_picture = pending_.find(run.job.picture_key);
    if (of_picture == pending_.end()) return;
    std::deque<Pending>& runs = of_picture->second;
    const auto found = std::ranges::find_if(
        runs, [&](const Pending& pending) { return pending.run.get() == &run; });
    if (found == runs.end()) return;
    given_up = std::move(found->run);
    runs.erase(found);
    given_up->abandon();
    publishCompleted(runs);
    if (runs.empty()) pending_.erase(of_picture);
  }
  log(LogLevel::kWarning, "a display of stream ", run.outputs.front().display->stream,
      " is given up: ", status.message());
  for (const AtlasOutput& output : run.outputs) {
    links_.broadcaster.refuse(output.display->id, status);
  }
  on_complete_(run);
}

bool AtlasPublisher::giveUpUnwatched() {
  std::vector<AtlasRunPtr> given_up;  // let go after the lock: their tickets may report
  {
    // Its holder may wait for a subscriber.
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock()) return false;
    const auto isWatched = [&](const AtlasOutput& output) {
      return links_.broadcaster.display(output.display->id) != nullptr;
    };
    for (auto& [picture_key, runs] : pending_) {
      std::erase_if(runs, [&](const Pending& pending) {
        if (std::ranges::any_of(pending.run->outputs, isWatched)) return false;
        pending.run->giveUp();
        given_up.push_back(pending.run);
        return true;
      });
    }
    std::erase_if(pending_, [](const auto& entry) { return entry.second.empty(); });
  }
  if (!given_up.empty()) links_.metrics.atlases_given_up.add(double(given_up.size()));
  for (const AtlasRunPtr& run : given_up) on_complete_(*run);
  return true;
}

void AtlasPublisher::giveUpAll() {
  std::lock_guard lock(mutex_);
  for (const auto& [picture_key, runs] : pending_) {
    for (const Pending& pending : runs) pending.run->giveUp();
    links_.metrics.atlases_given_up.add(double(runs.size()));
  }
}

void AtlasPublisher::dropAll() {
  decltype(pending_) dropped;  // let go after the lock: its tickets may report
  {
    std::lock_guard lock(mutex_);
    dropped.swap(pending_);
  }
  for (const auto& [picture_key, runs] : dropped) {
    for (const Pending& pending : runs) pending.run->abandon();
  }
}

void AtlasPublisher::publish(AtlasRun& run) {
  const int64_t now_ns = links_.clock.nowNs();
  const StageTimes times = stageTimes(run, now_ns);
  if (run.job.tick) links_.metrics.observeOutputDelay(now_ns - run.job.tick->due_ns);
  const RayCounts counts = run.counts();
  count(links_.metrics, run, times, counts.coverage);
  for (AtlasOutput& output : run.outputs) {
    const AtlasPtr atlas = output.atlas->complete(
        {.times = times, .coverage = counts.coverage, .reflections = counts.reflections});
    if (isSeenByEyes(run)) {
      links_.metrics.eye_poses_age.observe(double(atlas->eye_poses_age_ns) * 1e-9);
    }
    noteCoded(output, *atlas);
    if (atlas->video_qp > atlas->encoding.video_qp) links_.metrics.coarse_atlases.add();
    links_.broadcaster.publish(atlas);
    links_.metrics.atlases_encoded.add();
    if (run.job.ticket) run.job.ticket->noteTraced({atlas->display_id, counts.coverage, times});
  }
  run.job.ticket.reset();
}

}  // namespace viewloom
