// SPDX-License-Identifier: Apache-2.0
#include "tls/tls_watch.h"

#include <sys/stat.h>

#include <condition_variable>
#include <ctime>
#include <stdexcept>
#include <utility>

#include "admission/request_boundary.h"
#include "base/log.h"
#include "base/thread_name.h"

namespace viewloom {
namespace {

constexpr std::chrono::seconds kLookInterval{2};
// Before the end of a certificate, and between two reminders of it.
constexpr int64_t kRemindBefore_s = 14 * 86400;
constexpr int64_t kRemindAgain_s = 86400;

std::array<int64_t, 4> factsOf(const std::string& path) {
  struct stat facts {};
  if (path.empty() || stat(path.c_str(), &facts) != 0) return {};
  return {static_cast<int64_t>(facts.st_dev), static_cast<int64_t>(facts.st_ino),
          static_cast<int64_t>(facts.st_size),
          int64_t{facts.st_mtim.tv_sec} * 1'000'000'000 + facts.st_mtim.tv_nsec};
}

TlsMaterialPtr orThrow(absl::StatusOr<TlsMaterialPtr> read) {
  if (!read.ok()) throw std::runtime_error(std::string(read.status().message()));
  return *std::move(read);
}

}  // namespace

TlsStore::TlsStore(TlsFiles files, WallClock now_s)
    : files_(std::move(files)), now_s_(std::move(now_s)), judged_(signature()), seen_(judged_) {
  current_ = orThrow(readTlsMaterial(files_, now_s_()));
}

TlsMaterialPtr TlsStore::current() const {
  std::lock_guard lock(mutex_);
  return current_;
}

TlsStore::Signature TlsStore::signature() const {
  return {factsOf(files_.certificate), factsOf(files_.key), factsOf(files_.client_authorities)};
}

absl::StatusOr<TlsStore::Found> TlsStore::look() {
  const Signature now = signature();
  // Whoever replaces two files needs a moment: what changed has to stand until the next look.
  const bool is_settled = now == std::exchange(seen_, now);
  const bool is_told = now == judged_;
  if (!is_settled || (is_told && !is_refused_)) return Found::kNothing;
  judged_ = now;
  is_refused_ = true;
  absl::StatusOr<TlsMaterialPtr> read = readTlsMaterial(files_, now_s_());
  if (!read.ok() && is_told) return Found::kNothing;
  VIEWLOOM_RETURN_IF_ERROR(read.status());
  is_refused_ = false;
  std::lock_guard lock(mutex_);
  current_ = *std::move(read);
  return Found::kTaken;
}

TlsWatch::TlsWatch(TlsFiles files, OnLook on_look)
    : store_(std::move(files), [] { return int64_t{std::time(nullptr)}; }),
      on_look_(std::move(on_look)) {
  tell(TlsStore::Found::kNothing);
  thread_ = std::jthread([this](const std::stop_token& stop) {
    nameThread("tls files");
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    while (!never.wait_for(lock, stop, kLookInterval, [&] { return stop.stop_requested(); })) {
      try {
        tell(store_.look());
      } catch (const std::exception& thrown) {
        noteThrown("a look at the certificate", thrown);  // the next one is soon
      }
    }
  });
}

void TlsWatch::tell(const absl::StatusOr<TlsStore::Found>& found) {
  const TlsMaterialPtr material = current();
  const Certificate& certificate = material->certified_key.certificate;
  const int64_t end_s = certificate.endS();
  on_look_(found, end_s);
  if (!found.ok()) {
    log(LogLevel::kError, "the changed certificate is not used, and the one before stays: ",
        std::string(found.status().message()));
  } else if (*found == TlsStore::Found::kTaken) {
    reminded_s_.reset();
    log(LogLevel::kInfo, "new connections get the changed certificate, SHA-256 fingerprint ",
        certificate.fingerprint().text(), ", valid until ", dayText(end_s));
  }
  const int64_t now_s = std::time(nullptr);
  const bool is_near = end_s - now_s < kRemindBefore_s;
  if (!is_near || (reminded_s_ && now_s - *reminded_s_ < kRemindAgain_s)) return;
  reminded_s_ = now_s;
  log(LogLevel::kWarning, "the certificate of tls.certificate ",
      now_s > end_s ? "expired on " : "expires on ", dayText(end_s),
      "; replace its file, and the server reads it without a restart");
}

}  // namespace viewloom
