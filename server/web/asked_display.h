// SPDX-License-Identifier: Apache-2.0
// Requests of web clients in the words of the protocol: messages as JSON.
#pragma once

#include <string>

#include "base/status.h"
#include "messages/accepted_encoding.h"
#include "viewloom/v1/display_service.pb.h"
#include "web/url.h"

namespace viewloom {

// Parts of it stay when a client changes the others.
struct AskedDisplay {
  std::string stream;
  v1::Display display;
  v1::AtlasEncoding encoding;
  AcceptedEncodings accepted;  // as in proto OpenDisplay
};

// Parameters of a URL:
//   stream                    its name
//   display, encoding         messages of these names as JSON (proto Display, AtlasEncoding)
//   accepted                  a list of proto AcceptedEncoding as JSON
//   preset, width, height     for hands, instead of `display`: a named device ("portrait" where
//                             nothing says otherwise), and the size of what is sent
// INVALID_ARGUMENT with the parameter, or the field inside the message, as the field
// ("display.quilt.columns"); NOT_FOUND for an unknown preset.
absl::StatusOr<AskedDisplay> askedDisplay(const QueryParameters& parameters);

// Refusals of what came by hand name its parameter, and not the field that it stands for.
absl::Status inParameters(const absl::Status& status, const QueryParameters& parameters);

}  // namespace viewloom
