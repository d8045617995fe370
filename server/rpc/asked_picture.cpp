// SPDX-License-Identifier: Apache-2.0
#include "rpc/asked_picture.h"

#include <utility>

#include "messages/display_from_proto.h"

namespace viewloom {

absl::Status AskedPicture::open(const v1::OpenDisplay& request, const AtlasLimits& limits) {
  VIEWLOOM_RETURN_IF_ERROR(setDisplay(request.display(), limits));
  encoding_proto_ = request.encoding();
  accepted_ = request.accepted();
  return settleEncoding();
}

absl::Status AskedPicture::change(const v1::ChangeDisplay& request, const AtlasLimits& limits) {
  if (request.has_display()) {
    VIEWLOOM_RETURN_IF_ERROR(setDisplay(request.display(), limits));
  }
  if (request.has_encoding()) encoding_proto_ = request.encoding();
  return settleEncoding();
}

absl::Status AskedPicture::predictWithinAtlas() {
  encoding_proto_.set_prediction(v1::PREDICTION_WITHIN_ATLAS);
  return settleEncoding();
}

absl::Status AskedPicture::setDisplay(const v1::Display& proto, const AtlasLimits& limits) {
  absl::StatusOr<DisplaySpec> spec = displayFromProto(proto);
  absl::Status status = spec.status();
  if (status.ok()) status = validateAtlasLimits(*spec, limits);
  if (status.ok()) display_ = *std::move(spec);
  return withFieldPrefix(status, "display");
}

// The display decides values that are left open.
absl::Status AskedPicture::settleEncoding() {
  const absl::StatusOr<EncodingSpec> encoding =
      chooseEncoding(encoding_proto_, accepted_, display_);
  if (encoding.ok()) encoding_ = *encoding;
  return encoding.status();
}

}  // namespace viewloom
