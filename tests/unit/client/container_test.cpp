// SPDX-License-Identifier: Apache-2.0
// Messages about files that are no pictures, or damaged ones.
#include "files/container.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include "files/picture_file.h"
#include "unit/client/test_files.h"
#include "unit/client/written_pictures.h"

namespace viewloom::files::container_test {
namespace {

using ::testing::HasSubstr;

class ContainerTest : public ::testing::Test {
 protected:
  std::string refusal(const std::string& name, const std::string& bytes) const {
    const auto picture = readPicture(folder_.write(name, bytes), PictureUse::kDepth);
    return picture.ok() ? "OK" : std::string(picture.status().message());
  }

  const TestFolder folder_;
};

TEST_F(ContainerTest, saysWhatAFileIsAndWhatToDo) {
  const std::string video = std::string("\0\0\0\x18", 4) + "ftypisom" + std::string(40, '\0');
  EXPECT_THAT(refusal("clip.mp4", video),
              HasSubstr("is a video (MP4 or MOV), not a picture; write its frames as pictures "
                        "first: ffmpeg -i \"clip.mp4\""));
  EXPECT_THAT(refusal("renamed.png", video), HasSubstr("is a video"));
  EXPECT_THAT(refusal("c.mkv", "\x1a\x45\xdf\xa3 webm"), HasSubstr("a video (WebM or MKV)"));
  EXPECT_THAT(refusal("m.glb", std::string("glTF\2\0\0\0", 8)),
              HasSubstr("is a 3D model (glTF), not a picture; render it with a depth pass"));
  EXPECT_THAT(refusal("m.obj", "v 1 2 3\n"), HasSubstr("a 3D model (OBJ)"));
  EXPECT_THAT(refusal("m.ply", "ply\nformat ascii 1.0\n"), HasSubstr("a 3D model (PLY)"));
  EXPECT_THAT(refusal("s.blend", "BLENDER-v300"), HasSubstr("a Blender scene"));
  EXPECT_THAT(refusal("a.gif", "GIF89a"), HasSubstr("is a GIF, not a picture"));
  EXPECT_THAT(refusal("a.psd", "8BPS"), HasSubstr("export it as PNG or EXR"));
  EXPECT_THAT(refusal("a.npz", "PK\x03\x04"), HasSubstr("numpy.save"));
  EXPECT_THAT(refusal("a.png", ""), HasSubstr("is empty"));
  EXPECT_THAT(refusal("a.what", "hello"),
              HasSubstr("no picture of a known kind; accepted are EXR"));
  const auto message = [](const std::filesystem::path& path) {
    return std::string(readPicture(path, PictureUse::kColor).status().message());
  };
  EXPECT_THAT(message(folder_.path()), HasSubstr("is a folder"));
  EXPECT_THAT(message(folder_.path() / "none.png"), HasSubstr("no such file"));
}

TEST_F(ContainerTest, saysWhetherAPictureIsCutShortOrDamaged) {
  const std::vector<uint8_t> grey(64 * 64, 77);
  std::string png = writtenPng(64, 64, PNG_COLOR_TYPE_GRAY, 8, grey);
  EXPECT_THAT(refusal("a.png", png.substr(0, png.size() / 2)),
              HasSubstr("ends before its picture is whole (PNG): it is cut short or still being"));
  png[png.size() - 20] = static_cast<char>(~png[png.size() - 20]);
  EXPECT_THAT(refusal("a.png", png), HasSubstr("is damaged (PNG"));
  const std::string jpeg = writtenJpeg(64, 64, std::vector<uint8_t>(3 * 64 * 64, 99));
  EXPECT_THAT(refusal("a.jpg", jpeg.substr(0, jpeg.size() - 40)),
              HasSubstr("ends before its picture is whole (JPEG)"));
}

TEST(Container, goesByTheNameInAnyCaseWhereThereIsNoFile) {
  EXPECT_EQ(containerOf("nowhere/A.PNG"), Container::kPng);
  EXPECT_EQ(containerOf("nowhere/b.Exr"), Container::kExr);
  EXPECT_EQ(containerOf("nowhere/c.YUV"), Container::kYuv);
  EXPECT_EQ(containerOf("nowhere/d.mp4"), Container::kUnknown);
}

}  // namespace
}  // namespace viewloom::files::container_test
