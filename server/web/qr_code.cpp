// SPDX-License-Identifier: Apache-2.0
#include "web/qr_code.h"

#include <memory>
#include <string_view>

#include <qrencode.h>

#include "absl/strings/str_replace.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

// Modules of light around a code; readers need them. A terminal is mostly dark around it anyway.
constexpr int kQuietOfLines = 2;
constexpr int kQuietOfPicture = 4;
// Black on white, as readers expect it; terminals are often the other way round.
constexpr const char* kBlackOnWhite = "\x1b[30;107m";
constexpr const char* kUsual = "\x1b[0m\n";

class Code {
 public:
  explicit Code(const std::string& text)
      : code_(QRcode_encodeString8bit(text.c_str(), 0, QR_ECLEVEL_L), &QRcode_free) {}

  bool isThere() const { return code_ != nullptr; }
  int width() const { return code_->width; }
  // False outside.
  bool isDark(int row, int column) const {
    const bool is_inside = row >= 0 && row < width() && column >= 0 && column < width();
    return is_inside && (code_->data[row * width() + column] & 1) != 0;
  }

 private:
  const std::unique_ptr<QRcode, decltype(&QRcode_free)> code_;
};

std::string escaped(std::string_view text) {
  return absl::StrReplaceAll(asAbslPart(text), {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}});
}

// The dark modules, as one path: a rectangle for each run of a row.
std::string darkPath(const Code& code) {
  std::string path;
  for (int row = 0; row < code.width(); ++row) {
    for (int column = 0; column < code.width();) {
      int end = column;
      while (code.isDark(row, end)) ++end;
      if (end > column) {
        path += strCat("M", column, " ", row, "h", end - column, "v1h-", end - column, "z");
      }
      column = end + 1;
    }
  }
  return path;
}

}  // namespace

std::string qrCode(const std::string& text) {
  const Code code(text);
  if (!code.isThere()) return "";
  const int end = code.width() + kQuietOfLines;
  std::string lines;
  for (int row = -kQuietOfLines; row < end; row += 2) {
    lines += kBlackOnWhite;
    for (int column = -kQuietOfLines; column < end; ++column) {
      const bool upper = code.isDark(row, column);
      const bool lower = code.isDark(row + 1, column);
      lines += upper && lower ? "█" : upper ? "▀" : lower ? "▄" : " ";
    }
    lines += kUsual;
  }
  return lines;
}

std::string qrPicture(const std::string& text, const std::string& description) {
  const Code code(text);
  if (!code.isThere()) return "";
  const int side = code.width() + 2 * kQuietOfPicture;
  return strCat("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"", -kQuietOfPicture, " ",
                -kQuietOfPicture, " ", side, " ", side,
                "\" shape-rendering=\"crispEdges\">\n<title>", escaped(text), "</title>\n<desc>",
                escaped(description),
                "</desc>\n<path fill=\"#fff\" "
                "d=\"M-",
                kQuietOfPicture, " -", kQuietOfPicture, "h", side, "v", side, "h-", side,
                "z\"/>\n<path d=\"", darkPath(code), "\"/>\n</svg>\n");
}

}  // namespace viewloom
