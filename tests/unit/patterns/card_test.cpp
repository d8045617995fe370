// SPDX-License-Identifier: Apache-2.0
#include "patterns/card.h"

#include <gtest/gtest.h>

#include <fstream>

#include "files/png_image.h"
#include "unit/client/test_files.h"

namespace viewloom::patterns::card_test {
namespace {

constexpr SizePx kSize_px{1280, 720};

Rgb at(const std::vector<uint8_t>& samples, size_t channels, double x, double y) {
  const size_t px = static_cast<size_t>(y) * kSize_px.width + static_cast<size_t>(x);
  return {samples[channels * px], samples[channels * px + 1], samples[channels * px + 2]};
}

const std::vector<uint8_t>& cardPx() {
  static const Pattern card = *makePattern({.kind = PatternKind::kCard, .size_px = kSize_px});
  return card.layers.front().color;
}

// Expects the card's colour in every pixel of its boxes.
void expectColors(const std::vector<uint8_t>& samples, size_t channels) {
  const CardPlaces places = cardPlaces(kSize_px);
  for (size_t i = 0; i < places.colors.size(); ++i) {
    const PxBox& box = places.colors[i];
    ASSERT_GT(box.width(), 20);
    for (double y = box.top; y < box.bottom; ++y) {
      for (double x = box.left; x < box.right; ++x) {
        ASSERT_EQ(at(samples, channels, x, y), kCardColors[i]) << "colour " << i;
      }
    }
  }
}

TEST(Card, hasItsColoursExactly) {
  expectColors(cardPx(), 4);
}

TEST(Card, keepsItsPxThroughPng) {
  const files::TestFolder folder;
  const auto png = files::encodePng(cardPx(), kSize_px.width, kSize_px.height, 4);
  ASSERT_TRUE(png.ok()) << png.status();
  const auto path = folder.path() / "card.png";
  std::ofstream(path, std::ios::binary) << *png;
  const auto image = files::readPngColor(path, false);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->bytes, cardPx());
}

TEST(Card, growsByACodeAtATimeAlongItsRamp) {
  const PxBox ramp = cardPlaces(kSize_px).ramp;
  ASSERT_GE(ramp.width(), 256);
  EXPECT_EQ(at(cardPx(), 4, ramp.left, ramp.top)[0], 0);
  EXPECT_EQ(at(cardPx(), 4, ramp.right - 1, ramp.top)[0], 255);
  for (double x = ramp.left + 1; x < ramp.right; ++x) {
    const Rgb before = at(cardPx(), 4, x - 1, ramp.top), here = at(cardPx(), 4, x, ramp.top);
    EXPECT_LE(here[0] - before[0], 1);
    EXPECT_GE(here[0], before[0]);
    EXPECT_EQ(here[0], here[1]);
    EXPECT_EQ(here[0], here[2]);
  }
}

TEST(Card, hasLinePairsOfWholePx) {
  const CardPlaces places = cardPlaces(kSize_px);
  for (uint32_t i = 0; i < kLinePairsMax_px; ++i) {
    const PxBox& upright = places.upright_lines[i];
    const PxBox& level = places.level_lines[i];
    for (uint32_t px = 0; px < 40; ++px) {
      const uint8_t code = px / (i + 1) % 2 == 0 ? 255 : 0;
      EXPECT_EQ(at(cardPx(), 4, upright.left + px, upright.middleY())[0], code);
      EXPECT_EQ(at(cardPx(), 4, level.middleX(), level.top + px)[0], code);
    }
  }
}

TEST(Card, hasABorderOfOnePx) {
  const Rgb white = {255, 255, 255};
  for (double x = 0; x < kSize_px.width; ++x) {
    ASSERT_EQ(at(cardPx(), 4, x, 0), white);
    ASSERT_EQ(at(cardPx(), 4, x, kSize_px.height - 1), white);
  }
  for (double y = 0; y < kSize_px.height; ++y) {
    ASSERT_EQ(at(cardPx(), 4, 0, y), white);
    ASSERT_EQ(at(cardPx(), 4, kSize_px.width - 1, y), white);
  }
  EXPECT_NE(at(cardPx(), 4, 1, kSize_px.height / 2.0 + 40), white);
}

// Letters and corners alike: a picture that equals its mirror image would not show mirroring.
TEST(Card, differsWhenMirroredOrUpsideDown) {
  size_t mirrored = 0, upside_down = 0;
  for (double y = 0; y < kSize_px.height; ++y) {
    for (double x = 0; x < kSize_px.width; ++x) {
      const Rgb here = at(cardPx(), 4, x, y);
      mirrored += here != at(cardPx(), 4, kSize_px.width - 1 - x, y);
      upside_down += here != at(cardPx(), 4, x, kSize_px.height - 1 - y);
    }
  }
  EXPECT_GT(mirrored, kSize_px.area() / 50);
  EXPECT_GT(upside_down, kSize_px.area() / 50);
}

}  // namespace
}  // namespace viewloom::patterns::card_test
