// SPDX-License-Identifier: Apache-2.0
#include "web/live_answer.h"

#include <utility>

#include "base/str_cat.h"
#include "web/admission.h"
#include "web/movie_stream.h"
#include "web/multipart_stream.h"
#include "web/quilt_address.h"

namespace viewloom {
namespace {

std::string sizeText(SizePx size_px) {
  return strCat(size_px.width, "x", size_px.height);
}

bool isScaled(const MovieCoding& movie) {
  return movie.video.tile_px != movie.atlas.tile_px;
}

// A scaled video says its true size before the layout: "demo_3072x3072_qs8x6a0.75.mp4".
std::string fileNameOf(const QuiltAddress& address, const MovieCoding& movie) {
  if (!isScaled(movie)) return address.file_name;
  const std::string& stream = address.request.stream;
  return strCat(stream, "_", sizeText(movie.video.picture_px),
                address.file_name.substr(stream.size()));
}

void describeMovie(const QuiltAddress& address, const MovieCoding& movie, HttpReply& reply) {
  reply.type = "video/mp4";
  reply.headers.emplace_back("Content-Disposition", contentDisposition(fileNameOf(address, movie)));
  reply.headers.emplace_back("Viewloom-Picture-Size", sizeText(movie.video.picture_px));
  if (!isScaled(movie)) return;
  const SizePx tile_px = movie.atlas.tile_px;
  reply.headers.emplace_back("Viewloom-Scaled-From", sizeText({movie.atlas.columns * tile_px.width,
                                                               movie.atlas.rows * tile_px.height}));
}

}  // namespace

HttpReply answerStream(const WebContext& context, const HttpRequest& request, const Url& url) {
  absl::StatusOr<AdmittedPicture> picture = admitPicture(context, request, url, streamForm());
  if (!picture.ok()) return errorReply(picture.status());
  QuiltAddress& address = picture->address;
  if (!address.redirect.empty()) return redirectReply(address.redirect);
  HttpReply reply;
  reply.type = kMultipartType;
  reply.headers = {{"Cache-Control", "no-store"}};
  std::optional<MovieCoding> movie;
  if (address.extension == kMovieExtension) {
    const absl::StatusOr<MovieCoding> planned =
        planMovie(address.request, context.options.video_encoders);
    if (!planned.ok()) return errorReply(planned.status());
    movie = *planned;
    describeMovie(address, *movie, reply);
  }
  reply.live.emplace(HttpReply::Live{
      .request = std::move(address.request), .caller = std::move(picture->caller), .movie = movie});
  return reply;
}

std::shared_ptr<LiveStream> makeLiveStream(WebContext& context, const HttpReply::Live& live,
                                           net::any_io_executor strand, std::string identity) {
  if (!live.movie) {
    return std::make_shared<MultipartStream>(context, live.caller, std::move(strand),
                                             std::move(identity));
  }
  return std::make_shared<MovieStream>(context, live.caller, std::move(strand), std::move(identity),
                                       *live.movie);
}

}  // namespace viewloom
