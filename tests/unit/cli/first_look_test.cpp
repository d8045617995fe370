// SPDX-License-Identifier: Apache-2.0
// A look at a large frame when the command is to end.
#include "cli/first_look.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>

#include "cli/interrupt.h"
#include "unit/client/test_files.h"
#include "unit/inputs/written_files.h"

namespace viewloom::cli::first_look_test {
namespace {

constexpr uint32_t kSide = 2048;

// Metres in the unit of none of the usual ones: many remedies are tried, each on all of the frame.
FrameFiles writeFrame(const files::TestFolder& folder) {
  const FrameFiles files{.manifest = {},
                         .deep = {},
                         .input = {.color = (folder.path() / "color.png").string(),
                                   .depth = (folder.path() / "depth.png").string()}};
  test::writePng(files.input.color, kSide, kSide, 3, 8,
                 std::vector<uint16_t>(size_t{3} * kSide * kSide, 90));
  std::vector<uint16_t> codes;
  for (uint32_t i = 0; i < kSide * kSide; ++i) codes.push_back(uint16_t(60000 + i % kSide));
  test::writePng(files.input.depth, kSide, kSide, 1, 16, codes);
  return files;
}

double secondsOf(FirstLook& look, std::vector<std::string>& notes) {
  const auto begun = std::chrono::steady_clock::now();
  look.finish(notes);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

TEST(FirstLook, isBrokenOffByCtrlC) {
  const files::TestFolder folder;
  const FrameFiles files = writeFrame(folder);
  const auto loaded = FrameLoader(LoaderOptions()).load(files);
  ASSERT_TRUE(loaded.ok()) << loaded.status();
  std::vector<std::string> notes;
  FirstLook whole{LoaderOptions()};
  whole.offer(files, loaded->frame);
  const double whole_s = secondsOf(whole, notes);
  EXPECT_FALSE(notes.empty());
  notes.clear();
  catchInterrupts();
  FirstLook broken_off{LoaderOptions()};
  broken_off.offer(files, loaded->frame);
  std::raise(SIGINT);
  const double broken_off_s = secondsOf(broken_off, notes);
  EXPECT_LT(broken_off_s, whole_s / 2) << "of " << whole_s << " s";
  EXPECT_TRUE(notes.empty());
}

}  // namespace
}  // namespace viewloom::cli::first_look_test
