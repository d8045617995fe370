// SPDX-License-Identifier: Apache-2.0
#include "access/audit_window.h"

#include <utility>

#include "base/host_port.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

// For all clients that come when there are too many lines.
constexpr const char* kOthers = "others";

std::string proofOf(const AuditEvent& event) {
  if (!event.identity || event.identity->proof == Proof::kNothing) return "";
  return strCat(event.identity->proof == Proof::kJwt ? "jwt " : "token ", event.identity->id);
}

// Those who prove nothing are one client for each address, as a client has a whole IPv6 network.
std::string clientOf(const AuditEvent& event) {
  const std::string proof = proofOf(event);
  return proof.empty() ? identityOfHost(event.peer) : proof;
}

void count(AuditWindow::Counted& counted, int64_t now_s) {
  ++counted.event.count;
  counted.last_s = now_s;
}

}  // namespace

bool AuditWindow::isOver(int64_t now_s) const {
  const bool is_empty = written_.empty() && left_out_.empty();
  return !is_empty && (now_s < begin_s_ || now_s >= begin_s_ + kSeconds);
}

bool AuditWindow::isNew(const AuditEvent& event, int64_t now_s) {
  if (written_.empty() && left_out_.empty()) begin_s_ = now_s;
  const Key key(event.outcome, std::string(event.operation), event.peer, proofOf(event),
                event.stream, event.reason);
  if (const auto found = written_.find(key); found != written_.end()) {
    count(found->second, now_s);
    return false;
  }
  const bool is_full = written_.size() >= kLinesMax;
  const std::string client = is_full ? kOthers : clientOf(event);
  if (!is_full && line_count_[client] < kClientLinesMax) {
    ++line_count_[client];
    written_.emplace(key, Counted{.event = event, .last_s = now_s});
    return true;
  }
  const Key client_key(event.outcome, client, "", "", "", "");
  auto found = left_out_.find(client_key);
  if (found == left_out_.end()) {
    found = left_out_.emplace(client_key, Counted{.event = remainderOf(event, client)}).first;
  }
  count(found->second, now_s);
  return false;
}

AuditEvent AuditWindow::remainderOf(const AuditEvent& event, const std::string& client) const {
  const bool is_one = client != kOthers;
  return {.outcome = event.outcome,
          .operation = "audit",
          .peer = is_one ? event.peer : "",
          .identity = is_one ? event.identity : nullptr,
          .stream = "",
          .reason = strCat("more lines than the log takes of ", is_one ? "one client" : "all",
                           " in ", kSeconds, " s")};
}

std::vector<AuditWindow::Counted> AuditWindow::close() {
  std::vector<Counted> counted;
  for (auto* const events : {&written_, &left_out_}) {
    for (auto& [key, entry] : *events) {
      if (entry.event.count > 0) counted.push_back(std::move(entry));
    }
    events->clear();
  }
  line_count_.clear();
  return counted;
}

}  // namespace viewloom
