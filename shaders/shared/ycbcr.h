// SPDX-License-Identifier: Apache-2.0
// The colour transform of JPEG files (JFIF 1.02; ITU-T T.871, 7): full range, weights of BT.601,
//   Y  =  0.299 R + 0.587 G + 0.114 B,
//   Cb =  0.5 B - 0.1687 R - 0.3313 G + 128,
//   Cr =  0.5 R - 0.4187 G - 0.0813 B + 128,
// with libjpeg's coefficients of 16 bits and its rounding (jccolor.c, jcsample.c), so that samples
// made here give the bytes that libjpeg makes of RGB.
#ifndef VIEWLOOM_SHADERS_SHARED_YCBCR_H_
#define VIEWLOOM_SHADERS_SHARED_YCBCR_H_

#include "shared/gpu_types.h"

VIEWLOOM_ABI_BEGIN

// Times 2^16, rounded. Those of luma add up to 2^16, the two negative ones of chroma to a half.
VIEWLOOM_ABI_CONST uint kLumaOfRed = 19595u;
VIEWLOOM_ABI_CONST uint kLumaOfGreen = 38470u;
VIEWLOOM_ABI_CONST uint kLumaOfBlue = 7471u;
VIEWLOOM_ABI_CONST uint kCbLessRed = 11059u;
VIEWLOOM_ABI_CONST uint kCbLessGreen = 21709u;
VIEWLOOM_ABI_CONST uint kCrLessGreen = 27439u;
VIEWLOOM_ABI_CONST uint kCrLessBlue = 5329u;
VIEWLOOM_ABI_CONST uint kChromaOfOwn = 32768u;
VIEWLOOM_ABI_CONST uint kYcbcrShift = 16u;
VIEWLOOM_ABI_CONST uint kLumaOffset = 32768u;  // rounds to the nearest
// 128, and a little less than a half: pure blue and pure red end at 255.
VIEWLOOM_ABI_CONST uint kChromaOffset = 8388608u + 32767u;

// Codes are whole, 0..255, as floats: every sum is a whole number below 2^24, so that binary32 is
// exact, and a device multiplies faster. 0..255.
VIEWLOOM_ABI_FUNCTION uint lumaOf(float red, float green, float blue) {
  return uint(float(kLumaOffset) + float(kLumaOfRed) * red + float(kLumaOfGreen) * green +
              float(kLumaOfBlue) * blue) >>
         kYcbcrShift;
}

VIEWLOOM_ABI_FUNCTION uint cbOf(float red, float green, float blue) {
  return uint(float(kChromaOffset) + float(kChromaOfOwn) * blue - float(kCbLessRed) * red -
              float(kCbLessGreen) * green) >>
         kYcbcrShift;
}

VIEWLOOM_ABI_FUNCTION uint crOf(float red, float green, float blue) {
  return uint(float(kChromaOffset) + float(kChromaOfOwn) * red - float(kCrLessGreen) * green -
              float(kCrLessBlue) * blue) >>
         kYcbcrShift;
}

// Chroma of 4:2:0 is the mean of 2x2 px, centred between them. Halves are rounded down in even
// columns and up in odd ones, so that no colour drifts.
VIEWLOOM_ABI_FUNCTION uint meanChroma(uint sum_of_four, uint column) {
  return (sum_of_four + 1u + (column & 1u)) >> 2u;
}

VIEWLOOM_ABI_END

#endif  // VIEWLOOM_SHADERS_SHARED_YCBCR_H_
