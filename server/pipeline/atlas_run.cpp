// SPDX-License-Identifier: Apache-2.0
#include "pipeline/atlas_run.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/check.h"

namespace viewloom {
namespace {

uint32_t ceilDivide(uint32_t value, uint32_t by) {
  return (value + by - 1) / by;
}

AtlasOutput makeOutput(ActiveDisplayPtr display, const AtlasLayout& layout) {
  AtlasOutput output;
  output.band_row_count = bandRowCount(display->encoding);
  output.bands_per_image = ceilDivide(layout.imageSize().height, output.band_row_count);
  output.bands_per_plane = layout.image_count * output.bands_per_image;
  if (display->encoding.color == BandEncoding::kH264) {
    VIEWLOOM_CHECK(layout.stack.has_value());
    output.video = std::make_unique<VideoAtlas>(*layout.stack, display->encoding.video_qp);
  }
  output.display = std::move(display);
  return output;
}

// Displays of one picture are all chained, or none; where their orders differ, the oldest decides.
PictureOrder orderOfPictures(const ActiveDisplay& display) {
  return display.chain ? display.chain->nextOrder() : PictureOrder::kForward;
}

std::vector<ActiveDisplayPtr> onSecondRung(const std::vector<AtlasOutput>& outputs) {
  std::vector<ActiveDisplayPtr> displays;
  for (const AtlasOutput& output : outputs) {
    if (output.display->encoding.rung == VideoRung::kSecond) displays.push_back(output.display);
  }
  return displays;
}

}  // namespace

size_t AtlasOutput::firstBandOf(uint32_t rank) const {
  if (!video || rank == 0) return size_t{rank} * bands_per_plane;
  return video->pictureCount() + size_t{rank - 1} * bands_per_plane;
}

AtlasRun::AtlasRun(AtlasJob atlas_job, PicturePtr resolved, const Pose& pose,
                   std::vector<ActiveDisplayPtr> displays)
    : job(std::move(atlas_job)),
      picture(std::move(resolved)),
      display_pose(pose),
      claim(claimOf(job)) {
  // Planes of Y'CbCr lie together for a whole atlas, and pair its rows. Images of a stack have even
  // heights.
  const bool are_pairs_whole = picture->layout->image_count == 1 || picture->layout->stack;
  planes.color = are_pairs_whole ? directForm(displays.front()->encoding) : ColorForm::kRgba;
  uint32_t strip_row_count = 0;
  for (ActiveDisplayPtr& display : displays) {
    if (directForm(display->encoding) != planes.color) planes.color = ColorForm::kRgba;
    planes.depth |= display->encoding.with_depth || display->encoding.with_depth_codes;
    planes.mask |= display->encoding.with_mask;
    outputs.push_back(makeOutput(std::move(display), *picture->layout));
    // 8 MCU rows are 64 or 128 px, so every output's bands tile a strip of the highest.
    strip_row_count = std::max(strip_row_count, outputs.back().band_row_count);
  }
  strips =
      AtlasStrips(*picture->layout, strip_row_count, orderOfPictures(*outputs.front().display));
  for (size_t output = 0; output < outputs.size(); ++output) {
    uint32_t rank = 0;
    for (const AtlasPlane plane : planesOf(outputs[output].display->encoding)) {
      packs.push_back({output, plane, rank++});
    }
  }
  for (uint32_t strip = 0; strip < strips.count(); ++strip) {
    rows_left_ += strips.rowsOf(strip).row_count * packs.size();
  }
  claim.is_tracked = isTracked();
}

std::vector<ActiveDisplayPtr> AtlasRun::reserveVideo(MemoryBudget& memory) {
  uint64_t bytes = 0;
  for (const AtlasOutput& output : outputs) {
    if (!output.video) continue;
    // The encoder of a chain is part of the display's price.
    const VideoStack& stack = *picture->layout->stack;
    bytes += isChained() ? videoPicturesBytes(stack) : videoAtlasBytes(stack);
  }
  if (bytes == 0) return {};
  std::optional<Reservation> reserved =
      memory.tryReserve({.use = MemoryUse::kAtlases, .bytes = bytes});
  if (!reserved) {
    std::vector<ActiveDisplayPtr> favours = onSecondRung(outputs);
    if (!favours.empty()) return favours;
    throw EngineOutOfMemory(
        "the server's memory.budget has no room left to code a video of this size; choose a "
        "smaller display, color as JPEG, or try again later");
  }
  video_memory_ = *std::move(reserved);
  is_last_of_video_ = memory.leftFor("") < bytes;
  return {};
}

void AtlasRun::noteOlder() {
  is_last_of_video_ |= video_memory_.bytes() > 0;
}

void AtlasRun::noteTraced(const RayCounts& strip_counts, int64_t now_ns) {
  std::lock_guard lock(mutex_);
  counts_.coverage.add(strip_counts.coverage);
  counts_.reflections.add(strip_counts.reflections);
  traced_ns_ = std::max(traced_ns_, now_ns);
}

void AtlasRun::abandon() {
  giveUp();
  for (const AtlasOutput& output : outputs) {
    if (output.atlas) output.atlas->abandon();
  }
}

RayCounts AtlasRun::counts() const {
  std::lock_guard lock(mutex_);
  return counts_;
}

int64_t AtlasRun::tracedNs() const {
  std::lock_guard lock(mutex_);
  return traced_ns_;
}

}  // namespace viewloom
