// SPDX-License-Identifier: Apache-2.0
// Headers of flat OpenEXR files: what they say, and what they may not ask for.
#include "files/exr_description.h"

#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "files/exr_image.h"
#include "support/large_allocations.h"
#include "unit/client/exr_samples.h"
#include "unit/client/test_files.h"

namespace viewloom::files::exr_description_test {
namespace {

using Imath::Box2i;
using Imath::V2i;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const Box2i kWindow(V2i(0, 0), V2i(3, 1));

std::string writeExr(const std::filesystem::path& path, const std::string& comment) {
  const PartSamples samples(kWindow, {{"R", "Z"}});
  Imf::Header header = samples.header(kWindow);
  Imf::addComments(header, comment);
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(samples.frameBuffer());
  file.writePixels(2);
  return path;
}

std::vector<std::string> namesOf(const ExrDescribedPart& part) {
  std::vector<std::string> names;
  for (const ExrDescribedChannel& channel : part.channels) names.push_back(channel.name);
  return names;
}

TEST(ExrDescription, namesChannelsAsTheyAreRead) {
  const TestFolder folder;
  const std::filesystem::path path = folder.path() / "parts.exr";
  const PartSamples color(kWindow, {{"R", "G", "B"}});
  const PartSamples depth(kWindow, {{"Z", "depth.V"}, Imf::FLOAT});
  std::vector<Imf::Header> headers{color.header(kWindow), depth.header(kWindow)};
  headers[0].setName("beauty");
  headers[1].setName("depth");
  for (Imf::Header& header : headers) header.setType(Imf::SCANLINEIMAGE);
  {
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 2);
    Imf::OutputPart first(file, 0), second(file, 1);
    first.setFrameBuffer(color.frameBuffer());
    first.writePixels(2);
    second.setFrameBuffer(depth.frameBuffer());
    second.writePixels(2);
  }
  const auto description = describeExr(path);
  ASSERT_TRUE(description.ok()) << description.status();
  ASSERT_EQ(description->parts.size(), 2U);
  EXPECT_EQ(description->parts[0].width_px, 4);
  EXPECT_THAT(namesOf(description->parts[0]), ElementsAre("beauty.B", "beauty.G", "beauty.R"));
  EXPECT_THAT(namesOf(description->parts[1]), ElementsAre("depth.Z", "depth.V"));
  for (const std::string& name : namesOf(description->parts[1])) {
    const std::vector<std::string> channel{name};
    EXPECT_TRUE(readExrDepth(path, channel).ok()) << name;
  }
}

TEST(ExrDescription, hasTheTextsOfTheHeader) {
  const TestFolder folder;
  const auto description = describeExr(writeExr(folder.path() / "text.exr", "made by hand"));
  ASSERT_TRUE(description.ok()) << description.status();
  EXPECT_EQ(description->texts.at("comments"), "made by hand");
  EXPECT_EQ(description->texts.at("screenWindowWidth"), "1");
  EXPECT_FALSE(description->isDeep());
}

// An attribute may say that it has gigabytes; OpenEXR alone would take them first.
TEST(ExrDescription, refusesAttributesLargerThanTheFileWithoutSpendingMemory) {
  if (!test::countsLargeAllocations()) GTEST_SKIP() << "a sanitizer counts allocations itself";
  const TestFolder folder;
  const std::string good = bytesOf(writeExr(folder.path() / "good.exr", "short"));
  const std::string name("comments\0string\0", 16);
  const size_t at = good.find(name);
  ASSERT_NE(at, std::string::npos);
  for (const uint32_t size : {5000U, 20'000'000U, 0x7FFFFFFFU, 0xFFFFFFFFU}) {
    std::string bytes = good;
    for (size_t i = 0; i < 4; ++i) {
      bytes[at + name.size() + i] = static_cast<char>(size >> (8 * i) & 0xFF);
    }
    const auto path = folder.write("hostile.exr", bytes);
    const uint64_t before = test::largeAllocationCount();
    const auto description = describeExr(path);
    EXPECT_EQ(test::largeAllocationCount(), before) << "memory for " << size;
    EXPECT_THAT(
        std::string(description.status().message()),
        HasSubstr("attribute comments " + std::string(size == 5000 ? "has " : "says it has ") +
                  std::to_string(size) + " bytes"));
    EXPECT_FALSE(readExrDepth(path, {}).ok());
  }
}

TEST(ExrDescription, refusesNamesWithoutEndAndFilesCutShort) {
  const TestFolder folder;
  const auto good = writeExr(folder.path() / "good.exr", "short");
  const size_t header_size = bytesOf(good).find("screenWindowWidth");
  for (size_t count = 0; count < header_size; ++count) {
    ASSERT_FALSE(describeExr(folder.truncated(good, count)).ok()) << count;
  }
  const auto endless =
      folder.write("endless.exr", bytesOf(good).substr(0, 8) + std::string(100'000, 'n'));
  EXPECT_THAT(std::string(describeExr(endless).status().message()),
              HasSubstr("a name in it has no end"));
  EXPECT_THAT(std::string(describeExr(folder.write("x.exr", "GIF89a")).status().message()),
              HasSubstr("begins with other bytes"));
}

}  // namespace
}  // namespace viewloom::files::exr_description_test
