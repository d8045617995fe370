// SPDX-License-Identifier: Apache-2.0
#include "bench/endless_atlases.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

namespace viewloom::bench {
namespace {

constexpr size_t kRgbBytes = 3;
// Between looks at whether an atlas has left. One of 25 MB takes several times as long to leave.
constexpr std::chrono::milliseconds kLook(2);
// After that, an atlas that has not left is lost: its viewer left with it, and another one watches.
constexpr std::chrono::milliseconds kLost(500);

std::vector<EncodedBand> bandsOf(const AtlasLayout& layout, const EncodingSpec& encoding) {
  std::vector<EncodedBand> bands;
  const uint32_t height_px = layout.size_px.height;
  const uint32_t rows_per_band = bandRowCount(encoding);
  for (uint32_t row = 0; row < height_px; row += rows_per_band) {
    const uint32_t row_count = std::min(rows_per_band, height_px - row);
    const size_t byte_count = size_t{layout.size_px.width} * row_count * kRgbBytes;
    bands.push_back({.first_row = row,
                     .row_count = row_count,
                     .encoding = BandEncoding::kRaw,
                     .bytes = std::make_shared<const std::vector<uint8_t>>(byte_count)});
  }
  return bands;
}

}  // namespace

EndlessAtlases::EndlessAtlases() : thread_([this](const std::stop_token& stop) { run(stop); }) {}

void EndlessAtlases::run(const std::stop_token& stop) {
  const Counter& sent = server_.metrics().atlases_sent[Transport::kGrpc];
  const Counter& skipped = server_.metrics().replaced[HandOver::kGrpc];
  double published_count = 0;  // by what follows, all of them counted
  double seen_count = 0;       // of those that were gone at the last look
  std::chrono::steady_clock::time_point since = {};
  for (; !stop.stop_requested(); std::this_thread::sleep_for(kLook)) {
    const std::vector<ActiveDisplayPtr> displays = server_.broadcaster().displays("");
    if (displays.empty()) continue;
    const ActiveDisplay& display = *displays.front();
    const double gone_count = sent.value() + skipped.value();
    const auto now = std::chrono::steady_clock::now();
    if (std::exchange(seen_count, gone_count) != gone_count) since = now;
    if (now - since > kLost) published_count = gone_count;
    // One leaves and one waits, so that the call is never without an atlas.
    if (gone_count + 1 < published_count) continue;
    publish(display);
    ++published_count;
  }
}

void EndlessAtlases::publish(const ActiveDisplay& display) {
  const auto layout = std::make_shared<const AtlasLayout>(
      makeAtlasLayout(display.spec, {.source_size_px = {1, 1}}).value());
  if (bands_.empty()) bands_ = bandsOf(*layout, display.encoding);
  server_.broadcaster().noteLayout(display.id, layout);
  auto atlas = std::make_shared<EncodedAtlas>();
  atlas->display_id = display.id;
  atlas->sequence = server_.broadcaster().atlasCount(display.id) + 1;
  atlas->frame_number = atlas->sequence;
  atlas->layout = layout;
  atlas->encoding = display.encoding;
  atlas->bands = bands_;
  server_.broadcaster().publish(std::move(atlas));
}

}  // namespace viewloom::bench
