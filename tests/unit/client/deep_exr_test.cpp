// SPDX-License-Identifier: Apache-2.0
#include "files/deep_exr.h"

#include <Imath/half.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "support/deep_exr_writer.h"
#include "unit/client/test_files.h"

namespace viewloom::files::deep_exr_test {
namespace {

using Imath::Box2i;
using Imath::V2i;
using test::DeepFileOptions;
using test::DeepPicture;
using test::DeepPixel;
using ::testing::HasSubstr;

// Up to five samples a pixel, many without any; values that binary16 holds, and whole depths.
DeepPicture randomPicture(const Box2i& data, const Box2i& display) {
  std::mt19937 random(99);
  DeepPicture picture{.data = data, .display = display, .pixels = {}};
  const auto width = static_cast<size_t>(data.max.x - data.min.x + 1);
  const auto height = static_cast<size_t>(data.max.y - data.min.y + 1);
  picture.pixels.resize(width * height);
  for (DeepPixel& pixel : picture.pixels) {
    pixel.resize(random() % 3 == 0 ? 0 : random() % 6);
    for (deep::DeepSample& sample : pixel) {
      sample.z_m = static_cast<float>(1 + random() % 100);
      sample.z_back_m = sample.z_m + static_cast<float>(random() % 3);
      sample.alpha = static_cast<float>(random() % 257) / 256;
      const auto color = [&] { return static_cast<float>(random() % 1024) / 512; };
      sample.color = {color(), color(), color()};
    }
  }
  return picture;
}

// The picture as read, over the display window; pixels without data stay empty.
absl::StatusOr<std::vector<DeepPixel>> readAll(const std::filesystem::path& path,
                                               const DeepUnits& units = {}) {
  absl::StatusOr<DeepExr> file = DeepExr::open(path, units);
  if (!file.ok()) return file.status();
  std::vector<DeepPixel> pixels(size_t{file->widthPx()} * file->heightPx());
  const absl::Status status = file->forEachRow([&](const DeepRow& row) {
    size_t at = 0;
    for (size_t i = 0; i < row.counts.size(); ++i) {
      const auto samples = row.samples.subspan(at, row.counts[i]);
      pixels.at(row.y * size_t{file->widthPx()} + row.x + i).assign(samples.begin(), samples.end());
      at += row.counts[i];
    }
    EXPECT_EQ(at, row.samples.size());
  });
  if (!status.ok()) return status;
  return pixels;
}

void expectSame(const std::vector<DeepPixel>& read, const DeepPicture& written, bool has_back) {
  const Box2i& display = written.display;
  size_t at = 0;
  for (int y = display.min.y; y <= display.max.y; ++y) {
    for (int x = display.min.x; x <= display.max.x; ++x, ++at) {
      DeepPixel wanted;
      if (written.data.intersects(V2i(x, y))) {
        const int width = written.data.max.x - written.data.min.x + 1;
        wanted = written.pixels[static_cast<size_t>((y - written.data.min.y) * width + x -
                                                    written.data.min.x)];
      }
      ASSERT_EQ(read[at].size(), wanted.size()) << x << ", " << y;
      for (size_t i = 0; i < wanted.size(); ++i) {
        const deep::DeepSample& sample = read[at][i];
        ASSERT_EQ(sample.z_m, wanted[i].z_m);
        ASSERT_EQ(sample.z_back_m, has_back ? wanted[i].z_back_m : wanted[i].z_m);
        ASSERT_EQ(sample.alpha, wanted[i].alpha);
        ASSERT_EQ(sample.color, wanted[i].color);
      }
    }
  }
}

const Box2i kWindow(V2i(0, 0), V2i(36, 20));

class DeepExrTest : public ::testing::Test {
 protected:
  std::filesystem::path write(const DeepPicture& picture, const DeepFileOptions& options) const {
    const std::filesystem::path path = folder_.path() / "deep.exr";
    test::writeDeepExr(path, picture, options);
    return path;
  }

  void expectRead(const DeepPicture& picture, const DeepFileOptions& options) const {
    const auto read = readAll(write(picture, options));
    ASSERT_TRUE(read.ok()) << read.status();
    expectSame(*read, picture, options.has_back);
  }

  TestFolder folder_;
};

TEST_F(DeepExrTest, readsEveryCompressionOfScanLinesAndTiles) {
  const DeepPicture picture = randomPicture(kWindow, kWindow);
  for (const Imf::Compression compression :
       {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION}) {
    for (const int tile_side_px : {0, 8, 64}) {
      SCOPED_TRACE(testing::Message() << "compression " << compression << ", " << tile_side_px);
      expectRead(picture, {.compression = compression, .tile_side_px = tile_side_px});
    }
  }
}

TEST_F(DeepExrTest, readsChannelsOfEveryTypeAmongOthers) {
  const DeepPicture picture = randomPicture(kWindow, kWindow);
  expectRead(picture, {.has_back = false,
                       .types = {{"R", Imf::HALF},
                                 {"G", Imf::HALF},
                                 {"A", Imf::HALF},
                                 {"AA", Imf::UINT},
                                 {"Z", Imf::UINT},
                                 {"id", Imf::HALF}}});
}

TEST_F(DeepExrTest, readsWhatOfTheDataIsInTheDisplayWindow) {
  const Box2i data(V2i(-5, 3), V2i(30, 40));
  for (const int tile_side_px : {0, 8}) {
    // Data begin before the display and inside it, and end inside and beyond it.
    expectRead(randomPicture(data, Box2i(V2i(2, -4), V2i(50, 20))), {.tile_side_px = tile_side_px});
    expectRead(randomPicture(data, Box2i(V2i(-9, 10), V2i(11, 60))),
               {.tile_side_px = tile_side_px});
    expectRead(randomPicture(data, Box2i(V2i(100, 100), V2i(110, 110))),
               {.tile_side_px = tile_side_px});
  }
}

TEST_F(DeepExrTest, readsTheFirstDeepPartAndTheLargestLevel) {
  const DeepPicture picture = randomPicture(kWindow, kWindow);
  expectRead(picture, {.is_second_part = true});
  expectRead(picture, {.tile_side_px = 16, .is_second_part = true});
  expectRead(picture, {.tile_side_px = 16, .has_mip_levels = true});
}

TEST_F(DeepExrTest, turnsItsUnitsIntoMetres) {
  DeepPicture picture = randomPicture(kWindow, kWindow);
  const auto read = readAll(write(picture, {}), {.scale = 0.5, .offset_m = 0.25});
  for (DeepPixel& pixel : picture.pixels) {
    for (deep::DeepSample& sample : pixel) {
      sample.z_m = 0.5F * sample.z_m + 0.25F;
      sample.z_back_m = 0.5F * sample.z_back_m + 0.25F;
    }
  }
  ASSERT_TRUE(read.ok()) << read.status();
  expectSame(*read, picture, true);
}

}  // namespace
}  // namespace viewloom::files::deep_exr_test
