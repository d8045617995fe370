// SPDX-License-Identifier: Apache-2.0
// Answers to HTTP requests, apart from how they are written.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/byte_pool.h"
#include "base/status.h"
#include "mp4/movie_coder.h"
#include "web/watch_request.h"

namespace viewloom {

// The body is `text`, or the bytes of `fixed` (of the program itself), or `shared` joined; or,
// where `live` is set, the atlases of that as they come, without end.
struct HttpReply {
  unsigned status = 200;
  std::string type;  // MIME
  std::vector<std::pair<std::string, std::string>> headers;
  std::string text;
  std::string_view fixed;
  std::vector<SharedBytes> shared;
  // With the caller for whom it is.
  struct Live {
    WatchRequest request;
    Caller caller;
    std::optional<MovieCoding> movie{};  // none = motion JPEG
  };
  std::optional<Live> live{};
};

// Bytes of the body, unless the reply is live.
size_t bodyBytes(const HttpReply& reply);

unsigned httpStatusOf(absl::StatusCode code);

// {"error": {"code": "INVALID_ARGUMENT", "field": "columns", "message": "columns: got ..."}}
std::string errorJson(const absl::Status& status);

// Text that is no UTF-8 is replaced: it may come from a client.
HttpReply jsonReply(const nlohmann::json& value);
HttpReply errorReply(const absl::Status& status);
HttpReply errorReply(unsigned http_status, const absl::Status& status);
HttpReply redirectReply(std::string location);

// A value of Content-Disposition (RFC 6266): the name under which a client saves the reply. The
// plain name holds only what every file system takes and no path; where that is not `file_name`,
// the whole name stands beside it in UTF-8 (RFC 5987).
std::string contentDisposition(std::string_view file_name);

}  // namespace viewloom
