// SPDX-License-Identifier: Apache-2.0
#include "cli/encoding_options.h"

#include "messages/message_from_json.h"

namespace viewloom::cli {
namespace {

constexpr uint64_t kEncodingBytesMax = uint64_t{64} << 10;
constexpr uint64_t kMbit = 1'000'000;
constexpr const char* kEncodingGroup = "Encoding";

}  // namespace

void addEncodingOptions(const usage::Command& app, EncodingOptions& options) {
  const usage::Option json = app.add("--encoding", options.json,
                                     "Encoding of atlases: AtlasEncoding of the protocol, as JSON")
                                 .valueName("JSON")
                                 .group(kEncodingGroup);
  app.add("--quality", options.jpeg_quality, "JPEG quality, 1 to 100; --h264 takes an equal one")
      .between(1, 100)
      .showDefault()
      .excludes(json)
      .group(kEncodingGroup);
  const usage::Option full =
      app.addFlag("--444", options.is_444, "Keep the full resolution of colour in JPEG")
          .excludes(json)
          .group(kEncodingGroup);
  const usage::Option lossless = app.addFlag("--lossless", options.is_lossless,
                                             "Send colour without loss (zstd) instead of JPEG")
                                     .excludes(json)
                                     .group(kEncodingGroup);
  const usage::Option h264 =
      app.addFlag("--h264", options.is_h264,
                  "Send colour as video instead of JPEG: a quarter of the bytes, more CPU time")
          .excludes(json)
          .excludes(full)
          .excludes(lossless)
          .group(kEncodingGroup);
  app.addFlag("--chained", options.is_chained, "Let atlases of video refer to the one before")
      .needs(h264)
      .group(kEncodingGroup);
  app.add("--mbit-max", options.mbit_max,
          "Most Mbit/s of video, 1 to 10000; without it, as many as the line takes")
      .valueName("N")
      .between(1U, 10000U)
      .needs(h264)
      .group(kEncodingGroup);
}

void addMaskOption(const usage::Command& app, EncodingOptions& options) {
  app.addFlag("--mask", options.has_mask,
              "Receive the class of each pixel too: 1 or 2 hit, 3 hidden, 4 outside, 5 empty")
      .group(kEncodingGroup);
}

absl::StatusOr<v1::AtlasEncoding> makeEncoding(const EncodingOptions& options) {
  v1::AtlasEncoding encoding;
  if (!options.json.empty()) {
    VIEWLOOM_RETURN_IF_ERROR(
        withFieldPrefix(messageFromJson(options.json, kEncodingBytesMax, encoding), "--encoding"));
    if (options.has_mask) encoding.set_with_mask(true);
    return encoding;
  }
  // The server chooses values left open, by the display.
  if (options.is_lossless) encoding.set_color(v1::BAND_ENCODING_ZSTD);
  if (options.is_444) encoding.set_color(v1::BAND_ENCODING_JPEG);
  if (options.is_h264) encoding.set_color(v1::BAND_ENCODING_H264);
  encoding.set_jpeg_quality(options.jpeg_quality);
  if (options.is_chained) encoding.set_prediction(v1::PREDICTION_ACROSS_ATLASES);
  encoding.set_bits_per_second_max(uint64_t{options.mbit_max} * kMbit);
  if (options.is_444) encoding.set_chroma(v1::CHROMA_SUBSAMPLING_444);
  encoding.set_with_mask(options.has_mask);
  return encoding;
}

}  // namespace viewloom::cli
