// SPDX-License-Identifier: Apache-2.0
#include "web/watch_request.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/nearest_name.h"
#include "base/str_cat.h"
#include "display/atlas_layout.h"
#include "display/tracked_eyes.h"
#include "messages/accepted_encoding.h"
#include "messages/display_from_proto.h"
#include "web/asked_display.h"

namespace viewloom {
namespace {

constexpr const char* kElsewhere = "; use `viewloom watch` or a gRPC client for the others";

// Browsers, players and files hold a single image.
absl::Status checkDisplay(const DisplaySpec& display) {
  const TileGrid grid = tileGridOf(display);
  if (grid.image_count == 1) return absl::OkStatus();
  return invalidField(strCat("display.", grid.size_field),
                      strCat("the display has ", grid.image_count,
                             " images; accepted here is a display of one image", kElsewhere));
}

bool isOnWeb(v1::BandEncoding color) {
  return color == v1::BAND_ENCODING_JPEG || color == v1::BAND_ENCODING_H264;
}

// Those that the web has.
absl::StatusOr<AcceptedEncodings> acceptedOnWeb(const AcceptedEncodings& accepted) {
  AcceptedEncodings kept;
  for (v1::AcceptedEncoding one : accepted) {
    // The usual choice.
    if (one.color() == v1::BAND_ENCODING_UNSPECIFIED) one.set_color(v1::BAND_ENCODING_JPEG);
    if (isOnWeb(one.color())) *kept.Add() = std::move(one);
  }
  if (!kept.empty() || accepted.empty()) return kept;
  return invalidField("accepted",
                      strCat("the web serves color as JPEG or H.264; list BAND_ENCODING_JPEG or "
                             "BAND_ENCODING_H264",
                             kElsewhere));
}

// Browsers read neither zstd nor planes of 16 bits. JPEG where nothing else is accepted, so that
// errors name the field of the encoding.
absl::StatusOr<v1::AtlasEncoding> forWeb(const v1::AtlasEncoding& asked,
                                         const AcceptedEncodings& accepted) {
  v1::AtlasEncoding encoding = asked;
  const bool is_jpeg_only = std::ranges::all_of(accepted, [](const v1::AcceptedEncoding& one) {
    return one.color() == v1::BAND_ENCODING_JPEG;
  });
  if (encoding.color() == v1::BAND_ENCODING_UNSPECIFIED && is_jpeg_only) {
    encoding.set_color(v1::BAND_ENCODING_JPEG);
  }
  if (encoding.color() != v1::BAND_ENCODING_UNSPECIFIED && !isOnWeb(encoding.color())) {
    return invalidField("encoding.color",
                        strCat("the web serves color as JPEG or H.264; accepted here is "
                               "BAND_ENCODING_JPEG or BAND_ENCODING_H264",
                               kElsewhere));
  }
  if (encoding.with_mask()) {
    return invalidField("encoding.with_mask",
                        strCat("the web serves no masks; accepted here is false", kElsewhere));
  }
  if (!encoding.with_depth()) return encoding;
  if (encoding.planes() == v1::BAND_ENCODING_UNSPECIFIED) {
    encoding.set_planes(v1::BAND_ENCODING_RAW);
  }
  if (encoding.planes() == v1::BAND_ENCODING_RAW ||
      encoding.planes() == v1::BAND_ENCODING_COMPACT_DEPTH) {
    return encoding;
  }
  return invalidField(
      "encoding.planes",
      strCat("the web serves depth raw or compact; accepted here is BAND_ENCODING_RAW or "
             "BAND_ENCODING_COMPACT_DEPTH",
             kElsewhere));
}

}  // namespace

absl::StatusOr<WatchRequest> makeWatchRequest(const AskedDisplay& asked) {
  absl::StatusOr<DisplaySpec> display = displayFromProto(asked.display);
  VIEWLOOM_RETURN_IF_ERROR(withFieldPrefix(display.status(), "display"));
  VIEWLOOM_RETURN_IF_ERROR(checkDisplay(*display));
  const absl::StatusOr<AcceptedEncodings> accepted = acceptedOnWeb(asked.accepted);
  VIEWLOOM_RETURN_IF_ERROR(accepted.status());
  const absl::StatusOr<v1::AtlasEncoding> for_web = forWeb(asked.encoding, *accepted);
  VIEWLOOM_RETURN_IF_ERROR(for_web.status());
  const absl::StatusOr<EncodingSpec> encoding = chooseEncoding(*for_web, *accepted, *display);
  VIEWLOOM_RETURN_IF_ERROR(encoding.status());
  if (encoding->with_depth_codes) {
    return invalidField("display.rgbd.depth_bits",
                        strCat("the web serves no 16-bit depth; accepted here is 8", kElsewhere));
  }
  if (asked.stream.empty()) {
    return invalidField("stream",
                        "the name of the stream is missing; list the streams with /api/streams");
  }
  return WatchRequest{asked.stream, *std::move(display), *encoding};
}

absl::StatusOr<WatchRequest> makeWatchRequest(const QueryParameters& parameters) {
  const absl::StatusOr<AskedDisplay> asked = askedDisplay(parameters);
  VIEWLOOM_RETURN_IF_ERROR(asked.status());
  absl::StatusOr<WatchRequest> request = makeWatchRequest(*asked);
  VIEWLOOM_RETURN_IF_ERROR(inParameters(request.status(), parameters));
  return request;
}

absl::Status checkUntracked(const DisplaySpec& display) {
  if (!isTracked(display)) return absl::OkStatus();
  return invalidField("display.stereo.tracked",
                      "pictures and streams over HTTP take no eye poses; accepted here is false; "
                      "use the WebSocket /ws, `viewloom watch` or a gRPC client");
}

absl::Status checkStream(const std::string& name, const Caller& caller,
                         const StreamDirectory& streams) {
  if (streams.exists(name)) return absl::OkStatus();
  std::vector<std::string> names;
  for (const StreamEntry& entry : streams.list()) {
    if (caller.sees(entry.name)) names.push_back(entry.name);
  }
  return fieldError(
      absl::StatusCode::kNotFound, "stream",
      strCat(noSuchName("stream", name, names),
             names.empty() ? "; start a publisher first, for example `viewloom publish --synthetic`"
                           : ""));
}

absl::StatusOr<std::string> quiltSuffix(const DisplaySpec& display) {
  if (!std::holds_alternative<QuiltSpec>(display.kind)) return std::string();
  // The suffix does not depend on the stream: any camera serves.
  const StreamDefaults any_stream{.source_intrinsics = {}, .source_size_px = {1, 1}};
  absl::StatusOr<AtlasLayout> layout = makeAtlasLayout(display, any_stream);
  VIEWLOOM_RETURN_IF_ERROR(layout.status());
  return layout->suffix;
}

}  // namespace viewloom
