// SPDX-License-Identifier: Apache-2.0
#include "access/watched_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/printable.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr int64_t kNsPerSecond = 1'000'000'000;

int64_t nsOf(const timespec& time) {
  return int64_t{time.tv_sec} * kNsPerSecond + time.tv_nsec;
}

absl::Status unreadable(const std::string& path, std::string_view problem) {
  return absl::FailedPreconditionError(strCat(printable(path), ": ", problem));
}

// A descriptor that is closed with its scope.
class OpenFile {
 public:
  explicit OpenFile(const std::string& path)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int descriptor() const { return descriptor_; }

 private:
  const int descriptor_;
};

}  // namespace

absl::StatusOr<std::string> readSmallFile(const std::string& path, uint64_t bytes_max) {
  const OpenFile file(path);
  struct stat status {};
  if (file.descriptor() < 0 || fstat(file.descriptor(), &status) != 0) {
    return unreadable(path, strCat("cannot be read (", std::strerror(errno),
                                   "); name a file that this user may read"));
  }
  if (!S_ISREG(status.st_mode)) return unreadable(path, "is no regular file; name one");
  std::string text;
  std::array<char, 65536> part{};
  for (;;) {
    const ssize_t got = ::read(file.descriptor(), part.data(), part.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return unreadable(path, strCat("cannot be read (", std::strerror(errno), ")"));
    if (got == 0) return text;
    text.append(part.data(), static_cast<size_t>(got));
    if (text.size() > bytes_max) {
      return unreadable(path, strCat("is too long; accepted are up to ", bytes_max, " bytes"));
    }
  }
}

WatchedFile::WatchedFile(std::string path, uint64_t bytes_max)
    : path_(std::move(path)), bytes_max_(bytes_max) {}

WatchedFile::Mark WatchedFile::markNow() const {
  struct stat status {};
  if (stat(path_.c_str(), &status) != 0) return {};
  return {.device = status.st_dev,
          .number = status.st_ino,
          .size = status.st_size,
          .modified_ns = nsOf(status.st_mtim),
          .changed_ns = nsOf(status.st_ctim)};
}

absl::StatusOr<std::optional<std::string>> WatchedFile::readIfChanged() {
  // Before the text: a change after it is then seen at the next call.
  const Mark mark = markNow();
  const bool is_told = seen_ == mark;
  if (is_told && !is_unread_) return std::nullopt;
  seen_ = mark;
  is_unread_ = true;
  absl::StatusOr<std::string> text = readSmallFile(path_, bytes_max_);
  if (!text.ok() && is_told) return std::nullopt;
  if (!text.ok()) return text.status();
  is_unread_ = false;
  return *std::move(text);
}

}  // namespace viewloom
