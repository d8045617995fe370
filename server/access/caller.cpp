// SPDX-License-Identifier: Apache-2.0
#include "access/caller.h"

#include "access/access_control.h"
#include "base/host_port.h"
#include "base/printable.h"
#include "base/str_cat.h"

namespace viewloom {

absl::Status Caller::mayUse(const std::string& stream) const {
  AuditEvent event{.outcome = AuditOutcome::kGranted,
                   .operation = operation_,
                   .peer = peer_,
                   .identity = identity_,
                   .stream = stream,
                   .reason = ""};
  if (sees(stream)) {
    access_->audit(event);
    return absl::OkStatus();
  }
  absl::Status refusal = fieldError(
      absl::StatusCode::kPermissionDenied, "stream",
      strCat(
          "\"", printable(identity_->id), "\" may not use the stream \"", printable(stream),
          "\"; accepted are the streams of its access token: ", identity_->rights.streams.text()));
  event.outcome = AuditOutcome::kRefused;
  event.reason = "no pattern matches the stream";
  access_->audit(event);
  return refusal;
}

bool Caller::sees(std::string_view stream) const {
  return identity_->rights.streams.matches(stream);
}

std::string Caller::shareName(std::string_view host) const {
  return identity_->proof == Proof::kNothing ? identityOfHost(host) : identity_->id;
}

absl::Status Caller::recheck() const {
  return access_->recheck(*identity_);
}

}  // namespace viewloom
