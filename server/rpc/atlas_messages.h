// SPDX-License-Identifier: Apache-2.0
// One atlas as the messages of StreamAtlases: header, bands in pieces, end.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <grpcpp/support/byte_buffer.h>

#include "encode/encoded_band.h"

namespace viewloom {

// Most data of bands in one message.
inline constexpr size_t kPieceBytesMax = size_t{1} << 20;

// A serialised StreamAtlasesResponse, to compare with the layout sent before.
std::string layoutMessage(const EncodedAtlas& atlas);
grpc::ByteBuffer skippedMessage(uint64_t count);

// Hands out one message after the other. The bytes of the bands are shared, never copied. Bands
// that joined are one leave as one, as many as a message holds: each message costs the server and
// its reader some 10 us beside its bytes. Thread-safety: none.
class AtlasMessages {
 public:
  explicit AtlasMessages(AtlasPtr atlas);

  // Expects !done().
  grpc::ByteBuffer next();
  bool done() const { return part_ == Part::kDone; }

 private:
  // Bands in a row that leave as one.
  struct Strip {
    size_t first_band = 0;
    size_t band_count = 0;
    size_t byte_count = 0;
  };

  static std::vector<Strip> stripsOf(const EncodedAtlas& atlas);
  grpc::ByteBuffer header() const;
  grpc::ByteBuffer nextPiece();
  grpc::ByteBuffer endMessage() const;

  enum class Part { kHeader, kBands, kEnd, kDone };

  AtlasPtr atlas_;
  std::vector<Strip> strips_;
  Part part_ = Part::kHeader;
  size_t strip_ = 0;
  size_t offset_bytes_ = 0;  // in the strip, if that is a band too large for one message
};

}  // namespace viewloom
