// SPDX-License-Identifier: Apache-2.0
// Photos that are damaged, lie about themselves, or are none: a sentence each, never a crash.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "photos/photo.h"
#include "unit/client/test_files.h"
#include "unit/inputs/written_files.h"
#include "unit/photos/written_photo.h"

namespace viewloom::test::photo_hostile_test {
namespace {

using files::TestFolder;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class PhotoHostileTest : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string refusal(const Bytes& bytes) const {
    writeBytes(file("photo.heic"), bytes);
    return refusalOf({}, {.color = file("photo.heic")});
  }

  const TestFolder folder_;
  const Bytes whole_ = encodePhoto(portrait());
};

TEST_F(PhotoHostileTest, readsTheWholeFile) {
  EXPECT_EQ(refusal(whole_), "OK");
}

TEST_F(PhotoHostileTest, saysThatFilesAreCutShort) {
  EXPECT_THAT(refusal({}), HasSubstr("photo.heic: is empty"));
  for (size_t length = 1; length < whole_.size(); length += 1 + length / 16) {
    const std::string said = refusal(Bytes(whole_.begin(), whole_.begin() + ptrdiff_t(length)));
    EXPECT_THAT(said, HasSubstr("photo.heic: is no HEIC that can be read, or is cut short: "))
        << length;
  }
}

TEST_F(PhotoHostileTest, saysWhatIsNoPhoto) {
  for (const std::string& text :
       {std::string("a letter, and no photo at all"), std::string(5000, 'x')}) {
    EXPECT_THAT(refusal(Bytes(text.begin(), text.end())), HasSubstr("is no HEIC")) << text;
  }
  EXPECT_THAT(refusal({0xFF, 0xD8, 0xFF, 0xE0, ' ', 'J', 'F', 'I', 'F'}),
              HasSubstr("photo.heic: ends before its picture is whole (JPEG)"));
  EXPECT_THAT(refusalOf({}, {.color = file("none.heic")}), HasSubstr("none.heic: no such file"));
  EXPECT_THAT(refusalOf({}, {.color = folder_.path().string() + "/.heic"}), HasSubstr("/.heic"));
}

// Before any memory is spent on px.
TEST_F(PhotoHostileTest, refusesSizesBeyondThoseOfPlanes) {
  for (const size_t image : {0U, 1U}) {
    EXPECT_THAT(refusal(withSizeStated(whole_, image, 60000, 60000)),
                HasSubstr("exceeds the maximum image size 8192x8192"));
    EXPECT_THAT(refusal(withSizeStated(whole_, image, 0, 48)), HasSubstr("accepted is 1..8192"));
  }
}

TEST_F(PhotoHostileTest, refusesImagesOfAnotherSizeThanStated) {
  EXPECT_THAT(refusal(withSizeStated(whole_, 0, 8000, 8000)), HasSubstr("photo.heic: "));
  EXPECT_THAT(refusal(withSizeStated(whole_, 1, 90, 72)),
              HasSubstr("says 90x72 px of an image of 96x72; the file is damaged"));
}

// Damaged bytes anywhere: a frame or a sentence that begins with the file.
TEST_F(PhotoHostileTest, survivesDamage) {
  std::mt19937 random(5);
  for (int round = 0; round < 400; ++round) {
    Bytes damaged = whole_;
    for (int change = 0; change <= round % 4; ++change) {
      // Boxes take the first third of the file.
      const size_t end = round % 2 == 0 ? damaged.size() / 3 : damaged.size();
      damaged[random() % end] = static_cast<uint8_t>(random());
    }
    EXPECT_THAT(refusal(damaged), AnyOf("OK", HasSubstr("photo.heic: "))) << round;
  }
}

TEST_F(PhotoHostileTest, survivesDepthRepresentationsOfAnyBytes) {
  std::mt19937 random(6);
  for (size_t length = 0; length < 24; ++length) {
    WrittenPhoto photo = portrait();
    photo.xmp = "";
    photo.subtypes.resize(length);
    for (uint8_t& byte : photo.subtypes) byte = static_cast<uint8_t>(random());
    EXPECT_THAT(refusal(encodePhoto(photo)),
                AnyOf("OK", HasSubstr("photo.heic: "), StartsWith("has the same value")))
        << length;
  }
}

TEST_F(PhotoHostileTest, tellsPhotosByTheirNames) {
  for (const char* name : {"a.heic", "b/IMG_1.HEIC", "c.HeiF", "d.hif"}) {
    EXPECT_TRUE(photos::isPhoto(name)) << name;
  }
  for (const char* name : {"heic", "a.heic.png", ".heic", "a.avif", ""}) {
    EXPECT_FALSE(photos::isPhoto(name)) << name;
  }
}

}  // namespace
}  // namespace viewloom::test::photo_hostile_test
