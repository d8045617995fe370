// SPDX-License-Identifier: Apache-2.0
#include "base/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "base/str_cat.h"

namespace viewloom {
namespace {

std::filesystem::path partialPath(const std::filesystem::path& path) {
  return path.string() + ".part";
}

const char* nameOfKind(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISLNK(mode)) return "a symbolic link";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

absl::Status checkReplaceable(const std::filesystem::path& path) {
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0) {
    if (errno == ENOENT) return absl::OkStatus();
    return absl::InvalidArgumentError(
        strCat(path.string(), ": cannot be written (", std::strerror(errno), ")"));
  }
  if (S_ISREG(status.st_mode)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      strCat(path.string(), ": is ", nameOfKind(status.st_mode),
             ", which is never replaced; name a new file, or a regular file to replace"));
}

}  // namespace

absl::Status checkOutput(const std::filesystem::path& path) {
  if (path.empty() || !path.has_filename()) {
    return absl::InvalidArgumentError(
        strCat("\"", path.string(), "\": is no name of a file; name a file to write"));
  }
  VIEWLOOM_RETURN_IF_ERROR(checkReplaceable(path));
  VIEWLOOM_RETURN_IF_ERROR(checkReplaceable(partialPath(path)));
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  if (access(folder.c_str(), W_OK | X_OK) == 0) return absl::OkStatus();
  return absl::InvalidArgumentError(strCat(path.string(), ": cannot be written (",
                                           std::strerror(errno),
                                           "); its folder must exist and take new files"));
}

OutputFile::OutputFile(std::filesystem::path path, int descriptor)
    : path_(std::move(path)), partial_path_(partialPath(path_)), descriptor_(descriptor) {}

OutputFile::~OutputFile() {
  close(descriptor_);
  if (!is_placed_) unlink(partial_path_.c_str());
}

absl::Status OutputFile::failed(int error) const {
  const std::string reason = error == EFBIG ? "it reached the largest size allowed"
                             : error == ENOSPC || error == EDQUOT ? "the disk is full"
                                                                  : std::strerror(error);
  return absl::FailedPreconditionError(strCat(path_.string(), ": cannot be written: ", reason));
}

absl::StatusOr<std::unique_ptr<OutputFile>> OutputFile::create(std::filesystem::path path,
                                                               mode_t mode) {
  VIEWLOOM_RETURN_IF_ERROR(checkOutput(path));
  const std::filesystem::path partial = partialPath(path);
  unlink(partial.c_str());  // left by a command that was killed
  const int descriptor =
      ::open(partial.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
  if (descriptor < 0) {
    return absl::InvalidArgumentError(strCat(path.string(), ": cannot be written (",
                                             std::strerror(errno),
                                             "); its folder must exist and take new files"));
  }
  return std::unique_ptr<OutputFile>(new OutputFile(std::move(path), descriptor));
}

absl::Status OutputFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return failed(errno);
    size_ += static_cast<uint64_t>(written);
    bytes.remove_prefix(static_cast<size_t>(written));
  }
  return absl::OkStatus();
}

absl::Status OutputFile::cutTo(uint64_t bytes) {
  const bool is_cut = ftruncate(descriptor_, static_cast<off_t>(bytes)) == 0 &&
                      lseek(descriptor_, static_cast<off_t>(bytes), SEEK_SET) >= 0;
  if (!is_cut) return failed(errno);
  size_ = bytes;
  return absl::OkStatus();
}

absl::Status OutputFile::readAt(uint64_t offset, std::span<char> bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = pread(descriptor_, bytes.data(), bytes.size(), off_t(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return failed(count < 0 ? errno : EIO);
    offset += uint64_t(count);
    bytes = bytes.subspan(size_t(count));
  }
  return absl::OkStatus();
}

absl::Status OutputFile::writeAt(uint64_t offset, std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = pwrite(descriptor_, bytes.data(), bytes.size(), off_t(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return failed(errno);
    offset += uint64_t(count);
    bytes.remove_prefix(size_t(count));
  }
  return absl::OkStatus();
}

// All room is taken before anything moves. Blocks then move from the last one on, so that none is
// overwritten before it has moved.
absl::Status OutputFile::insertFront(std::string_view bytes) {
  constexpr uint64_t kBlock_bytes = uint64_t{1} << 20;
  const uint64_t old_size = size_;
  if (bytes.empty()) return absl::OkStatus();
  const int no_room = posix_fallocate(descriptor_, off_t(old_size), off_t(bytes.size()));
  if (no_room != 0) {
    VIEWLOOM_RETURN_IF_ERROR(cutTo(old_size));
    return failed(no_room);
  }
  std::vector<char> block(std::min(kBlock_bytes, old_size));
  for (uint64_t end = old_size; end > 0;) {
    const std::span<char> moved = std::span(block).first(std::min<uint64_t>(block.size(), end));
    end -= moved.size();
    VIEWLOOM_RETURN_IF_ERROR(readAt(end, moved));
    VIEWLOOM_RETURN_IF_ERROR(writeAt(end + bytes.size(), {moved.data(), moved.size()}));
  }
  VIEWLOOM_RETURN_IF_ERROR(writeAt(0, bytes));
  size_ = old_size + bytes.size();
  return lseek(descriptor_, off_t(size_), SEEK_SET) < 0 ? failed(errno) : absl::OkStatus();
}

absl::Status OutputFile::keepOwner() {
  if (geteuid() != 0) return absl::OkStatus();
  const auto folder = path_.has_parent_path() ? path_.parent_path() : std::filesystem::path(".");
  struct stat owner {};
  if (lstat(path_.c_str(), &owner) != 0 && stat(folder.c_str(), &owner) != 0) return failed(errno);
  if (owner.st_uid == 0 || fchown(descriptor_, owner.st_uid, owner.st_gid) == 0) {
    return absl::OkStatus();
  }
  return absl::FailedPreconditionError(strCat(path_.string(), ": cannot be given to its owner (",
                                              std::strerror(errno),
                                              "); write it as the user of viewloomd"));
}

absl::Status OutputFile::replace() {
  VIEWLOOM_RETURN_IF_ERROR(checkReplaceable(path_));
  if (rename(partial_path_.c_str(), path_.c_str()) != 0) return failed(errno);
  is_placed_ = true;
  return absl::OkStatus();
}

absl::StatusOr<bool> OutputFile::placeNew() {
  if (renameat2(AT_FDCWD, partial_path_.c_str(), AT_FDCWD, path_.c_str(), RENAME_NOREPLACE) == 0) {
    is_placed_ = true;
    return true;
  }
  if (errno == EEXIST) return false;
  // Some file systems of the network know no such renaming; a link does not replace either.
  if (errno == EINVAL && link(partial_path_.c_str(), path_.c_str()) == 0) {
    return true;  // and the partial file goes with this object
  }
  if (errno == EEXIST) return false;
  return failed(errno);
}

}  // namespace viewloom
