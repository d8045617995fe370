// SPDX-License-Identifier: Apache-2.0
#include "cli/folder_watch.h"

#include <fcntl.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/str_cat.h"

namespace viewloom::cli {
namespace {

using FileClock = std::filesystem::file_time_type::clock;

constexpr uint32_t kEvents = IN_CLOSE_WRITE | IN_MOVED_TO | IN_DELETE_SELF | IN_MOVE_SELF;
// Clocks of file systems tick coarsely.
constexpr std::chrono::seconds kClockSlack{1};

}  // namespace

bool isBeingWritten(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return false;
  // A read lease is refused while anybody writes; closing gives it back. Where there are no leases,
  // and on files of others, nothing is known.
  const bool is_refused = fcntl(descriptor, F_SETLEASE, F_RDLCK) != 0 && errno == EAGAIN;
  ::close(descriptor);
  return is_refused;
}

absl::StatusOr<std::unique_ptr<FolderWatch>> FolderWatch::open(
    const std::filesystem::path& folder) {
  const int inotify = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  const bool is_watched =
      inotify >= 0 && inotify_add_watch(inotify, folder.c_str(), kEvents | IN_ONLYDIR) >= 0;
  if (!is_watched) {
    const std::string reason = std::strerror(errno);
    if (inotify >= 0) ::close(inotify);
    return absl::InvalidArgumentError(strCat("--watch-folder ", folder.string(),
                                             " cannot be watched (", reason,
                                             "). Accepted is a readable folder on this machine"));
  }
  return std::unique_ptr<FolderWatch>(new FolderWatch(folder, inotify));
}

FolderWatch::FolderWatch(std::filesystem::path folder, int inotify)
    : folder_(std::move(folder)), inotify_(inotify), read_at_(FileClock::now()) {
  addPresent(std::filesystem::file_time_type::min());
}

FolderWatch::~FolderWatch() {
  ::close(inotify_);
}

void FolderWatch::addPresent(std::filesystem::file_time_type since) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
    std::error_code of_entry;
    if (!entry.is_regular_file(of_entry) || entry.last_write_time(of_entry) < since) continue;
    if (!isBeingWritten(entry.path())) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  completed_.insert(completed_.end(), names.begin(), names.end());
}

absl::StatusOr<std::vector<std::string>> FolderWatch::takeCompleted() {
  const auto now = FileClock::now();
  alignas(inotify_event) std::array<char, 65536> bytes;
  for (ssize_t size = ::read(inotify_, bytes.data(), bytes.size()); size > 0;
       size = ::read(inotify_, bytes.data(), bytes.size())) {
    for (ssize_t at = 0; at < size;) {
      const auto* const event = reinterpret_cast<const inotify_event*>(bytes.data() + at);
      at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
      // Events were lost: what was written since they were read last may be complete.
      if ((event->mask & IN_Q_OVERFLOW) != 0) addPresent(read_at_ - kClockSlack);
      if ((event->mask & (IN_DELETE_SELF | IN_MOVE_SELF | IN_IGNORED)) != 0) is_gone_ = true;
      const bool is_file = (event->mask & (IN_CLOSE_WRITE | IN_MOVED_TO)) != 0 &&
                           (event->mask & IN_ISDIR) == 0 && event->len > 0;
      if (is_file) completed_.emplace_back(event->name);
    }
  }
  read_at_ = now;
  if (is_gone_ && completed_.empty()) {
    return absl::NotFoundError(
        strCat("--watch-folder ", folder_.string(),
               " was moved or deleted. Start again with an existing folder"));
  }
  return std::exchange(completed_, {});
}

}  // namespace viewloom::cli
