// SPDX-License-Identifier: Apache-2.0
// URLs of pictures. Those of a quilt say how its views lie: ROOT STREAM_qs8x6a0.75 EXTENSION.
// Those of other displays name the display: ROOT STREAM/near_eye_2013 EXTENSION, or give it:
// ROOT STREAM EXTENSION?display=JSON.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "web/url.h"
#include "web/watch_request.h"

namespace viewloom {

// Addresses below one root; the first extension is that of the short form.
struct QuiltAddressForm {
  std::string root;                     // "/still/"
  std::vector<std::string> extensions;  // ".jpg"
};

// Ends the address of a live video.
inline constexpr std::string_view kMovieExtension = ".mp4";

// Ends the address of the layout of a still.
inline constexpr std::string_view kLayoutExtension = ".json";

// The addresses of stills, and of motion JPEG and live videos.
QuiltAddressForm stillForm();
QuiltAddressForm streamForm();

struct QuiltAddress {
  WatchRequest request;
  std::string extension;
  std::string file_name;  // STREAM_qs8x6a0.75 EXTENSION, or STREAM_near_eye_2013 EXTENSION
  // The URL whose suffix, or whose name, says what the display is. Empty: this URL does.
  std::string redirect;
};

// Reads these forms, with the parameters of askedDisplay(). Where no parameter names the display,
// columns, rows and aspect are those of the suffix. A quilt without its suffix, or with another,
// redirects to the URL that has it. Another display is served where it is, and a suffix redirects
// to it. Errors as makeWatchRequest(); NOT_FOUND for a path of another form.
absl::StatusOr<QuiltAddress> parseQuiltAddress(const Url& url, const QuiltAddressForm& form);

}  // namespace viewloom
