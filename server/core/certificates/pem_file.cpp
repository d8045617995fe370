// SPDX-License-Identifier: Apache-2.0
#include "certificates/pem_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr off_t kPemBytesMax = 1 << 20;

std::string remedyFor(int error) {
  if (error == ENOENT) return "; check the path";
  if (error == EACCES) return "; let the user that runs this program read it";
  return "";
}

// Reads at most `size` bytes; false when the system refuses, with its reason in errno.
bool readAll(int file, size_t size, std::string& bytes) {
  bytes.resize(size);
  size_t got = 0;
  while (got < size) {
    const ssize_t count = read(file, bytes.data() + got, size - got);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    if (count == 0) break;
    got += static_cast<size_t>(count);
  }
  bytes.resize(got);
  return true;
}

}  // namespace

absl::Status NamedFile::error(const std::string& problem) const {
  return absl::InvalidArgumentError(strCat(option, " ", path, ": ", problem));
}

absl::StatusOr<std::string> readPemFile(const NamedFile& file) {
  const auto refused = [&file](int error) {
    return file.error(strCat("cannot be read: ", std::strerror(error), remedyFor(error)));
  };
  // A named pipe without a writer would hold up the start.
  const int descriptor = open(file.path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return refused(errno);
  struct stat facts {};
  std::string bytes;
  absl::Status status = absl::OkStatus();
  if (fstat(descriptor, &facts) != 0) {
    status = refused(errno);
  } else if (!S_ISREG(facts.st_mode)) {
    status = file.error("is no regular file; accepted is a file in PEM");
  } else if (facts.st_size > kPemBytesMax) {
    status = file.error(
        strCat("has ", facts.st_size, " bytes; accepted are up to ", kPemBytesMax, " bytes"));
  } else if (!readAll(descriptor, static_cast<size_t>(facts.st_size), bytes)) {
    status = refused(errno);
  }
  close(descriptor);
  if (!status.ok()) return status;
  return bytes;
}

bool holdsPrivateKey(const std::string& pem) {
  return pem.find("PRIVATE KEY-----") != std::string::npos;
}

}  // namespace viewloom
