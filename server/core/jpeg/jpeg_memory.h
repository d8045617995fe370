// SPDX-License-Identifier: Apache-2.0
// Memory of a libjpeg object that is kept from one image to the next.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <vector>

#include <jpeglib.h>

namespace viewloom {

// Replaces the image pool of one compressor or decompressor by blocks that are only rewound.
// libjpeg itself allocates a few rows for each image and frees them after it. They take over 64 KiB
// for every band, and for every frame wider than about 3200 px. Thread-safety: that of the libjpeg
// object.
class JpegMemory {
 public:
  // Takes a compress or decompress struct after jpeg_create_...; must live until after
  // jpeg_destroy_... . Uses client_data.
  explicit JpegMemory(j_common_ptr object);
  JpegMemory(const JpegMemory&) = delete;
  JpegMemory& operator=(const JpegMemory&) = delete;

 private:
  struct Block {
    std::unique_ptr<uint8_t[]> bytes;
    size_t size_bytes;
  };

  static JpegMemory& of(j_common_ptr object);
  static void* allocate(j_common_ptr object, int pool, size_t size_bytes);
  static JSAMPARRAY allocateRows(j_common_ptr object, int pool, JDIMENSION samples_per_row,
                                 JDIMENSION row_count);
  static void freePool(j_common_ptr object, int pool);

  void* takeOrFail(j_common_ptr object, size_t size_bytes);
  void* take(size_t size_bytes);  // nullptr = no memory is left
  bool addBlock(size_t block_bytes);

  jpeg_memory_mgr original_;
  std::vector<Block> blocks_;
  size_t block_index_ = 0;  // the block that is being filled
  size_t used_bytes_ = 0;   // of it
};

}  // namespace viewloom
