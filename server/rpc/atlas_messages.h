// SPDX-License-Identifier: Apache-2.0
// One atlas as the messages of StreamAtlases: header, bands in pieces, end.
#pragma once

#include <string>
#include <utility>

#include <grpcpp/support/byte_buffer.h>

#include "encode/encoded_band.h"

namespace viewloom {

// Largest part of a band in one message.
inline constexpr size_t kPieceBytesMax = size_t{1} << 20;

// A serialised StreamAtlasesResponse, to compare with the layout sent before.
std::string layoutMessage(const EncodedAtlas& atlas);
grpc::ByteBuffer skippedMessage(uint64_t count);

// Hands out one message after the other. The bytes of the bands are shared, never copied.
// Thread-safety: none.
class AtlasMessages {
 public:
  explicit AtlasMessages(AtlasPtr atlas) : atlas_(std::move(atlas)) {}

  // Expects !done().
  grpc::ByteBuffer next();
  bool done() const { return part_ == Part::kDone; }

 private:
  grpc::ByteBuffer header() const;
  grpc::ByteBuffer nextPiece();
  grpc::ByteBuffer endMessage() const;

  enum class Part { kHeader, kBands, kEnd, kDone };

  AtlasPtr atlas_;
  Part part_ = Part::kHeader;
  size_t band_ = 0;
  size_t offset_bytes_ = 0;
};

}  // namespace viewloom
