// SPDX-License-Identifier: Apache-2.0
#include "web/qr_code.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace viewloom::qr_code_test {
namespace {

// Modules of the first lines of a code, 1 = dark, two rows a line.
std::vector<std::string> rowsOf(const std::string& lines) {
  std::vector<std::string> rows;
  size_t at = 0;
  while (at < lines.size()) {
    const size_t end = lines.find('\n', at);
    std::string line = lines.substr(at, end - at);
    at = end + 1;
    line = line.substr(line.find('m') + 1, line.rfind('\x1b') - line.find('m') - 1);
    std::string upper;
    std::string lower;
    for (size_t i = 0; i < line.size();) {
      const std::string block = line[i] == ' ' ? " " : line.substr(i, 3);
      i += block.size();
      upper += block == "█" || block == "▀" ? '1' : '0';
      lower += block == "█" || block == "▄" ? '1' : '0';
    }
    rows.push_back(upper);
    rows.push_back(lower);
  }
  return rows;
}

TEST(QrCode, hasItsFinderPatternsAndAQuietBorder) {
  const std::vector<std::string> rows = rowsOf(qrCode("https://10.0.0.5:8080/"));
  ASSERT_GE(rows.size(), 29U);  // 25 modules of version 2, and two on each side
  const size_t width = rows.front().size();
  EXPECT_EQ(width, 29U);
  EXPECT_TRUE(std::ranges::all_of(rows.front(), [](char module) { return module == '0'; }));
  for (const size_t left : {size_t{2}, width - 9}) {
    EXPECT_EQ(rows[2].substr(left, 7), "1111111");
    EXPECT_EQ(rows[3].substr(left, 7), "1000001");
    EXPECT_EQ(rows[4].substr(left, 7), "1011101");
  }
  EXPECT_EQ(rows[20].substr(2, 7), "1111111");
}

// Modules of a picture, without its border. The path has a rectangle for each run of a row.
std::vector<std::string> rowsOfPicture(const std::string& picture) {
  const std::string begin = "<path d=\"";
  const size_t first = picture.find(begin) + begin.size();
  const std::string path = picture.substr(first, picture.find('"', first) - first);
  std::vector<std::string> rows(25, std::string(25, '0'));
  for (size_t at = 0; at < path.size(); at = path.find('z', at) + 1) {
    int column = 0;
    int row = 0;
    int count = 0;
    EXPECT_EQ(std::sscanf(path.c_str() + at, "M%d %dh%dv1h-", &column, &row, &count), 3);
    rows.at(size_t(row)).replace(size_t(column), size_t(count), size_t(count), '1');
  }
  return rows;
}

TEST(QrPicture, hasTheModulesOfTheLines) {
  const std::string address = "https://10.0.0.5:8080/";
  const std::vector<std::string> lines = rowsOf(qrCode(address));
  const std::vector<std::string> picture = rowsOfPicture(qrPicture(address, ""));
  for (size_t row = 0; row < picture.size(); ++row) {
    EXPECT_EQ(picture[row], lines[row + 2].substr(2, 25)) << row;
  }
}

TEST(QrPicture, saysWhatItShows) {
  const std::string picture = qrPicture("https://a/?b=1&c=<>", "until 2027");
  EXPECT_NE(picture.find("<title>https://a/?b=1&amp;c=&lt;&gt;</title>"), std::string::npos);
  EXPECT_NE(picture.find("<desc>until 2027</desc>"), std::string::npos);
}

TEST(QrCode, isEmptyForTextsThatFitInNone) {
  EXPECT_EQ(qrCode(std::string(4000, 'a')), "");
  EXPECT_EQ(qrPicture(std::string(4000, 'a'), ""), "");
}

}  // namespace
}  // namespace viewloom::qr_code_test
