// SPDX-License-Identifier: Apache-2.0
// The picture that a viewer asks for, by the display and the encoding of its messages.
#pragma once

#include <string>

#include "display/atlas_layout.h"
#include "display/display_spec.h"
#include "messages/accepted_encoding.h"
#include "viewloom/v1/display_service.pb.h"

namespace viewloom {

// Errors name the field: "display.quilt.columns". Thread-safety: none.
class AskedPicture {
 public:
  absl::Status open(const v1::OpenDisplay& request, const AtlasLimits& limits);
  // Leaves what the request does not name as it was.
  absl::Status change(const v1::ChangeDisplay& request, const AtlasLimits& limits);

  // From now on no atlas needs another, until a change says otherwise. Errors as of change().
  absl::Status predictWithinAtlas();

  const DisplaySpec& display() const { return display_; }
  const EncodingSpec& encoding() const { return encoding_; }

 private:
  absl::Status setDisplay(const v1::Display& proto, const AtlasLimits& limits);
  absl::Status settleEncoding();

  DisplaySpec display_;
  v1::AtlasEncoding encoding_proto_;  // as it was asked for
  AcceptedEncodings accepted_;
  EncodingSpec encoding_;
};

}  // namespace viewloom
