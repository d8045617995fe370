// SPDX-License-Identifier: Apache-2.0
#include "commands/qr_code.h"

#include <memory>

#include <qrencode.h>

namespace viewloom {
namespace {

// Modules of light around a code; readers need them.
constexpr int kQuietModules = 2;
// Black on white, as readers expect it; terminals are often the other way round.
constexpr const char* kBlackOnWhite = "\x1b[30;107m";
constexpr const char* kUsual = "\x1b[0m\n";

}  // namespace

std::string qrCode(const std::string& text) {
  const std::unique_ptr<QRcode, decltype(&QRcode_free)> code(
      QRcode_encodeString8bit(text.c_str(), 0, QR_ECLEVEL_L), &QRcode_free);
  if (code == nullptr) return "";
  const int width = code->width;
  const auto isDark = [&](int row, int column) {
    const bool is_inside = row >= 0 && row < width && column >= 0 && column < width;
    return is_inside && (code->data[row * width + column] & 1) != 0;
  };
  std::string lines;
  for (int row = -kQuietModules; row < width + kQuietModules; row += 2) {
    lines += kBlackOnWhite;
    for (int column = -kQuietModules; column < width + kQuietModules; ++column) {
      const bool upper = isDark(row, column);
      const bool lower = isDark(row + 1, column);
      lines += upper && lower ? "█" : upper ? "▀" : lower ? "▄" : " ";
    }
    lines += kUsual;
  }
  return lines;
}

}  // namespace viewloom
