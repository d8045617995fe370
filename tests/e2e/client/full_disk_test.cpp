// SPDX-License-Identifier: Apache-2.0
// Commands whose disk is full, and those whose files may grow no more: what they leave behind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

#include "e2e/client/command_answer.h"
#include "e2e/client/with_viewloomd.h"
#include "files/jpeg_image.h"

namespace viewloom::test::full_disk_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;

enum class Limit { kDisk, kFile };

// A disk of the size, of this shell alone, whose files are copied to `folder` at the end.
std::string onSmallDisk(const std::string& command, const fs::path& folder, int kilobytes) {
  const std::string copy = folder.string() + ".copy";
  return "unshare -rm sh -c 'mount -t tmpfs -o size=" + std::to_string(kilobytes) + "k none " +
         folder.string() + "; " + command + "; code=$?; mkdir " + copy + "; cp -a " +
         folder.string() + "/. " + copy + "; exit $code'; code=$?; cp -a " + copy + "/. " +
         folder.string() + "; exit $code";
}

class FullDiskTest : public WithViewloomd, public ::testing::WithParamInterface<Limit> {
 protected:
  void SetUp() override {
    fs::create_directory(out_);
    if (GetParam() == Limit::kDisk && runCommand("unshare -rm true 2> /dev/null") != 0) {
      GTEST_SKIP() << "no disk can be mounted here";
    }
  }

  // `command` writes into out_, which takes so much.
  Answer answerWithin(int kilobytes, const std::string& command) const {
    if (GetParam() == Limit::kDisk) return answerTo(onSmallDisk(command, out_, kilobytes));
    // The shell counts in halves of a kilobyte.
    return answerTo("ulimit -f " + std::to_string(2 * kilobytes) + "; " + command);
  }
  std::string viewloom() const { return std::string(VIEWLOOM) + " --server " + address_ + " "; }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(out_)) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }

  static void expectReason(const Answer& answer) {
    EXPECT_EQ(answer.exit_code, 1) << answer.text;
    const std::string reason =
        GetParam() == Limit::kDisk ? "the disk is full" : "it reached the largest size allowed";
    const size_t found = answer.text.find("cannot be written: " + reason);
    ASSERT_NE(found, std::string::npos) << answer.text;
    EXPECT_EQ(answer.text.find("cannot be written", found + 1), std::string::npos) << answer.text;
  }

  const fs::path out_ = folder_ / "out";
};

INSTANTIATE_TEST_SUITE_P(Limits, FullDiskTest, ::testing::Values(Limit::kDisk, Limit::kFile),
                         [](const auto& limit) {
                           return limit.param == Limit::kDisk ? "disk" : "file";
                         });

// Shows a stream for as long as it lives.
class MovingStream {
 public:
  explicit MovingStream(std::unique_ptr<Publisher> publisher)
      : publisher_(std::move(publisher)), thread_([this](const std::stop_token& stop) {
          for (double time_s = 0; !stop.stop_requested(); time_s += 0.02) {
            publisher_->offer(smallFrame(time_s));
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
          }
        }) {}

 private:
  std::unique_ptr<Publisher> publisher_;
  std::jthread thread_;
};

TEST_P(FullDiskTest, keepsTheAtlasesThatWereRecorded) {
  const MovingStream stream(publish());
  const std::string file = (out_ / "atlases.vlr").string();
  const Answer answer =
      answerWithin(200, "timeout 60 " + viewloom() +
                            "record s --columns 2 --rows 2 --size 320x320 --out " + file);
  expectReason(answer);
  EXPECT_THAT(answer.text, HasSubstr("keeps what came before"));
  EXPECT_THAT(answer.text, HasSubstr("recorded"));
  EXPECT_THAT(names(), ::testing::ElementsAre("atlases.vlr"));
  const Answer watched = answerTo(viewloom() + "watch --from " + file);
  EXPECT_EQ(watched.exit_code, 0) << watched.text;
  EXPECT_THAT(watched.text, HasSubstr("4 views of 160x160"));
}

TEST_P(FullDiskTest, leavesWholePicturesAlone) {
  const MovingStream stream(publish());
  // A limit of one file is met by the first picture, a full disk by one of the next.
  const bool is_disk = GetParam() == Limit::kDisk;
  const Answer answer = answerWithin(is_disk ? 100 : 4, "timeout 60 " + viewloom() +
                                                            "watch s --columns 2 --rows 2 --size "
                                                            "320x320 --out " +
                                                            out_.string());
  expectReason(answer);
  if (is_disk) {
    EXPECT_GT(names().size(), 0U);
  }
  for (const std::string& name : names()) {
    EXPECT_THAT(name, EndsWith(".jpg"));
    std::ifstream file(out_ / name, std::ios::binary);
    const std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
    EXPECT_TRUE(files::decodeJpeg(name, bytes).ok()) << name;
    ASSERT_GE(bytes.size(), 2U);
    EXPECT_EQ(bytes.back(), 0xD9) << name << " has its end";
  }
}

}  // namespace
}  // namespace viewloom::test::full_disk_test
