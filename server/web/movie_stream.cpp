// SPDX-License-Identifier: Apache-2.0
#include "web/movie_stream.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <utility>

#include "admission/request_boundary.h"
#include "base/log.h"
#include "base/str_cat.h"
#include "display/atlas_layout.h"
#include "display/quilt_json.h"
#include "mp4/movie_fragments.h"
#include "web/atlas_message.h"
#include "web/quilt_address.h"

namespace viewloom {
namespace {

constexpr std::chrono::milliseconds kRepeatPause{1000};
// Length of a fragment, which is not known before the next one: that of the fragment before.
constexpr int64_t kFirstStep_ns = 100'000'000;
constexpr int64_t kStepMax_ns = 1'000'000'000;

AtlasTiles tilesOf(const TileGrid& grid) {
  const auto height_px = uint32_t(grid.height_px);
  return {.atlas_px = {uint32_t(grid.width_px), height_px},
          .tile_px = grid.tile_size_px,
          .columns = grid.columns,
          .rows = grid.rows,
          .padding_top_px = height_px - grid.rows * grid.tile_size_px.height};
}

std::string commentOf(const AtlasLayout& layout) {
  if (layout.suffix.empty()) return "";
  return quiltJson({.view_count = uint32_t(layout.views.size()),
                    .columns = layout.columns,
                    .rows = layout.rows,
                    .aspect = layout.aspect});
}

void append(std::vector<uint8_t>& to, const std::vector<uint8_t>& bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}

}  // namespace

absl::StatusOr<MovieCoding> planMovie(const WatchRequest& request,
                                      const VideoEncoderChoicePtr& encoders) {
  EncodingSpec video = request.encoding;
  video.color = BandEncoding::kH264;
  VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(validateEncodingOf(request.display, video), "encoding"));
  MovieCoding coding{.atlas = tilesOf(tileGridOf(request.display)),
                     .qp = matchedVideoQp(video.jpeg_quality),
                     .encoders = encoders};
  const absl::StatusOr<VideoTiles> tiles = fitVideoTiles(coding.atlas, encoders->limit());
  VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(tiles.status(), "display"));
  coding.video = *tiles;
  return coding;
}

MovieStream::MovieStream(WebContext& context, Caller caller, net::any_io_executor strand,
                         std::string identity, const MovieCoding& coding)
    : LiveStream(context, std::move(caller), std::move(strand), std::move(identity)),
      coding_(coding) {}

absl::Status MovieStream::subscribe(const WatchRequest& request) {
  const auto executor = strand();
  place_ = context_.movie_places.take(identity_, [executor, weak = weak_from_this()] {
    net::post(executor, [weak] {
      if (const auto self = weak.lock()) self->leave();
    });
  });
  if (!place_) {
    return absl::ResourceExhaustedError(
        strCat("the server sends ", context_.options.movie_count_max,
               " videos at once (http.videos_max), and all places are taken; take motion JPEG "
               "(.mjpg in place of .mp4), or try again later"));
  }
  const SizePx size_px = coding_.video.picture_px;
  absl::StatusOr<Reservation> memory = context_.memory.reserve(
      {.use = MemoryUse::kViewers,
       .identity = identity_,
       .bytes = MovieCoder::memoryBytes(coding_) + 5 * coding_.atlas.atlas_px.area()},
      strCat("a video of this display (", size_px.width, "x", size_px.height, " px)"),
      [](uint64_t) { return std::string(); });
  VIEWLOOM_RETURN_IF_ERROR(memory.status());
  memory_ = *std::move(memory);
  title_ = request.stream;
  display_key_ = strCat(displayKey(request.display), kMovieExtension);
  return LiveStream::subscribe(request);
}

net::awaitable<void> MovieStream::writeAtlases(ErrorCode& error) {
  Time repeat_time = Time::max();
  while (!error && !isOver()) {
    auto arrival = inbox().take();
    if (!arrival && now() < repeat_time) {
      co_await waitUntil(repeat_time);
      continue;
    }
    AtlasPtr atlas;
    if (arrival) atlas = std::move(arrival->atlas);
    const bool is_new = atlas != nullptr;
    co_await makePart(std::move(atlas));
    if (!made_.ok()) {
      if (isWanted()) log(LogLevel::kWarning, "a live video ends: ", made_.message());
      co_return;
    }
    std::vector<net::const_buffer> parts;
    parts.push_back(net::buffer(part_));
    co_await write(std::move(parts), error);
    if (is_new && !error) context_.metrics.atlases_sent[Transport::kWeb].add();
    repeat_time = now() + kRepeatPause;
  }
}

// Each fragment is whole by itself.
net::awaitable<void> MovieStream::writeEnd(ErrorCode&) {
  co_return;
}

net::awaitable<void> MovieStream::makePart(AtlasPtr atlas) {
  is_made_ = false;
  auto self = std::static_pointer_cast<MovieStream>(shared_from_this());
  MovieWork work{.claim = {.deadline_ns = context_.clock.nowNs(),
                           .payers = {Payer(identity_)},
                           .stream = title_,
                           .display = display_key_},
                 .px_count = coding_.atlas.atlas_px.area(),
                 .work = [self = std::move(self), atlas = std::move(atlas)]() mutable {
                   makeNow(std::move(self), std::move(atlas));
                 }};
  context_.movie_threads.run(std::move(work));
  while (!is_made_) co_await waitUntil(Time::max());
}

void MovieStream::makeNow(std::shared_ptr<MovieStream> self, AtlasPtr atlas) {
  self->made_ = unlessThrown([&] { return self->encode(atlas.get()); });
  const net::any_io_executor executor = self->strand();
  self->is_made_ = true;
  try {
    // The strand lets go of both, so that nothing ends on this thread.
    net::post(executor, [self = std::move(self), atlas = std::move(atlas)] { self->wake(); });
  } catch (const std::bad_alloc&) {
    // The strand looks by itself, within kRecheckInterval.
  }
}

absl::Status MovieStream::checkWanted() const {
  return isWanted() ? absl::OkStatus() : absl::CancelledError("nobody wants the video any more");
}

absl::Status MovieStream::encode(const EncodedAtlas* atlas) {
  part_.clear();
  VIEWLOOM_RETURN_IF_ERROR(checkWanted());
  if (atlas != nullptr) shown_time_ns_ = atlas->shown_time_ns;
  const int64_t time_ns = clock_.next(shown_time_ns_, context_.clock.nowNs());
  const auto coded = code(atlas, time_ns);
  VIEWLOOM_RETURN_IF_ERROR(coded.status());
  if (!track_) {
    absl::StatusOr<AvcTrack> track = readAvcTrack(*coded);
    VIEWLOOM_RETURN_IF_ERROR(track.status());
    track_ = *std::move(track);
    append(part_, makeFragmentsHead(
                      *track_,
                      {.title = title_, .comment = commentOf(*atlas->layout), .tool = "viewloom"}));
  }
  const absl::StatusOr<AvcSample> sample = makeAvcSample(*coded, track_->sets);
  VIEWLOOM_RETURN_IF_ERROR(sample.status());
  appendFragment(*sample, time_ns);
  return absl::OkStatus();
}

absl::StatusOr<std::span<const uint8_t>> MovieStream::code(const EncodedAtlas* atlas,
                                                           int64_t time_ns) {
  if (atlas == nullptr) return coder_->codeAgain(time_ns);
  if (!coder_) {
    auto coder = MovieCoder::make(coding_);
    VIEWLOOM_RETURN_IF_ERROR(coder.status());
    coder_ = *std::move(coder);
  }
  jpeg_.clear();
  for (const SharedBytes& band : colorBands(*atlas)) {
    jpeg_.insert(jpeg_.end(), band->begin(), band->end());
  }
  VIEWLOOM_RETURN_IF_ERROR(decoder_.decode(jpeg_, coding_.atlas.atlas_px, rgba_));
  VIEWLOOM_RETURN_IF_ERROR(checkWanted());
  return coder_->code({.samples = rgba_.data(), .channel_count = 4}, time_ns);
}

void MovieStream::appendFragment(const AvcSample& sample, int64_t time_ns) {
  const int64_t step_ns = fragment_count_ == 0 ? kFirstStep_ns : time_ns - last_time_ns_;
  last_time_ns_ = time_ns;
  const uint64_t step_ticks = movieTicks(std::min(step_ns, kStepMax_ns));
  append(part_, makeFragmentHead(sample, {.number = ++fragment_count_,
                                          .begin_ticks = movieTicks(time_ns),
                                          .duration_ticks = uint32_t(step_ticks)}));
  append(part_, sample.bytes);
}

}  // namespace viewloom
