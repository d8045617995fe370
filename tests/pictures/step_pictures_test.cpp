// SPDX-License-Identifier: Apache-2.0
// The pictures of shaders/*.md are those that the program draws.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "pictures/step_pictures.h"
#include "pictures/svg.h"
#include "support/test_device.h"

namespace viewloom::pictures::step_pictures_test {
namespace {

// Px of a drawing, or cells visited: devices round apart.
constexpr double kTolerance = 1;

std::string read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class StepPicturesTest : public GpuTest {};

TEST_F(StepPicturesTest, areAsTheReadmeShowsThem) {
  for (const Picture& picture : drawSteps(device())) {
    const std::string shown = read(VIEWLOOM_SOURCE_DIR "/shaders/pictures/" + picture.file_name);
    EXPECT_TRUE(showTheSame(shown, picture.svg, kTolerance))
        << picture.file_name
        << " is another: run viewloom-step-pictures shaders/pictures, and look";
  }
}

TEST(Svg, showsTheSameOnlyWithTheSameShapesInTheSamePlaces) {
  Svg drawn(100, 100);
  drawn.line({1, 2}, {30, 40}, "axis");
  EXPECT_TRUE(showTheSame(drawn.file(), drawn.file(), 0));
  Svg moved(100, 100);
  moved.line({1, 2}, {30, 43}, "axis");
  EXPECT_TRUE(showTheSame(drawn.file(), moved.file(), 3.5));
  EXPECT_FALSE(showTheSame(drawn.file(), moved.file(), 2.5));
  Svg other(100, 100);
  other.line({1, 2}, {30, 40}, "grid");
  EXPECT_FALSE(showTheSame(drawn.file(), other.file(), 1));
  drawn.text({5, 5}, "more", "");
  EXPECT_FALSE(showTheSame(drawn.file(), moved.file(), 100));
}

}  // namespace
}  // namespace viewloom::pictures::step_pictures_test
