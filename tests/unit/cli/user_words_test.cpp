// SPDX-License-Identifier: Apache-2.0
#include "cli/report_error.h"

#include <gmock/gmock.h>
#include <grpcpp/support/status.h>
#include <gtest/gtest.h>

#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/display_options.h"
#include "lib/channel.h"
#include "unit/client/test_files.h"

namespace viewloom::cli::user_words_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(UserWords, nameTheOptionOfAField) {
  EXPECT_EQ(inUserWords("display.quilt.preset: there is no \"x\""), "--preset: there is no \"x\"");
  EXPECT_EQ(inUserWords("quilt.columns: got 0"), "--columns: got 0");
  EXPECT_EQ(inUserWords("quilt.size.width: got 0"), "--size: got 0");
  EXPECT_EQ(inUserWords("display.effects.lens.aperture_radius_m: got 11"), "--aperture: got 11");
  EXPECT_EQ(inUserWords("rgbd.far_m: got 1"), "--depth-far: got 1");
}

TEST(UserWords, nameTheFieldOfAMessageThatTheUserWrote) {
  const std::vector<std::string> whole{"display"};
  EXPECT_EQ(inUserWords("open.display.quilt.size: missing", whole), "display.quilt.size: missing");
  EXPECT_EQ(inUserWords("display.quilt.view_cone_rad: got 7 rad", whole),
            "display.quilt.view_cone_rad: got 7 rad");
  EXPECT_EQ(inUserWords("open.encoding.jpeg_quality: got 101", whole), "--quality: got 101");
  EXPECT_EQ(inUserWords("near_m: got -1", whole), "--near: got -1");
}

TEST(UserWords, knowWhichMessagesTheUserWrote) {
  const usage::CommandLine app;
  CommonOptions common{.server = "host:5"};
  const std::vector<NamedCommand> commands = addCommands(app);
  noteMessages(commands, common);
  const char* const words[] = {"viewloom", "watch", "--display", "{\"preset\": \"portrait\"}"};
  ASSERT_FALSE(app.parse(int{std::size(words)}, words).has_value());
  EXPECT_THAT(common.messages, ElementsAre("display"));
}

TEST(UserWords, nameTheLayerOfAFrame) {
  EXPECT_EQ(inUserWords("sources[0].layers[1].depth: got 0 bytes"), "layer 2, depth: got 0 bytes");
  EXPECT_EQ(inUserWords("sources[2].camera: got nan"), "source 3, camera: got nan");
  EXPECT_EQ(inUserWords("sources[0]: no layers"), "the frame: no layers");
}

TEST(UserWords, nameADeepFileByItsName) {
  EXPECT_EQ(inUserWords("deep: a.exr: has no deep part"), "a.exr: has no deep part");
}

TEST(UserWords, leaveOtherMessagesAlone) {
  for (const char* text : {"no field", "a b: c", "stream: there is none", ": x", "sources[: x",
                           "sources[99999999999999999999].a: x"}) {
    EXPECT_EQ(inUserWords(text), text);
  }
}

TEST(UserWords, standInTheHelpOfEveryCommand) {
  const std::regex of_developers(
      "\\b(trac(e|es|ed|ing)|drain(s|ed|ing)?|slots?|structs?|enums?|ENUM|payload|protobuf|"
      "FrameManifest|TruthManifest|DEPTH_MEANING_\\w+|PLANE_ENCODING_\\w+|null|boolean)\\b");
  const usage::CommandLine app;
  for (const NamedCommand& named : addCommands(app)) {
    const std::string help = named.syntax.help();
    std::smatch word;
    EXPECT_FALSE(std::regex_search(help, word, of_developers))
        << named.syntax.name() << ": " << word.str();
  }
}

TEST(UserWords, sayWhyNoServerAnswers) {
  const CommonOptions common{.server = "host:5"};
  const auto said = [&](const char* message) {
    return explain(statusFromGrpc(grpc::Status(grpc::StatusCode::UNAVAILABLE, message)), common);
  };
  EXPECT_THAT(
      said("failed to connect to all addresses; last error: UNKNOWN: ipv4:1.2.3.4:5: Failed "
           "to connect to remote host: Connection refused"),
      StartsWith("no server at host:5 (connection refused); start one with"));
  EXPECT_THAT(
      said("DNS resolution failed for host:5: C-ares status is not ARES_SUCCESS qtype=AAAA: "
           "Domain name not found"),
      StartsWith("no server at host:5 (there is no host of that name); "));
  EXPECT_THAT(said("Socket closed"), HasSubstr("(it has closed the connection)"));
  const std::string failed =
      "failed to connect to all addresses; last error: UNKNOWN: ipv4:1.2.3.4:5: ";
  EXPECT_THAT(said((failed + "Socket closed").c_str()), HasSubstr("if it speaks TLS"));
  EXPECT_THAT(said((failed + "Tls handshake failed: SSL_ERROR_SSL: error:0A00010B:SSL "
                             "routines::wrong version number")
                       .c_str()),
              StartsWith("the server speaks no TLS ("));
  EXPECT_EQ(said((failed + "Custom verification check failed with error: UNAUTHENTICATED: the "
                           "certificate of host is not the pinned one; look")
                     .c_str()),
            "the certificate of host is not the pinned one; look");
  EXPECT_THAT(said("keepalive watchdog timeout"), HasSubstr("(it has stopped answering)"));
}

TEST(UserWords, sayInOneLineWhatIsWrongWithAFile) {
  const files::TestFolder folder;
  folder.write("display.json", "root:x:0\nroot:y:1\n");
  const std::string path = (folder.path() / "display.json").string();
  DisplayOptions options;
  options.file = path;
  EXPECT_EQ(std::string(makeDisplay(options).status().message()),
            path +
                ": does not describe a display in JSON: the text is not valid JSON at byte 1, "
                "near \"r\"");
}

}  // namespace
}  // namespace viewloom::cli::user_words_test
