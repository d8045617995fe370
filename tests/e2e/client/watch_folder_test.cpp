// SPDX-License-Identifier: Apache-2.0
// `viewloom publish --watch-folder` against a real viewloomd, while a renderer writes frames.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

#include "e2e/server_process.h"
#include "lib/channel.h"
#include "lib/watcher.h"
#include "unit/client/test_files.h"
#include "unit/inputs/written_files.h"

namespace viewloom::test::watch_folder_test {
namespace {

constexpr int64_t kLong_ns = 120'000'000'000;  // only a failing test waits so long

// viewloom with these arguments, until it is told to end.
class Command {
 public:
  explicit Command(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), VIEWLOOM);
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    if (posix_spawn(&pid_, VIEWLOOM, nullptr, nullptr, words.data(), environ) != 0) pid_ = -1;
  }
  ~Command() {
    if (pid_ > 0) kill(pid_, SIGKILL);
    if (pid_ > 0) waitpid(pid_, nullptr, 0);
  }
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  // The exit code after SIGTERM; -1 when the signal itself ended it.
  int stop() {
    kill(pid_, SIGTERM);
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
};

void writeFrame(const std::filesystem::path& path, float red) {
  const auto constant = [](const char* name, float value) {
    return WrittenChannel{name, Imf::FLOAT, [value](int, int) { return value; }};
  };
  writeExr(path, 64, 32,
           {constant("ViewLayer.Combined.R", red), constant("ViewLayer.Combined.G", 0),
            constant("ViewLayer.Combined.B", 0), constant("ViewLayer.Depth.Z", 2)});
}

v1::OpenDisplay quilt() {
  v1::OpenDisplay open;
  open.set_stream("folder");
  v1::QuiltDisplay& display = *open.mutable_display()->mutable_quilt();
  display.set_columns(2);
  display.set_rows(2);
  display.mutable_size()->set_width(64);
  display.mutable_size()->set_height(64);
  open.set_wait_for_stream(true);
  return open;
}

TEST(WatchFolder, publishesEveryFrameThatARendererCompletes) {
  const files::TestFolder folder;
  const std::string renders = folder.path() / "renders";
  std::filesystem::create_directory(renders);
  const std::string address = "unix:" + (folder.path() / "server").string();
  ServerProcess server({"serve", "--grpc.address", address, "--http.enabled", "false"});
  Command publisher(
      {"--server", address, "publish", "--watch-folder", renders, "--stream", "folder", "-q"});
  std::atomic<int> red_code{-1};
  const WatcherCallbacks callbacks{.on_layout = {},
                                   .on_atlas =
                                       [&](const Atlas& atlas) {
                                         const auto picture =
                                             decodePlane(atlas, v1::ATLAS_PLANE_COLOR);
                                         if (picture.ok()) red_code = picture->samples[0];
                                       },
                                   .on_connection = {}};
  Watcher watcher(makeChannel(address), quilt(), callbacks,
                  {.first_ns = 10'000'000, .max_ns = 200'000'000, .factor = 2});
  const auto waitForRed = [&](int least, int most) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::nanoseconds(kLong_ns);
    while (std::chrono::steady_clock::now() < end) {
      if (red_code >= least && red_code <= most) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  };
  writeFrame(std::filesystem::path(renders) / "frame.0001.exr", 1);
  EXPECT_TRUE(waitForRed(250, 255)) << red_code;
  // A broken one is passed over.
  std::filesystem::copy(std::filesystem::path(renders) / "frame.0001.exr", folder.path() / "cut");
  std::filesystem::resize_file(folder.path() / "cut", 600);
  std::filesystem::rename(folder.path() / "cut", std::filesystem::path(renders) / "frame.0002.exr");
  writeFrame(std::filesystem::path(renders) / "frame.0003.exr", 0.2F);
  EXPECT_TRUE(waitForRed(115, 135)) << red_code << ", 0.2 in sRGB is 124";
  EXPECT_EQ(publisher.stop(), 0);
}

}  // namespace
}  // namespace viewloom::test::watch_folder_test
