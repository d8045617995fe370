// SPDX-License-Identifier: Apache-2.0
#include "access/audit_log.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/log.h"
#include "base/printable.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

// Foreign text, such as the name of a stream that is not there, may be long.
constexpr size_t kReasonBytesMax = 512;

const char* wordOf(AuditOutcome outcome) {
  switch (outcome) {
    case AuditOutcome::kGranted:
      return "granted";
    case AuditOutcome::kRefused:
      return "refused";
    case AuditOutcome::kChanged:
      return "changed";
  }
  return "";
}

const char* wordOf(Proof proof) {
  switch (proof) {
    case Proof::kNothing:
      return "nothing";
    case Proof::kToken:
      return "token";
    case Proof::kJwt:
      return "jwt";
  }
  return "";
}

std::string auditLine(const AuditEvent& event, int64_t now_s) {
  nlohmann::ordered_json object;
  object["time"] = utcText(now_s);
  object["outcome"] = wordOf(event.outcome);
  object["operation"] = std::string(event.operation);
  if (!event.peer.empty()) object["peer"] = event.peer;
  if (event.identity) {
    object["proof"] = wordOf(event.identity->proof);
    object["id"] = event.identity->id;
  }
  if (!event.stream.empty()) object["stream"] = event.stream;
  if (!event.reason.empty()) object["reason"] = event.reason;
  if (event.count > 0) object["count"] = event.count;
  // Foreign text may be no UTF-8.
  return object.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace

AuditLog::AuditLog(std::string path, WallClock now_s)
    : path_(std::move(path)), now_s_(std::move(now_s)) {
  if (path_.empty()) return;
  open();
  if (descriptor_ >= 0) return;
  throw std::runtime_error(strCat("access.audit_file \"", printable(path_),
                                  "\" cannot be written (", std::strerror(errno),
                                  "); name a file in a folder that exists"));
}

AuditLog::~AuditLog() {
  if (!path_.empty()) tellCounted();
  if (descriptor_ >= 0) ::close(descriptor_);
}

void AuditLog::open() {
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600);
}

void AuditLog::reopenIfMoved() {
  struct stat named {};
  struct stat opened {};
  const bool is_same = descriptor_ >= 0 && stat(path_.c_str(), &named) == 0 &&
                       fstat(descriptor_, &opened) == 0 && named.st_ino == opened.st_ino &&
                       named.st_dev == opened.st_dev;
  if (is_same) return;
  if (descriptor_ >= 0) ::close(descriptor_);
  open();
}

void AuditLog::append(const std::string& line) {
  reopenIfMoved();
  const bool is_written = descriptor_ >= 0 && ::write(descriptor_, line.data(), line.size()) ==
                                                  static_cast<ssize_t>(line.size());
  if (!is_written && !has_failed_) {
    log(LogLevel::kError, "access.audit_file ", printable(path_),
        " cannot be written: ", std::strerror(errno), "; lines are missing from now on");
  }
  if (is_written && has_failed_) {
    log(LogLevel::kInfo, "access.audit_file ", printable(path_), " can be written again");
  }
  has_failed_ = !is_written;
}

void AuditLog::tellCounted() {
  for (const AuditWindow::Counted& counted : window_.close()) {
    append(auditLine(counted.event, counted.last_s));
  }
}

void AuditLog::write(const AuditEvent& event) {
  if (path_.empty()) return;
  const int64_t now_s = now_s_();
  AuditEvent shown = event;
  shown.stream = wholeCharacters(event.stream, kQuotationBytesMax);
  shown.reason = wholeCharacters(event.reason, kReasonBytesMax);
  std::lock_guard lock(mutex_);
  if (window_.isOver(now_s)) tellCounted();
  // The operator alone changes something.
  const bool is_told = shown.outcome == AuditOutcome::kChanged || window_.isNew(shown, now_s);
  if (is_told) append(auditLine(shown, now_s));
}

}  // namespace viewloom
