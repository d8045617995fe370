// SPDX-License-Identifier: Apache-2.0
// Peak signal-to-noise ratio of samples whose peak is 1.
#pragma once

#include <cmath>

namespace viewloom {

// PSNR of a mean of squared errors, dB. +inf: no error; NaN: a mean of nothing.
inline double psnrDb(double mean_square) {
  return -10 * std::log10(mean_square);
}

// Adds up what samples are off.
class Psnr {
 public:
  void add(double error) {
    squares_ += error * error;
    ++count_;
  }
  double db() const { return psnrDb(squares_ / count_); }

 private:
  double squares_ = 0;
  double count_ = 0;
};

}  // namespace viewloom
