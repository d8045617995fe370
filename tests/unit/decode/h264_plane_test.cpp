// SPDX-License-Identifier: Apache-2.0
#include "decode/h264_plane.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "unit/decode/h264_samples.h"
#include "unit/decode/jpeg_samples.h"

namespace viewloom::h264_plane_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Bytes = std::vector<uint8_t>;

struct Fidelity {
  double psnr_db = 0;
  std::array<double, 3> mean_error{};  // codes, signed
};

// Compares a decoded plane with the sample, and checks its alpha.
Fidelity fidelityOf(const Bytes& rgba, SizePx size_px) {
  Fidelity fidelity;
  double squares = 0;
  for (uint32_t y = 0; y < size_px.height; ++y) {
    for (uint32_t x = 0; x < size_px.width; ++x) {
      uint8_t want[3];
      samplePixel(size_px, x, y, want);
      const uint8_t* const got = &rgba[(size_t{y} * size_px.width + x) * 4];
      for (size_t c = 0; c < 3; ++c) {
        const double error = double{1} * got[c] - want[c];
        squares += error * error;
        fidelity.mean_error[c] += error / double(size_px.area());
      }
      EXPECT_EQ(got[3], 255);
    }
  }
  fidelity.psnr_db = 10 * std::log10(255 * 255 * 3 * double(size_px.area()) / squares);
  return fidelity;
}

void expectSample(const Bytes& wire, SizePx size_px) {
  SCOPED_TRACE(testing::Message() << size_px.width << "x" << size_px.height);
  Bytes out;
  ASSERT_EQ(decodeH264Plane(wire, size_px, out), absl::OkStatus());
  ASSERT_EQ(out.size(), size_px.area() * 4);
  const Fidelity fidelity = fidelityOf(out, size_px);
  EXPECT_GT(fidelity.psnr_db, 38);
  for (const double error : fidelity.mean_error) EXPECT_LE(std::abs(error), 1);
}

std::string refusal(const Bytes& wire, SizePx size_px) {
  Bytes out;
  const absl::Status status = decodeH264Plane(wire, size_px, out);
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  return std::string(status.message());
}

TEST(H264Plane, givesBackThePictureOpaque) {
  for (const SizePx size_px : {SizePx{16, 16}, SizePx{17, 19}, SizePx{64, 48}, SizePx{321, 203}}) {
    expectSample(sampleH264(size_px), size_px);
  }
}

TEST(H264Plane, joinsPicturesBelowEachOther) {
  expectSample(sampleH264({64, 117}, {.picture_rows = 32}), {64, 117});
  expectSample(sampleH264({640, 512}, {.picture_rows = 256, .slice_count = 4}), {640, 512});
}

TEST(H264Plane, takesPicturesOfOtherEncoders) {
  Bytes out;
  EXPECT_EQ(decodeH264Plane(x264Still(), {32, 32}, out), absl::OkStatus());
  EXPECT_EQ(out.size(), 32U * 32 * 4);
}

TEST(H264Plane, refusesPicturesThatNeedOthers) {
  EXPECT_THAT(refusal(x264BPictures(), {32, 32}), HasSubstr("every picture a key frame"));
  EXPECT_THAT(refusal(dependentH264({32, 32}), {32, 32}), HasSubstr("unit of type 1"));
  Bytes both = sampleH264({32, 32});
  const Bytes dependent = dependentH264({32, 32});
  both.insert(both.end(), dependent.begin(), dependent.end());
  EXPECT_THAT(refusal(both, {32, 32}), HasSubstr("every picture a key frame"));
}

TEST(H264Plane, refusesOtherColorAndProfiles) {
  EXPECT_THAT(refusal(x264LimitedRange(), {32, 32}),
              AllOf(HasSubstr("limited range"), HasSubstr("accepted is full range")));
  EXPECT_THAT(refusal(x264FullChroma(), {32, 32}), HasSubstr("profile is 244"));
}

TEST(H264Plane, refusesAnotherSizeThanTheDeclaredOne) {
  const Bytes wire = sampleH264({64, 48});
  EXPECT_THAT(refusal(wire, {64, 32}), HasSubstr("64x48 px at row 0"));
  EXPECT_THAT(refusal(wire, {48, 48}), HasSubstr("declare the size that is encoded"));
  EXPECT_THAT(refusal(wire, {64, 64}), HasSubstr("48 rows together"));
  EXPECT_THAT(refusal(sampleH264({64, 96}, {.picture_rows = 48}), {64, 48}),
              HasSubstr("at row 48"));
}

// A few hundred bytes that would become 37 MB.
TEST(H264Plane, refusesABombBeforeItTakesMemory) {
  Bytes out;
  const Bytes bomb = sampleH264({4096, 2304}, {.qp = 51});
  ASSERT_LT(bomb.size(), 100'000U);
  EXPECT_FALSE(decodeH264Plane(bomb, {64, 64}, out).ok());
  EXPECT_EQ(out.capacity(), 0U);
}

// The same slices again: a decoder would decode them once more.
TEST(H264Plane, refusesRepeatedSlices) {
  const Bytes once = sampleH264({64, 64});
  const Bytes start_code = {0, 0, 1, 0x65};
  const auto slice = std::search(once.begin(), once.end(), start_code.begin(), start_code.end());
  ASSERT_NE(slice, once.end());
  Bytes twice = once;
  twice.insert(twice.end(), slice, once.end());
  EXPECT_THAT(refusal(twice, {64, 64}), HasSubstr("slice 1 of a picture at macroblock 0"));
}

// Each slice may go on to the end of the picture, which is then decoded so many times.
TEST(H264Plane, refusesManySlices) {
  EXPECT_THAT(refusal(sampleH264({640, 512}, {.slice_count = 5}), {640, 512}),
              HasSubstr("accepted are up to 4 slices"));
}

TEST(H264Plane, refusesDamageOrDecodesInFull) {
  const SizePx size_px{160, 120};
  const Bytes whole = sampleH264(size_px, {.picture_rows = 64, .slice_count = 2});
  Bytes out;
  for (size_t at = 0; at < whole.size(); at += 97) {
    for (const int bits : {0x01, 0x55, 0xFF}) {
      Bytes spoilt = whole;
      spoilt[at] = uint8_t(spoilt[at] ^ bits);
      const absl::Status status = decodeH264Plane(spoilt, size_px, out);
      EXPECT_TRUE(!status.ok() || out.size() == size_px.area() * 4) << at;
    }
    if (at + 8 < whole.size()) {
      EXPECT_FALSE(decodeH264Plane(std::span(whole).first(at), size_px, out).ok()) << at;
    }
  }
  EXPECT_TRUE(decodeH264Plane(whole, size_px, out).ok());
}

TEST(H264Plane, refusesBytesThatAreNoStream) {
  EXPECT_THAT(refusal({}, {16, 16}), HasSubstr("0 rows together"));
  EXPECT_THAT(refusal(Bytes(1000, 0xFF), {16, 16}), HasSubstr("0 rows together"));
  Bytes units;
  for (int i = 0; i < 1000; ++i) units.insert(units.end(), {0, 0, 1, 9});
  EXPECT_THAT(refusal(units, {16, 16}), HasSubstr("more than 64 units"));
  EXPECT_THAT(refusal({0, 0, 1, 0x65, 0x88}, {16, 16}), HasSubstr("without parameter sets"));
  EXPECT_THAT(refusal({0, 0, 1, 0x68, 0x88}, {16, 16}),
              HasSubstr("before a sequence parameter set"));
}

}  // namespace
}  // namespace viewloom::h264_plane_test
