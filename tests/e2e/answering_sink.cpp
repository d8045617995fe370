// SPDX-License-Identifier: Apache-2.0
#include "e2e/answering_sink.h"

#include <algorithm>
#include <utility>

namespace viewloom {
namespace {

constexpr size_t kRgbBytes = 3;

SharedBytes bandBytes(uint64_t frame_number, uint32_t first_row, size_t byte_count) {
  auto bytes = std::make_shared<std::vector<uint8_t>>(byte_count);
  for (size_t i = 0; i < byte_count; ++i) (*bytes)[i] = expectedByte(frame_number, first_row, i);
  return bytes;
}

}  // namespace

uint8_t expectedByte(uint64_t frame_number, uint32_t first_row, size_t index) {
  return static_cast<uint8_t>(frame_number * 31 + first_row * 7 + index + index / 256);
}

AnsweringSink::AnsweringSink(StreamDirectory& directory, Broadcaster& broadcaster)
    : directory_(directory), broadcaster_(broadcaster) {}

void AnsweringSink::offerFrame(const FrameOrigin& origin, FramePtr frame, ReportFrame report) {
  std::optional<Offered> replaced;
  {
    std::unique_lock lock(mutex_);
    Resident& resident = streams_[origin.stream];
    if (!resident.held) {
      resident.frame = frame;
      const FrameReport answered = answer(origin.stream, frame);
      lock.unlock();
      report(answered);
      return;
    }
    replaced = std::exchange(resident.waiting, Offered{std::move(frame), std::move(report)});
  }
  if (!replaced.has_value()) return;
  replaced->report({.number = replaced->frame->format.number, .outcome = FrameOutcome::kReplaced});
}

void AnsweringSink::forgetStream(const std::string& stream) {
  std::lock_guard lock(mutex_);
  streams_.erase(stream);
}

void AnsweringSink::demandChanged(const std::string& stream) {
  std::lock_guard lock(mutex_);
  const FramePtr frame = streams_[stream].frame;
  if (frame == nullptr) return;
  for (const ActiveDisplayPtr& display : broadcaster_.displays(stream)) {
    if (broadcaster_.newest(display->id) == nullptr) publishAtlas(*display, *frame);
  }
}

FramePtr AnsweringSink::resident(const std::string& stream) {
  std::lock_guard lock(mutex_);
  return streams_[stream].frame;
}

void AnsweringSink::hold(const std::string& stream) {
  std::lock_guard lock(mutex_);
  streams_[stream].held = true;
}

void AnsweringSink::letGo(const std::string& stream) {
  std::optional<Offered> waiting;
  {
    std::lock_guard lock(mutex_);
    streams_[stream].held = false;
    waiting = std::exchange(streams_[stream].waiting, std::nullopt);
  }
  if (waiting.has_value()) offerFrame({stream, 0}, waiting->frame, waiting->report);
}

FrameReport AnsweringSink::answer(const std::string& stream, const FramePtr& frame) {
  const SourceFormat& source = frame->format.sources.front();
  directory_.noteResident(stream, frame->format.number, source.layers.front().depth.size_px,
                          static_cast<uint32_t>(source.layers.size()), {.depth_step = 0.5});
  FrameReport report{.number = frame->format.number,
                     .outcome = FrameOutcome::kBuiltWithoutDisplay,
                     .stats = {.depth_step = 0.5}};
  for (const ActiveDisplayPtr& display : broadcaster_.displays(stream)) {
    report.displays.push_back(publishAtlas(*display, *frame));
    report.outcome = FrameOutcome::kTraced;
  }
  return report;
}

DisplayReport AnsweringSink::publishAtlas(const ActiveDisplay& display, const Frame& frame) {
  const SourceFormat& source = frame.format.sources.front();
  const absl::StatusOr<AtlasLayout> layout =
      makeAtlasLayout(display.spec, {.source_intrinsics = source.camera.intrinsics,
                                     .source_size_px = source.layers.front().depth.size_px,
                                     .focal_distance_m = 1});
  if (!layout.ok()) {
    broadcaster_.refuse(display.id, layout.status());
    return {};
  }
  const auto shared_layout = std::make_shared<const AtlasLayout>(*layout);
  broadcaster_.noteLayout(display.id, shared_layout);
  auto atlas = std::make_shared<EncodedAtlas>();
  atlas->display_id = display.id;
  atlas->sequence = broadcaster_.atlasCount(display.id) + 1;
  atlas->frame_number = frame.format.number;
  atlas->capture_time_ns = frame.format.capture_time_ns;
  atlas->source_camera = source.camera;
  atlas->display_pose = source.camera.pose;
  atlas->layout = shared_layout;
  atlas->encoding = display.encoding;
  atlas->coverage = {.hit = 3, .hidden = 1};
  const uint32_t height_px = layout->size_px.height;
  const uint32_t rows_per_band = bandRowCount(display.encoding);
  for (uint32_t row = 0; row < height_px; row += rows_per_band) {
    const uint32_t row_count = std::min(rows_per_band, height_px - row);
    const size_t byte_count = size_t{layout->size_px.width} * row_count * kRgbBytes;
    atlas->bands.push_back({.first_row = row,
                            .row_count = row_count,
                            .encoding = BandEncoding::kRaw,
                            .bytes = bandBytes(atlas->frame_number, row, byte_count)});
  }
  const DisplayReport report{.display_id = display.id, .coverage = atlas->coverage};
  broadcaster_.publish(std::move(atlas));
  return report;
}

}  // namespace viewloom
