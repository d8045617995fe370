// SPDX-License-Identifier: Apache-2.0
#include "messages/message_from_json.h"

#include <gtest/gtest.h>

#include <string>

#include "viewloom/v1/display.pb.h"

namespace viewloom::message_from_json_test {
namespace {

constexpr size_t kBytesMax = 4096;

absl::Status parse(std::string_view text, v1::Display& display) {
  return messageFromJson(text, kBytesMax, display);
}

std::string refusal(std::string_view text) {
  v1::Display display;
  const absl::Status status = parse(text, display);
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << text;
  return std::string(status.message());
}

TEST(MessageFromJson, takesNamesOfTheProtoAndThoseInCamelCase) {
  v1::Display display;
  ASSERT_TRUE(parse(R"({"quilt": {"columns": 8, "viewConeRad": 0.5, "rows": "6"},
                        "worldPose": {"position": {"z": -1}},
                        "effects": {"lens": {"focus_distance_m": 0}}})",
                    display)
                  .ok());
  EXPECT_EQ(display.quilt().columns(), 8u);
  EXPECT_EQ(display.quilt().rows(), 6u);
  EXPECT_EQ(display.quilt().view_cone_rad(), 0.5);
  EXPECT_EQ(display.world_pose().position().z(), -1);
  EXPECT_TRUE(display.effects().lens().has_focus_distance_m());
}

TEST(MessageFromJson, takesListsAndEnums) {
  v1::Display display;
  ASSERT_TRUE(parse(R"({"cameras": {"cameras": [{"fov": {"angle_up_rad": 1}}, {}],
                        "order": "TILE_ORDER_TOP_LEFT", "arrangement": 2}})",
                    display)
                  .ok());
  EXPECT_EQ(display.cameras().cameras_size(), 2);
  EXPECT_EQ(display.cameras().cameras(0).fov().angle_up_rad(), 1);
  EXPECT_EQ(display.cameras().order(), v1::TILE_ORDER_TOP_LEFT);
  EXPECT_EQ(display.cameras().arrangement(), v1::TILE_ARRANGEMENT_ROW);
}

TEST(MessageFromJson, suggestsTheNearestOfTheNamesThatThereAre) {
  const std::string message = refusal(R"({"quilt": {"colums": 8}})");
  EXPECT_TRUE(
      message.starts_with("quilt.colums: there is no such field; known fields: preset, "
                          "columns, rows, size"))
      << message;
  EXPECT_TRUE(message.ends_with("did you mean \"columns\"?")) << message;
}

TEST(MessageFromJson, saysWhatCameAndWhatIsAccepted) {
  EXPECT_EQ(refusal(R"({"quilt": {"columns": "eight"}})"),
            "quilt.columns: got \"eight\"; accepted is a whole number, 0 or more");
  EXPECT_EQ(refusal(R"({"quilt": {"columns": -1}})"),
            "quilt.columns: got -1; accepted is a whole number, 0 or more");
  EXPECT_EQ(refusal(R"({"quilt": {"columns": 4294967296}})"),
            "quilt.columns: got 4294967296; accepted is a whole number, 0 or more");
  EXPECT_EQ(refusal(R"({"quilt": {"columns": 2.5}})"),
            "quilt.columns: got 2.5; accepted is a whole number, 0 or more");
  EXPECT_EQ(refusal(R"({"quilt": {"aspect": [1]}})"),
            "quilt.aspect: got a list; accepted is a number");
  EXPECT_EQ(refusal(R"({"quilt": 5})"), "quilt: got 5; accepted is an object in braces");
  EXPECT_EQ(refusal(R"({"stereo": {"tracked": 1}})"),
            "stereo.tracked: got 1; accepted is true or false");
  EXPECT_EQ(refusal(R"({"cameras": {"cameras": {}}})"),
            "cameras.cameras: got an object; accepted is a list in brackets");
  EXPECT_EQ(refusal(R"({"cameras": {"cameras": [{}, {"pose": {"position": {"x": true}}}]}})"),
            "cameras.cameras[1].pose.position.x: got true; accepted is a number");
}

TEST(MessageFromJson, listsTheWordsOfAnEnum) {
  const std::string message = refusal(R"({"quality": "QUALITY_BETS"})");
  EXPECT_EQ(message,
            "quality: got \"QUALITY_BETS\"; accepted is one of QUALITY_UNSPECIFIED, QUALITY_DRAFT, "
            "QUALITY_BALANCED, QUALITY_BEST; did you mean \"QUALITY_BEST\"?");
}

TEST(MessageFromJson, refusesAFieldThatComesTwiceInEitherSpelling) {
  EXPECT_EQ(refusal(R"({"quilt": {"columns": 8, "columns": 9}})"),
            "quilt.columns: is given twice; accepted is once");
  EXPECT_EQ(refusal(R"({"quilt": {"view_cone_rad": 1, "viewConeRad": 1}})"),
            "quilt.view_cone_rad: is given twice; accepted is once");
  EXPECT_FALSE(refusal(R"({"quilt": {}, "stereo": {}})").empty()) << "two of one kind";
}

TEST(MessageFromJson, refusesWhatIsNoJsonOrNoObject) {
  EXPECT_TRUE(refusal(R"({"quilt": )").starts_with("the text is not valid JSON"));
  EXPECT_TRUE(refusal("").starts_with("the text is not valid JSON"));
  EXPECT_TRUE(refusal("{} {}").starts_with("the text is not valid JSON"));
  EXPECT_EQ(refusal("5"), "got 5; accepted is an object");
  EXPECT_EQ(refusal("[{}]"), "got a list; accepted is an object");
}

TEST(MessageFromJson, endsWhereTextIsTooLongOrTooDeep) {
  EXPECT_EQ(refusal(std::string(kBytesMax + 1, ' ')),
            "the text has 4097 bytes; accepted is up to 4096");
  EXPECT_FALSE(refusal(std::string(kBytesMax, '[')).empty());
  std::string deep = R"({"cameras": {"cameras": )";
  deep += std::string(2000, '[');
  EXPECT_EQ(refusal(deep), "cameras.cameras[0]: got a list; accepted is an object in braces");
}

TEST(MessageFromJson, quotesForeignTextSafelyAndShortly) {
  const std::string message = refusal("{\"" + std::string(1000, 'x') + "\": 1}");
  EXPECT_LT(message.size(), 500u);
  EXPECT_EQ(refusal("{\"\\u001b[31m\": 1}").find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace viewloom::message_from_json_test
