// SPDX-License-Identifier: Apache-2.0
#include "access/token_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include <nlohmann/json.hpp>

#include "access/json_object.h"
#include "access/watched_file.h"
#include "base/nearest_name.h"
#include "base/output_file.h"
#include "base/printable.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr uint64_t kEditedBytesMax = uint64_t{8} << 20;
constexpr mode_t kOwnerOnly = 0600;

// Holds the folder of a file against other commands that change a token file in it.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& file) {
    const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    descriptor_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    is_held_ = descriptor_ >= 0 && flock(descriptor_, LOCK_EX) == 0;
  }
  ~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  absl::Status status(const std::string& path) const {
    if (is_held_) return absl::OkStatus();
    return absl::FailedPreconditionError(strCat(printable(path), ": its folder cannot be opened (",
                                                std::strerror(errno), "); make the folder first"));
  }

 private:
  int descriptor_ = -1;
  bool is_held_ = false;
};

absl::StatusOr<std::string> textOfTokenFile(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0 && errno == ENOENT) return std::string();
  return readSmallFile(path, kEditedBytesMax);
}

absl::Status replaceTokenFile(const std::string& path, std::string_view text) {
  absl::StatusOr<std::unique_ptr<OutputFile>> file = OutputFile::create(path, kOwnerOnly);
  VIEWLOOM_RETURN_IF_ERROR(file.status());
  VIEWLOOM_RETURN_IF_ERROR((*file)->write(text));
  VIEWLOOM_RETURN_IF_ERROR((*file)->keepOwner());
  return (*file)->replace();
}

bool isLineOf(const std::string& line, std::string_view id) {
  const absl::StatusOr<nlohmann::json> object = parseJsonObject(line);
  if (!object.ok()) return false;
  const absl::StatusOr<std::string> text = textField(*object, "id");
  return text.ok() && *text == id;
}

}  // namespace

absl::StatusOr<TokenList> readTokenFile(const std::string& path) {
  const absl::StatusOr<std::string> text = textOfTokenFile(path);
  VIEWLOOM_RETURN_IF_ERROR(text.status());
  return TokenList::parse(*text, path);
}

absl::Status addToTokenFile(const std::string& path, const TokenEntry& entry) {
  const FolderLock lock(path);
  VIEWLOOM_RETURN_IF_ERROR(lock.status(path));
  absl::StatusOr<std::string> text = textOfTokenFile(path);
  VIEWLOOM_RETURN_IF_ERROR(text.status());
  const absl::StatusOr<TokenList> list = TokenList::parse(*text, path);
  VIEWLOOM_RETURN_IF_ERROR(list.status());
  if (list->named(entry.identity->id) != nullptr) {
    return absl::AlreadyExistsError(strCat("there is a token \"", entry.identity->id,
                                           "\" already; choose another name, or revoke it first"));
  }
  if (!text->empty() && !text->ends_with('\n')) *text += '\n';
  return replaceTokenFile(path, strCat(*text, tokenLine(entry), "\n"));
}

absl::Status removeFromTokenFile(const std::string& path, std::string_view id) {
  const FolderLock lock(path);
  VIEWLOOM_RETURN_IF_ERROR(lock.status(path));
  const absl::StatusOr<std::string> text = textOfTokenFile(path);
  VIEWLOOM_RETURN_IF_ERROR(text.status());
  const absl::StatusOr<TokenList> list = TokenList::parse(*text, path);
  VIEWLOOM_RETURN_IF_ERROR(list.status());
  if (list->named(id) == nullptr) {
    std::vector<std::string> ids;
    for (const TokenEntry& entry : list->entries()) ids.push_back(entry.identity->id);
    return absl::NotFoundError(noSuchName("token", printable(id), ids));
  }
  std::string kept;
  for (size_t begin = 0; begin < text->size();) {
    const size_t end = std::min(text->find('\n', begin), text->size() - 1) + 1;
    const std::string line = text->substr(begin, end - begin);
    if (!isLineOf(line, id)) kept += line;
    begin = end;
  }
  return replaceTokenFile(path, kept);
}

}  // namespace viewloom
