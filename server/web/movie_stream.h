// SPDX-License-Identifier: Apache-2.0
// Live MP4: a head, then a fragment for each atlas.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "decode/jpeg_plane.h"
#include "mp4/avc_track.h"
#include "mp4/movie_clock.h"
#include "mp4/movie_coder.h"
#include "web/live_stream.h"
#include "web/movie_places.h"

namespace viewloom {

// Plans the video of a display. INVALID_ARGUMENT for displays that are no views, such as panels.
// RESOURCE_EXHAUSTED for those that no video takes.
absl::StatusOr<MovieCoding> planMovie(const WatchRequest& request,
                                      const VideoEncoderChoicePtr& encoders);

// The player gets H.264 that its own encoder makes of the JPEG atlases, on context.movie_threads
// and in the fair share of its identity. A picture that stands is coded again each second, so that
// players and proxies go on. A player that reads slowly skips atlases before they are encoded. One
// that goes, or has to, ends what waits to be encoded.
class MovieStream final : public LiveStream {
 public:
  MovieStream(WebContext& context, Caller caller, net::any_io_executor strand, std::string identity,
              const MovieCoding& coding);

  // Also RESOURCE_EXHAUSTED if all places for videos are taken, or memory is missing for one.
  absl::Status subscribe(const WatchRequest& request) override;

 private:
  net::awaitable<void> writeAtlases(ErrorCode& error) override;
  net::awaitable<void> writeEnd(ErrorCode& error) override;
  // Makes part_ of the atlas; of the last one again if it is null.
  net::awaitable<void> makePart(AtlasPtr atlas);
  // The next four run on a movie thread, while the strand waits for is_made_.
  static void makeNow(std::shared_ptr<MovieStream> self, AtlasPtr atlas);
  absl::Status encode(const EncodedAtlas* atlas);
  absl::StatusOr<std::span<const uint8_t>> code(const EncodedAtlas* atlas, int64_t time_ns);
  void appendFragment(const AvcSample& sample, int64_t time_ns);
  // CANCELLED once the player has gone, or has to.
  absl::Status checkWanted() const;

  const MovieCoding coding_;
  std::string title_;
  std::string display_key_;
  MoviePlaces::PlacePtr place_;
  Reservation memory_;
  std::unique_ptr<MovieCoder> coder_;  // from the first atlas on
  std::optional<AvcTrack> track_;      // the same
  JpegDecoder decoder_;
  std::vector<uint8_t> jpeg_;
  std::vector<uint8_t> rgba_;
  MovieClock clock_;
  int64_t shown_time_ns_ = 0;  // of the last atlas
  int64_t last_time_ns_ = 0;   // of the last fragment
  uint32_t fragment_count_ = 0;
  std::vector<uint8_t> part_;  // of the body
  absl::Status made_;          // how the last part went
  std::atomic<bool> is_made_ = false;
};

}  // namespace viewloom
