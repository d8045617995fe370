// SPDX-License-Identifier: Apache-2.0
// Colour of one atlas on its way into video.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "base/byte_pool.h"
#include "display/video_stack.h"
#include "encode/picture_planes.h"
#include "encode/video_chain.h"
#include "encode/video_encoders.h"

namespace viewloom {

struct CodedPicture {
  uint32_t place = 0;          // in the order of coding
  SharedBytes bytes;           // an access unit
  bool is_next_ready = false;  // codeNext() has to be called again
  // Time of other threads that coded it, too: as if each of them was busy all the while.
  int64_t help_ns = 0;
};

// Quantisation and references of an atlas.
struct VideoStart {
  uint32_t qp = 24;
  // The encoder that coded the atlas before, and will code the next; nullptr = it is coded alone.
  std::shared_ptr<VideoChain> chain = nullptr;
  bool is_self_contained = true;  // of a chain: the first picture needs no other
};

// Pictures count in the order of coding. Strips come in any order and from any thread. Pictures are
// coded one after the other, each once all its rows are there and the one before it is coded.
// Thread-safety: put() from any thread; codeNext() from one thread at a time, as its users are
// told.
class VideoAtlas {
 public:
  VideoAtlas(const VideoStack& stack, uint32_t qp);

  // To be called before the first rows are put.
  void begin(VideoStart start) { start_ = std::move(start); }
  uint32_t pictureCount() const { return uint32_t(pictures_.size()); }
  // Rows of a picture, each once. True: codeNext() has to be called, by whoever is told.
  bool put(uint32_t place, const BandPixels& rows, BytePool& pool);
  // Codes the next picture. After an error the atlas cannot go on.
  absl::StatusOr<CodedPicture> codeNext(VideoEncoders& encoders, BytePool& bytes);
  // Time that coding has taken so far, of all threads together. For whoever knows that no picture
  // is being coded.
  int64_t codingNs() const { return coding_ns_; }

 private:
  struct Picture {
    std::shared_ptr<PicturePlanes> planes;  // nullptr before its first rows, and once it is coded
    uint32_t rows_left = 0;
  };

  std::shared_ptr<PicturePlanes> planesOf(uint32_t place, BytePool& pool);
  // With the lock.
  bool isNextReady() const;
  // The slot of the encoder.
  std::unique_ptr<VideoEncoder>& slot() { return start_.chain ? start_.chain->encoder : encoder_; }
  // Fills the slot if need be, and sets the quantisation. The reference of the picture.
  absl::StatusOr<Reference> prepare(std::unique_ptr<VideoEncoder>& encoder, uint32_t place,
                                    VideoEncoders& encoders);

  const SizePx picture_px_;
  VideoStart start_;
  // From the first picture to the last; whose turn it is. Not of a chain.
  std::unique_ptr<VideoEncoder> encoder_;
  std::vector<uint8_t> access_unit_;  // whose turn it is; so is the next
  int64_t coding_ns_ = 0;
  std::mutex mutex_;
  std::vector<Picture> pictures_;
  uint32_t next_ = 0;  // picture to be coded
  bool is_coding_ = false;
};

}  // namespace viewloom
