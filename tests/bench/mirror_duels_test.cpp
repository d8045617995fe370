// SPDX-License-Identifier: Apache-2.0
// The march that reflections are measured beside is one: else nothing would follow from that.
#include "bench/mirror_duels.h"

#include <iostream>
#include <stdexcept>
#include <string>

#include "gpu/test_device.h"

namespace viewloom::bench {
namespace {

// Of all px of mirrors, above the view without reflections: seen 28 and more of the floor, 13 and
// more of the sphere, most of which mirrors what the source does not hold.
constexpr double kGainMin_db = 10;

class MirrorDuelsTest : public GpuTest {
 protected:
  static MirrorScene sceneOf(const std::string& name) {
    for (const MirrorScene& scene : mirrorScenes()) {
      if (scene.name == name) return scene;
    }
    throw std::runtime_error("no scene " + name);
  }
  static void print(const MirrorDuel& duel) {
    std::cout << duel.scene << ", view " << duel.view << ": without " << duel.without.all_db;
    for (const MirrorPoint& point : {duel.walks.front(), duel.bestMarch()}) {
      std::cout << "; " << point.name << ": known " << point.psnr.known_db << ", all "
                << point.psnr.all_db;
    }
    std::cout << "\n";
  }
};

// Of all px of mirrors, above the best of marches, whatever its knobs and however long it takes:
// seen 5.8 and 2.7 of the floor.
constexpr double kAboveMarchMin_db = 1.5;

TEST_F(MirrorDuelsTest, aMarchFromPxToPxMirrorsTheRoomAndNoBetterThanTheWalk) {
  for (const MirrorDuel& duel : mirrorDuels(device(), sceneOf("mirror floor"), 1)) {
    SCOPED_TRACE(duel.scene + ", view " + duel.view);
    print(duel);
    EXPECT_GE(duel.bestMarch().psnr.all_db, duel.without.all_db + kGainMin_db);
    EXPECT_GE(duel.walks.front().psnr.all_db, duel.bestMarch().psnr.all_db + kAboveMarchMin_db);
  }
}

// Where rays meet what they see, and no thickness has to be guessed.
TEST_F(MirrorDuelsTest, itShowsWhatABallMirrorsAndNoBetterThanTheWalk) {
  for (const MirrorDuel& duel : mirrorDuels(device(), sceneOf("mirror sphere"), 1)) {
    SCOPED_TRACE(duel.scene + ", view " + duel.view);
    print(duel);
    const MirrorPoint& march = duel.bestMarch();
    EXPECT_GE(march.psnr.all_db, duel.without.all_db + kGainMin_db);
    EXPECT_GE(duel.walks.front().psnr.known_db, march.psnr.known_db);
  }
}

}  // namespace
}  // namespace viewloom::bench
