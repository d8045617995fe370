// SPDX-License-Identifier: Apache-2.0
#include "decode/zstd_plane.h"

#include <new>

#include <zstd.h>

#include "base/str_cat.h"

namespace viewloom {
namespace {

// Size by the header of the one zstd frame that fills `wire`; ZSTD_CONTENTSIZE_UNKNOWN when open.
absl::StatusOr<unsigned long long> declaredBytes(std::span<const uint8_t> wire) {
  const size_t frame_bytes = ZSTD_findFrameCompressedSize(wire.data(), wire.size());
  if (ZSTD_isError(frame_bytes)) {
    return absl::InvalidArgumentError(
        strCat("the bytes are not a whole zstd frame: ", ZSTD_getErrorName(frame_bytes)));
  }
  if (frame_bytes != wire.size()) {
    return absl::InvalidArgumentError(strCat(
        wire.size() - frame_bytes,
        " bytes follow the zstd frame of the plane; accepted is one zstd frame and nothing else"));
  }
  const unsigned long long declared = ZSTD_getFrameContentSize(wire.data(), wire.size());
  if (declared == ZSTD_CONTENTSIZE_ERROR) {
    return absl::InvalidArgumentError("the bytes do not begin with a zstd frame");
  }
  return declared;
}

}  // namespace

ZstdInflater::ZstdInflater() : context_(ZSTD_createDCtx()) {
  if (!context_) throw std::bad_alloc();
}

void ZstdInflater::FreeContext::operator()(ZSTD_DCtx_s* context) const {
  ZSTD_freeDCtx(context);
}

absl::StatusOr<uint64_t> ZstdInflater::contentBytes(std::span<const uint8_t> wire,
                                                    uint64_t expected) {
  const absl::StatusOr<unsigned long long> declared = declaredBytes(wire);
  if (!declared.ok()) return declared.status();
  if (*declared != ZSTD_CONTENTSIZE_UNKNOWN && *declared != expected) {
    return absl::InvalidArgumentError(
        strCat("the zstd frame inflates to ", *declared, " bytes; accepted is ", expected));
  }
  return expected;
}

absl::StatusOr<uint64_t> ZstdInflater::contentBytesUpTo(std::span<const uint8_t> wire,
                                                        uint64_t bytes_max) {
  const absl::StatusOr<unsigned long long> declared = declaredBytes(wire);
  if (!declared.ok()) return declared.status();
  if (*declared == ZSTD_CONTENTSIZE_UNKNOWN) {
    return absl::InvalidArgumentError(
        "the zstd frame does not state the size of its content; accepted for a JPEG is one that "
        "does");
  }
  if (*declared == 0 || *declared > bytes_max) {
    return absl::InvalidArgumentError(
        strCat("the zstd frame inflates to ", *declared, " bytes; accepted is 1..", bytes_max));
  }
  return *declared;
}

absl::Status ZstdInflater::inflate(std::span<const uint8_t> wire, uint64_t content_bytes,
                                   std::vector<uint8_t>& out) {
  out.resize(content_bytes);
  const size_t got =
      ZSTD_decompressDCtx(context_.get(), out.data(), out.size(), wire.data(), wire.size());
  if (ZSTD_isError(got)) {
    return absl::InvalidArgumentError(strCat("the zstd frame does not inflate to ", content_bytes,
                                             " bytes: ", ZSTD_getErrorName(got)));
  }
  if (got != content_bytes) {
    return absl::InvalidArgumentError(
        strCat("the zstd frame inflates to ", got, " bytes; accepted is ", content_bytes));
  }
  return absl::OkStatus();
}

}  // namespace viewloom
