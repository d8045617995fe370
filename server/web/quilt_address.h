// SPDX-License-Identifier: Apache-2.0
// URLs that say how the views of a quilt lie: ROOT STREAM_qs8x6a0.75 EXTENSION.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "publish/stream_directory.h"
#include "web/url.h"
#include "web/watch_request.h"

namespace viewloom {

// What is served below one root; the first extension is that of the short form.
struct QuiltAddressForm {
  std::string root;                     // "/still/"
  std::vector<std::string> extensions;  // ".jpg"
};

struct QuiltAddress {
  WatchRequest request;
  std::string extension;
  std::string file_name;  // STREAM_qs8x6a0.75 EXTENSION
  // Where the suffix says what the quilt is. Empty: here.
  std::string redirect;
};

// Reads ROOT STREAM_qs8x6a0.75 EXTENSION with the parameters of parseWatchRequest. Where no
// parameter gives them, columns, rows and aspect are those of the suffix. ROOT STREAM/PRESET, also
// with an extension, and a suffix that does not fit the parameters, redirect to the URL that does.
// Errors as parseWatchRequest; NOT_FOUND for a path of another form.
absl::StatusOr<QuiltAddress> parseQuiltAddress(const Url& url, const QuiltAddressForm& form,
                                               const StreamDirectory& streams);

}  // namespace viewloom
