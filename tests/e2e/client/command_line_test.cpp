// SPDX-License-Identifier: Apache-2.0
// Answers of `viewloom` to wrong command lines, and output of its commands with a server.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <memory>
#include <string>

#include "e2e/client/command_answer.h"
#include "e2e/client/with_viewloomd.h"

namespace viewloom::test::command_line_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Answer runViewloom(const std::string& arguments) {
  return answerTo(std::string(VIEWLOOM) + " " + arguments);
}

std::string refusal(const std::string& arguments) {
  const Answer answer = runViewloom(arguments);
  EXPECT_EQ(answer.exit_code, 2) << arguments << ": " << answer.text;
  return answer.text;
}

TEST(CommandLine, isHelpedWhenItIsEmpty) {
  const Answer answer = runViewloom("");
  EXPECT_EQ(answer.exit_code, 0);
  EXPECT_THAT(answer.text, AllOf(HasSubstr("Commands:"), HasSubstr("publish")));
}

TEST(CommandLine, namesTheNearestCommand) {
  EXPECT_THAT(refusal("pubish --synthetic"), HasSubstr("Did you mean \"publish\"?"));
  EXPECT_THAT(refusal("lsit"),
              AllOf(HasSubstr("unknown command \"lsit\""), HasSubstr("Did you mean \"list\"?")));
  EXPECT_THAT(refusal("--server unix:/none"), HasSubstr("no command is given"));
}

TEST(CommandLine, namesTheNearestOption) {
  EXPECT_THAT(refusal("publish a.png --dpeth b.png"),
              AllOf(HasSubstr("viewloom publish: unknown option \"--dpeth\""),
                    HasSubstr("Did you mean \"--depth\"")));
  EXPECT_THAT(refusal("record --otu x.vlr"), HasSubstr("Did you mean \"--out\"?"));
  EXPECT_THAT(refusal("watch --sevrer=x"), HasSubstr("Did you mean \"--server\"?"));
  EXPECT_THAT(refusal("publish --lossless"), HasSubstr("It is an option of \"viewloom watch\""));
}

TEST(CommandLine, namesTheNearestValueOfAnOption) {
  EXPECT_THAT(refusal("watch --format pgn"),
              AllOf(HasSubstr("--format"), HasSubstr("did you mean \"png\"")));
  EXPECT_THAT(refusal("publish --pattern view-number"), HasSubstr("did you mean \"view-numbers\""));
  EXPECT_THAT(refusal("watch --count ten"),
              HasSubstr("--count: got \"ten\"; accepted is a whole number"));
}

TEST(CommandLine, takesAnAddressForTheServerOfAList) {
  EXPECT_EQ(refusal("list 127.0.0.1:50180"),
            "viewloom list: unknown list \"127.0.0.1:50180\". Known lists: streams, displays, "
            "presets, server, all. Did you mean \"viewloom list --server 127.0.0.1:50180\"?\n");
  EXPECT_THAT(refusal("list strems"), HasSubstr("Did you mean \"viewloom list streams\"?"));
}

TEST(CommandLine, refusesOutputsThatAreNoRegularFilesBeforeItDoesAnything) {
  const std::string none = "--server unix:/nonexistent/viewloom ";
  EXPECT_THAT(refusal(none + "record --out /dev/null"), HasSubstr("/dev/null: is a device"));
  EXPECT_THAT(refusal(none + "record --out /tmp"), HasSubstr("/tmp: is a folder"));
  EXPECT_THAT(refusal(none + "publish --synthetic --record /dev/null"), HasSubstr("is a device"));
  EXPECT_THAT(refusal(none + "watch --out /dev/null"), HasSubstr("accepted is a folder"));
  EXPECT_THAT(refusal(none + "watch --video /none/clip.mp4"),
              HasSubstr("its folder must exist and take new files"));
  EXPECT_THAT(refusal(none + "watch --video clip.avi"),
              HasSubstr("accepted is a name that ends in .mp4"));
  EXPECT_THAT(refusal(none + "record --out /none/clip.mp4"), HasSubstr("/none/clip.mp4: cannot"));
  EXPECT_THAT(refusal("inspect none.png --picture /dev/null"), HasSubstr("is a device"));
}

class CommandsWithServer : public WithViewloomd {
 protected:
  Answer answerTo(const std::string& arguments) const {
    return runViewloom("--server " + address_ + " " + arguments);
  }
  // Stream "s" with one frame, until the publisher goes.
  std::unique_ptr<Publisher> publishOne() {
    start();
    auto publisher = publish();
    publisher->offer(smallFrame(0));
    EXPECT_EQ(publisher->finish(kLong_ns), absl::OkStatus());
    return publisher;
  }
};

TEST_F(CommandsWithServer, listTakesTheServerBehindIt) {
  start();
  const Answer answer = runViewloom("list streams --server " + address_);
  EXPECT_EQ(answer.exit_code, 0) << answer.text;
  EXPECT_THAT(answer.text, HasSubstr("STREAM"));
}

TEST_F(CommandsWithServer, namesTheNearestStreamAndPreset) {
  const auto publisher = publishOne();
  EXPECT_THAT(answerTo("watch ss --no-wait --count 1").text, HasSubstr("did you mean \"s\"?"));
  EXPECT_THAT(answerTo("watch s --preset potrait --count 1").text,
              HasSubstr("did you mean \"portrait\""));
  EXPECT_THAT(answerTo("watch s --preset wovwx --count 1").text,
              HasSubstr("--preset: there is no preset \"wovwx\"; "));
  EXPECT_THAT(answerTo("watch s --preset wovwx --count 1").text,
              HasSubstr("did you mean \"wowvx\""));
  EXPECT_THAT(answerTo("watch s --rgbd 64x48 --preset wovwx --count 1").text,
              HasSubstr("did you mean \"wowvx\""));
  EXPECT_THAT(answerTo("watch s --cone 40 --preset near_eye --count 1").text,
              HasSubstr("\"near_eye_2013\" is a display of another kind"));
}

TEST_F(CommandsWithServer, saysWhatItWaitsForAndWhatThereIs) {
  const auto publisher = publishOne();
  const std::string server = std::string(VIEWLOOM) + " --server " + address_;
  EXPECT_THAT(test::answerTo("timeout 4 " + server + " watch nothere").text,
              HasSubstr("waiting for stream \"nothere\": the server has s"));
}

TEST_F(CommandsWithServer, namesTheFilesItWritesAndNeverWritesThemAgain) {
  const auto publisher = publishOne();
  const std::string out =
      "watch s --columns 2 --rows 1 --size 64x32 --count 1 --out " + (folder_ / "out").string();
  const Answer first = answerTo(out);
  EXPECT_EQ(first.exit_code, 0) << first.text;
  EXPECT_THAT(first.text, HasSubstr("out/s_000001_"));
  EXPECT_THAT(first.text, HasSubstr("latency not known yet")) << "the picture stood before";
  EXPECT_THAT(answerTo(out).text, HasSubstr("out/s_r2_"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / "out"),
                          std::filesystem::directory_iterator()),
            2);
}

TEST_F(CommandsWithServer, writesVideosThatSayTheirLayout) {
  const auto publisher = publishOne();
  const std::string quilt = " s --columns 2 --rows 1 --size 64x32 --count 1 ";
  const std::string folder = folder_.string();
  for (const std::string& command :
       {"watch" + quilt + "--video " + folder + "/a.mp4",
        "record" + quilt + "--out " + folder + "/b.mp4",
        "record" + quilt + "--out " + folder + "/c.vlr",
        "watch --from " + folder + "/c.vlr --video " + folder + "/c.mp4"}) {
    const Answer answer = answerTo(command);
    EXPECT_EQ(answer.exit_code, 0) << answer.text;
    if (command.ends_with(".mp4")) {
      EXPECT_THAT(answer.text, HasSubstr("1 picture of 64x32 px"));
    }
  }
  for (const char* name : {"a_qs2x1a1.mp4", "b_qs2x1a1.mp4", "c_qs2x1a1.mp4"}) {
    EXPECT_GT(std::filesystem::file_size(folder_ / name), 500U) << name;
  }
}

TEST_F(CommandsWithServer, keepsWhatWasRecordedWhenTheDiskIsFull) {
  start();
  const std::string file = (folder_ / "frames.vlr").string();
  const Answer answer =
      test::answerTo("ulimit -f 600; " + std::string(VIEWLOOM) + " --server " + address_ +
                     " publish --synthetic --size 192x108 --layers 1 " +
                     "--seconds 60 --rate 100 --zstd 0 --record " + file);
  EXPECT_EQ(answer.exit_code, 1) << answer.text;
  EXPECT_THAT(answer.text, HasSubstr("keeps what came before"));
  EXPECT_THAT(answer.text, HasSubstr("recorded"));
  const Answer replay = answerTo("publish --replay " + file + " --rate 100");
  EXPECT_EQ(replay.exit_code, 0) << replay.text;
  EXPECT_FALSE(std::filesystem::exists(file + ".part"));
}

}  // namespace
}  // namespace viewloom::test::command_line_test
