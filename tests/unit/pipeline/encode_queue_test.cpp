// SPDX-License-Identifier: Apache-2.0
// Whose strip encode threads take next.
#include "pipeline/encode_queue.h"

#include <gtest/gtest.h>

#include <string>

namespace viewloom {
namespace {

// An atlas of several strips.
AtlasRunPtr runOf(const std::string& name, int64_t deadline_ns, bool gathers_on_host) {
  auto layout = std::make_shared<AtlasLayout>();
  layout->size_px = layout->tile_size_px = {64, 512};
  auto picture = std::make_shared<TraceJob>();
  picture->layout = std::move(layout);
  picture->gathers_on_host = gathers_on_host;
  auto display = std::make_shared<ActiveDisplay>();
  display->picture_key = name;
  return std::make_shared<AtlasRun>(AtlasJob{.picture_key = name, .deadline_ns = deadline_ns},
                                    std::move(picture), Pose{},
                                    std::vector<ActiveDisplayPtr>{std::move(display)});
}

class EncodeQueueTest : public ::testing::Test {
 protected:
  void push(const AtlasRunPtr& run, uint32_t strip) { queue_.push(TracedStrip{run, strip}); }
  std::string popName() {
    popped_ = std::move(queue_.pop()->traced);
    return popped_.run->job.picture_key + std::to_string(popped_.strip);
  }

  EncodeQueue queue_{16};
  TracedStrip popped_;
};

TEST_F(EncodeQueueTest, stripsKeepTheirOrder) {
  const AtlasRunPtr late = runOf("late", 200, false);
  const AtlasRunPtr soon = runOf("soon", 100, false);
  push(late, 0);
  push(soon, 0);
  EXPECT_EQ(popName(), "late0");
  EXPECT_EQ(popName(), "soon0");
}

// A lens takes much longer than to pack a strip.
TEST_F(EncodeQueueTest, aStripGoesBeforePartsOfALensThatAreDueLater) {
  const AtlasRunPtr lens = runOf("lens", 200, true);
  const AtlasRunPtr soon = runOf("soon", 100, false);
  const AtlasRunPtr late = runOf("late", 300, false);
  push(lens, 0);
  push(lens, 1);
  EXPECT_EQ(popName(), "lens0");
  TracedStrip begun = std::move(popped_);
  push(soon, 0);
  push(late, 0);
  queue_.resume(std::move(begun));
  EXPECT_EQ(popName(), "soon0");
  EXPECT_EQ(popName(), "lens0");
  queue_.resume(std::move(popped_));
  EXPECT_EQ(popName(), "lens0") << "it goes on before the next of its own";
  EXPECT_EQ(popName(), "lens1");
  EXPECT_EQ(popName(), "late0");
}

TEST_F(EncodeQueueTest, aLensThatGoesOnDoesNotPassWhatIsDueSooner) {
  push(runOf("lens", 200, true), 0);
  EXPECT_EQ(popName(), "lens0");
  push(runOf("late", 300, false), 0);
  push(runOf("soon", 100, false), 0);
  queue_.resume(std::move(popped_));
  EXPECT_EQ(popName(), "late0");
  EXPECT_EQ(popName(), "soon0");
  EXPECT_EQ(popName(), "lens0");
}

TEST_F(EncodeQueueTest, whatHasBegunIsHandedOutAfterTheQueueIsClosed) {
  push(runOf("lens", 200, true), 0);
  EXPECT_EQ(popName(), "lens0");
  queue_.close();
  queue_.resume(std::move(popped_));
  EXPECT_EQ(popName(), "lens0");
  EXPECT_FALSE(queue_.pop().has_value());
}

}  // namespace
}  // namespace viewloom
