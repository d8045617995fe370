// SPDX-License-Identifier: Apache-2.0
#include "files/tiff_stream.h"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace viewloom::files {
namespace {

TiffStream& streamOf(thandle_t handle) {
  return *static_cast<TiffStream*>(handle);
}

tmsize_t readBytes(thandle_t handle, void* out, tmsize_t count) {
  TiffStream& stream = streamOf(handle);
  const uint64_t left =
      stream.bytes.size() - std::min<uint64_t>(stream.offset, stream.bytes.size());
  const uint64_t taken = std::min(left, static_cast<uint64_t>(std::max<tmsize_t>(count, 0)));
  if (taken > 0) std::memcpy(out, stream.bytes.data() + stream.offset, taken);
  stream.offset += taken;
  return static_cast<tmsize_t>(taken);
}

tmsize_t refuseWrite(thandle_t, void*, tmsize_t) {
  return 0;
}

toff_t seek(thandle_t handle, toff_t offset, int whence) {
  TiffStream& stream = streamOf(handle);
  const uint64_t base = whence == SEEK_CUR   ? stream.offset
                        : whence == SEEK_END ? stream.bytes.size()
                                             : 0;
  stream.offset = base + offset;
  return stream.offset;
}

int leaveOpen(thandle_t) {
  return 0;
}

toff_t sizeOf(thandle_t handle) {
  return streamOf(handle).bytes.size();
}

int noteError(TIFF*, void* data, const char*, const char* format, va_list arguments) {
  auto& stream = *static_cast<TiffStream*>(data);
  std::array<char, 256> text{};
  std::vsnprintf(text.data(), text.size(), format, arguments);
  if (stream.error.empty()) stream.error = text.data();
  return 1;
}

int ignoreWarning(TIFF*, void*, const char*, const char*, va_list) {
  return 1;  // odd tags change no sample
}

}  // namespace

TiffHandle openTiff(TiffStream& stream, uint64_t allocation_max) {
  const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                             &TIFFOpenOptionsFree);
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), static_cast<tmsize_t>(allocation_max));
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), &noteError, &stream);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), &ignoreWarning, nullptr);
  // m: not mapped; it reads by the calls above.
  return TiffHandle(TIFFClientOpenExt("picture", "rm", &stream, &readBytes, &refuseWrite, &seek,
                                      &leaveOpen, &sizeOf, nullptr, nullptr, options.get()));
}

}  // namespace viewloom::files
