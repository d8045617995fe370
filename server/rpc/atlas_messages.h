// SPDX-License-Identifier: Apache-2.0
// One atlas as the messages of StreamAtlases: header, bands in pieces as they are packed, end.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <grpcpp/support/byte_buffer.h>

#include "encode/encoded_band.h"
#include "publish/growing_atlas.h"

namespace viewloom {

// Most data of bands in one message.
inline constexpr size_t kPieceBytesMax = size_t{1} << 20;
// Data that a piece waits for, unless it is the last of its band: so much for each viewer of the
// display. Each message has a cost beside its bytes, and many viewers multiply it.
inline constexpr size_t kPieceBytesMin = size_t{128} << 10;

// A serialised StreamAtlasesResponse, to compare with the layout sent before.
std::string layoutMessage(const EncodedAtlas& atlas);
grpc::ByteBuffer skippedMessage(uint64_t count);

// Hands out one message after the other. The bytes of the bands are shared, never copied. The bands
// of a JPEG image leave as one band, in pieces. Where an image has several planes, they leave as a
// few, so that the planes take turns. Thread-safety: none.
class AtlasMessages {
 public:
  // The first piece of an atlas that has one viewer waits for nothing.
  explicit AtlasMessages(GrowingAtlasPtr growing, size_t viewer_count = 1);

  // Whether the first piece is there; else `reader` hears of it.
  bool mayBegin(const std::weak_ptr<AtlasReader>& reader) const;

  // Whether next() has something to give.
  bool isReady() const;
  // The next message; none while the atlas has to grow first, then `reader` hears of that. Expects
  // !done().
  std::optional<grpc::ByteBuffer> next(const std::weak_ptr<AtlasReader>& reader);
  // Unless the atlas is whole, its next message is the last: it is abandoned for this client.
  void giveUp() { has_given_up_ = true; }
  // The last message is out: the end of the atlas, or that it is abandoned.
  bool done() const { return outcome_ != GrowingAtlas::State::kGrowing; }
  // Which of both.
  bool wasWhole() const { return outcome_ == GrowingAtlas::State::kWhole; }
  const EncodedAtlas& atlas() const { return atlas_; }
  // State of the atlas for this client.
  GrowingAtlas::State state() const;

 private:
  // Packed bands in a row that leave as one.
  struct Strip {
    size_t first_band = 0;
    size_t band_count = 0;
  };

  static std::vector<Strip> stripsOf(const EncodedAtlas& atlas);
  BandsWanted wanted() const;
  grpc::ByteBuffer header() const;
  grpc::ByteBuffer nextPiece(size_t ready_count);
  grpc::ByteBuffer last(GrowingAtlas::State outcome);

  GrowingAtlasPtr growing_;
  const EncodedAtlas& atlas_;  // the same
  size_t viewer_count_;
  std::vector<Strip> strips_;
  bool has_begun_ = false;  // the header is out
  bool has_given_up_ = false;
  GrowingAtlas::State outcome_ = GrowingAtlas::State::kGrowing;  // that the client was told
  size_t strip_ = 0;
  size_t band_ = 0;                // the next in the strip
  size_t band_offset_bytes_ = 0;   // in it, if it is too large for one message
  size_t strip_offset_bytes_ = 0;  // of the strip that are out
};

}  // namespace viewloom
