// SPDX-License-Identifier: Apache-2.0
// Each case confines a child of the test, as nobody gets rights back.
#include "containment/landlock.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "support/loopback.h"

namespace viewloom::landlock_test {
namespace {

namespace fs = std::filesystem;

int errorOfOpen(const fs::path& path, int flags) {
  const int file = open(path.c_str(), flags, 0600);
  const int error = file < 0 ? errno : 0;
  if (file >= 0) close(file);
  return error;
}

using SocketCall = int (*)(int, const sockaddr*, socklen_t);

int errorOf(SocketCall call, uint16_t port) {
  const int tcp = socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = test::loopback(port);
  const int error =
      call(tcp, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? 0 : errno;
  close(tcp);
  return error;
}

class Landlock : public testing::Test {
 protected:
  Landlock() {
    fs::create_directories(folder_ / "in");
    fs::create_directories(folder_ / "out");
    std::ofstream(folder_ / "in" / "file") << "x";
    std::ofstream(folder_ / "out" / "file") << "x";
  }
  ~Landlock() override { fs::remove_all(folder_); }

  void SetUp() override {
    if (landlockVersion() == 0) GTEST_SKIP() << "this kernel has no landlock";
  }

  // Expects that `holds` is true of a process with these rules.
  static void expectWith(const LandlockRules& rules, const std::function<bool()>& holds) {
    EXPECT_EXIT(
        {
          prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
          const absl::Status confined = confineByLandlock(rules, landlockVersion());
          if (!confined.ok()) std::fprintf(stderr, "%s\n", confined.ToString().c_str());
          _exit(confined.ok() && holds() ? 0 : 1);
        },
        testing::ExitedWithCode(0), "");
  }

  const fs::path folder_ = testing::TempDir() + "viewloom-landlock-" +
                           testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(Landlock, refusesFilesThatAreNotOnTheList) {
  expectWith({.files = {{folder_ / "in", FileAccess::kRead}}}, [this] {
    return errorOfOpen(folder_ / "in" / "file", O_RDONLY) == 0 &&
           errorOfOpen(folder_ / "out" / "file", O_RDONLY) == EACCES &&
           errorOfOpen("/etc/passwd", O_RDONLY) == EACCES;
  });
}

TEST_F(Landlock, readsWithoutWriting) {
  expectWith({.files = {{folder_ / "in", FileAccess::kRead}}}, [this] {
    return errorOfOpen(folder_ / "in" / "file", O_WRONLY) == EACCES &&
           errorOfOpen(folder_ / "in" / "new", O_WRONLY | O_CREAT) == EACCES &&
           unlink((folder_ / "in" / "file").c_str()) != 0;
  });
}

TEST_F(Landlock, keepsFilesWhereItMay) {
  expectWith({.files = {{folder_ / "in", FileAccess::kKeep}}}, [this] {
    const fs::path folder = folder_ / "in" / "sub";
    return mkdir(folder.c_str(), 0700) == 0 &&
           errorOfOpen(folder / "new", O_WRONLY | O_CREAT) == 0 &&
           rename((folder / "new").c_str(), (folder_ / "in" / "moved").c_str()) == 0 &&
           errorOfOpen(folder_ / "out" / "new", O_WRONLY | O_CREAT) == EACCES &&
           mkfifo((folder / "pipe").c_str(), 0600) != 0;
  });
}

TEST_F(Landlock, writesLogsThatItCannotReadOrRemove) {
  expectWith({.files = {{folder_ / "in", FileAccess::kLog}}}, [this] {
    const fs::path log = folder_ / "in" / "log";
    return errorOfOpen(log, O_WRONLY | O_APPEND | O_CREAT) == 0 &&
           errorOfOpen(log, O_RDONLY) == EACCES && unlink(log.c_str()) != 0 &&
           errorOfOpen(folder_ / "out" / "log", O_WRONLY | O_CREAT) == EACCES;
  });
}

TEST_F(Landlock, leavesOutWhatDoesNotExist) {
  expectWith({.files = {{folder_ / "none", FileAccess::kRead},
                        {folder_ / "in" / "file", FileAccess::kKeep}}},
             [this] { return errorOfOpen(folder_ / "in" / "file", O_RDWR) == 0; });
}

TEST_F(Landlock, leavesOpenFilesUsable) {
  const int file = open((folder_ / "out" / "file").c_str(), O_RDONLY);
  expectWith({}, [file] {
    char letter = 0;
    return read(file, &letter, 1) == 1 && letter == 'x';
  });
  close(file);
}

TEST_F(Landlock, holdsInThreadsThatStartLater) {
  expectWith({}, [] {
    int error = 0;
    std::thread([&error] { error = errorOfOpen("/etc/passwd", O_RDONLY); }).join();
    return error == EACCES;
  });
}

TEST_F(Landlock, listensOnlyWhereItMayAndCallsNobody) {
  if (landlockVersion() < 4) GTEST_SKIP() << "this kernel's landlock knows no ports";
  // The port need not be free: without a right to it, the kernel does not look.
  expectWith({.listen_ports = {0}}, [] {
    return errorOf(bind, 0) == 0 && errorOf(bind, 50051) == EACCES &&
           errorOf(connect, 50051) == EACCES;
  });
}

}  // namespace
}  // namespace viewloom::landlock_test
