// SPDX-License-Identifier: Apache-2.0
#include "containment/landlock.h"

#include <fcntl.h>
#include <linux/landlock.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/str_cat.h"

namespace viewloom {
namespace {

// Debian 12's header describes version 2. Later versions add rights and lengthen the structure,
// and kernels take the length that they are told.
struct RulesetAttributes {
  uint64_t handled_access_fs = 0;
  uint64_t handled_access_net = 0;  // from version 4
  uint64_t scoped = 0;              // from version 6
};
struct PortAttributes {
  uint64_t allowed_access = 0;
  uint64_t port = 0;
};
constexpr int kRulePort = 2;
constexpr uint64_t kTruncate = 1U << 14;       // from version 3
constexpr uint64_t kControlDevice = 1U << 15;  // from version 5
constexpr uint64_t kBindTcp = 1U << 0;
constexpr uint64_t kConnectTcp = 1U << 1;
constexpr uint64_t kAbstractSockets = 1U << 0;
constexpr uint64_t kSignals = 1U << 1;

constexpr uint64_t kReadFile = LANDLOCK_ACCESS_FS_READ_FILE;
constexpr uint64_t kReadFolder = LANDLOCK_ACCESS_FS_READ_DIR;
constexpr uint64_t kChange = LANDLOCK_ACCESS_FS_WRITE_FILE | kTruncate |
                             LANDLOCK_ACCESS_FS_REMOVE_DIR | LANDLOCK_ACCESS_FS_REMOVE_FILE |
                             LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_REG |
                             LANDLOCK_ACCESS_FS_REFER;

// All rights that a version knows: what is not known cannot be taken away.
uint64_t knownRights(int version) {
  uint64_t rights = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1) - 1;
  if (version >= 2) rights |= LANDLOCK_ACCESS_FS_REFER;
  if (version >= 3) rights |= kTruncate;
  if (version >= 5) rights |= kControlDevice;
  return rights;
}

uint64_t rightsOf(FileAccess access) {
  switch (access) {
    case FileAccess::kRead:
      return kReadFile | kReadFolder;
    case FileAccess::kKeep:
      return kReadFile | kReadFolder | kChange;
    case FileAccess::kDevice:
      // Folders such as /dev/shm hold files that drivers make.
      return kReadFile | kReadFolder | kControlDevice | LANDLOCK_ACCESS_FS_WRITE_FILE | kTruncate |
             LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_REMOVE_FILE;
    case FileAccess::kSockets:
      return LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_REMOVE_FILE;
    case FileAccess::kLog:
      return LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_WRITE_FILE;
  }
  return 0;
}

// The rights that a file, not a folder, can have.
constexpr uint64_t kRightsOfFiles = kReadFile | LANDLOCK_ACCESS_FS_EXECUTE |
                                    LANDLOCK_ACCESS_FS_WRITE_FILE | kTruncate | kControlDevice;

class Descriptor {
 public:
  explicit Descriptor(long number) : number_(static_cast<int>(number)) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  const int number_;
};

absl::Status refused(const char* what) {
  return absl::FailedPreconditionError(strCat("landlock: ", what, ": ", std::strerror(errno)));
}

size_t attributesSize(int version) {
  if (version >= 6) return sizeof(RulesetAttributes);
  return (version >= 4 ? 2 : 1) * sizeof(uint64_t);
}

absl::Status addFile(const Descriptor& ruleset, const FileGrant& grant, uint64_t handled) {
  const Descriptor place(open(grant.path.c_str(), O_PATH | O_CLOEXEC));
  struct stat state {};
  if (place.number() < 0 || fstat(place.number(), &state) != 0) return absl::OkStatus();
  uint64_t rights = rightsOf(grant.access) & handled;
  if (!S_ISDIR(state.st_mode)) rights &= kRightsOfFiles;
  if (rights == 0) return absl::OkStatus();
  const landlock_path_beneath_attr rule{.allowed_access = rights, .parent_fd = place.number()};
  if (syscall(SYS_landlock_add_rule, ruleset.number(), LANDLOCK_RULE_PATH_BENEATH, &rule, 0) != 0) {
    return refused(strCat("no rule for ", grant.path.string()).c_str());
  }
  return absl::OkStatus();
}

}  // namespace

int landlockVersion() {
  const long version =
      syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  return version > 0 ? static_cast<int>(version) : 0;
}

absl::Status confineByLandlock(const LandlockRules& rules, int version) {
  const RulesetAttributes attributes{.handled_access_fs = knownRights(version),
                                     .handled_access_net = kBindTcp | kConnectTcp,
                                     .scoped = kAbstractSockets | kSignals};
  const Descriptor ruleset(
      syscall(SYS_landlock_create_ruleset, &attributes, attributesSize(version), 0));
  if (ruleset.number() < 0) return refused("no list of rules");
  for (const FileGrant& grant : rules.files) {
    if (const absl::Status added = addFile(ruleset, grant, attributes.handled_access_fs);
        !added.ok()) {
      return added;
    }
  }
  for (size_t i = 0; version >= 4 && i < rules.listen_ports.size(); ++i) {
    const PortAttributes rule{.allowed_access = kBindTcp, .port = rules.listen_ports[i]};
    if (syscall(SYS_landlock_add_rule, ruleset.number(), kRulePort, &rule, 0) != 0) {
      return refused("no rule for a port");
    }
  }
  if (syscall(SYS_landlock_restrict_self, ruleset.number(), 0) != 0) {
    return refused("the process keeps its rights");
  }
  return absl::OkStatus();
}

}  // namespace viewloom
