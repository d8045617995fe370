// SPDX-License-Identifier: Apache-2.0
#include "access/caller.h"

#include <utility>

#include "access/access_control.h"
#include "base/host_port.h"
#include "base/printable.h"
#include "base/str_cat.h"

namespace viewloom {

AuditEvent Caller::event(AuditOutcome outcome) const {
  return {.outcome = outcome,
          .operation = operation_,
          .peer = peer_,
          .identity = identity_,
          .stream = "",
          .reason = ""};
}

absl::Status Caller::told(const absl::Status& status, const std::string& stream) const {
  if (status.ok()) return status;
  AuditEvent refused = event(AuditOutcome::kRefused);
  refused.stream = stream;
  refused.reason = std::string(status.message());
  access_->audit(refused);
  return status;
}

absl::Status Caller::mayUse(const std::string& stream) const {
  if (sees(stream)) {
    AuditEvent granted = event(AuditOutcome::kGranted);
    granted.stream = stream;
    access_->audit(granted);
    return absl::OkStatus();
  }
  AuditEvent refused = event(AuditOutcome::kRefused);
  refused.stream = stream;
  refused.reason = "no pattern matches the stream";
  access_->audit(refused);
  return fieldError(absl::StatusCode::kPermissionDenied, "stream",
                    strCat("\"", printable(identity_->id), "\" may not use the stream \"",
                           printable(stream), "\"; accepted are the streams of its access token: ",
                           identity_->rights.streams.text()));
}

bool Caller::sees(std::string_view stream) const {
  return identity_->rights.streams.matches(stream);
}

std::string Caller::shareName(std::string_view host) const {
  switch (identity_->proof) {
    case Proof::kNothing:
      break;
    case Proof::kToken:
      return identity_->id;
    case Proof::kJwt:  // its subject is chosen elsewhere, and may be the id of a token
      return strCat(identity_->id, " (JWT)");
  }
  return identityOfHost(host);
}

absl::Status Caller::recheck() const {
  VIEWLOOM_RETURN_IF_ERROR(access_->recheck(*identity_));
  if (link_expires_s_) VIEWLOOM_RETURN_IF_ERROR(access_->checkLinkTime(*link_expires_s_));
  return told(access_->quotas_.endIfOver(*identity_));
}

absl::Status Caller::stay() {
  absl::StatusOr<QuotaPartPtr> held = access_->quotas_.holdConnection(*identity_);
  if (held.ok()) connection_ = *std::move(held);
  return told(held.status());
}

absl::StatusOr<QuotaPartPtr> Caller::holdStream(const std::string& name) const {
  absl::StatusOr<QuotaPartPtr> held = access_->quotas_.holdStream(*identity_, name);
  VIEWLOOM_RETURN_IF_ERROR(told(held.status(), name));
  return held;
}

absl::StatusOr<QuotaPartPtr> Caller::holdDisplay(const DisplayUse& use,
                                                 const QuotaPart* replaced) const {
  absl::StatusOr<QuotaPartPtr> held = access_->quotas_.holdDisplay(*identity_, use, replaced);
  VIEWLOOM_RETURN_IF_ERROR(told(held.status()));
  return held;
}

void Caller::noteBytes(uint64_t bytes) const {
  access_->quotas_.noteBytes(*identity_, bytes);
}

}  // namespace viewloom
