// SPDX-License-Identifier: Apache-2.0
// The march that reflections are measured beside is one: else nothing would follow from that.
#include "bench/mirror_duels.h"

#include <algorithm>
#include <iostream>
#include <stdexcept>
#include <string>

#include "support/test_device.h"

namespace viewloom::bench::mirror_duels_test {
namespace {

// Gain over all px of mirrors, above the view without reflections: seen 28 and more on the floor,
// 13 and more on the sphere, most of which mirrors things outside the source.
constexpr double kGainMin_db = 10;

// How far the walk is ahead of the best of marches, whatever its knobs and however long it takes,
// dB, of both views the lesser.
struct Lead {
  double all_db = 0;    // of all px of mirrors
  double known_db = 0;  // of those whose mirrored surface a layer of the source holds
};

class MirrorDuelsTest : public GpuTest {
 protected:
  static void print(const MirrorDuel& duel) {
    std::cout << duel.scene << ", view " << duel.view << ": without " << duel.without.all_db;
    for (const MirrorPoint& point : {duel.walks.front(), duel.bestMarch(), bestOfKnown(duel)}) {
      std::cout << "; " << point.name << ": known " << point.psnr.known_db << ", all "
                << point.psnr.all_db;
    }
    std::cout << "\n";
  }

  void expectAhead(const std::string& name, const Lead& lead) {
    for (const MirrorDuel& duel : mirrorDuels(device(), sceneOf(name), 0)) {
      SCOPED_TRACE(duel.scene + ", view " + duel.view);
      print(duel);
      const MirrorPsnr& walk = duel.walks.front().psnr;
      const MirrorPsnr& march = duel.bestMarch().psnr;
      EXPECT_GE(march.all_db, duel.without.all_db + kGainMin_db);
      EXPECT_GE(walk.all_db, march.all_db + lead.all_db);
      EXPECT_GE(walk.known_db, march.known_db + lead.known_db);
    }
  }

 private:
  static MirrorScene sceneOf(const std::string& name) {
    for (const MirrorScene& scene : mirrorScenes()) {
      if (scene.name == name) return scene;
    }
    throw std::runtime_error("no scene " + name);
  }

  static const MirrorPoint& bestOfKnown(const MirrorDuel& duel) {
    return *std::ranges::max_element(duel.marches, {},
                                     [](const MirrorPoint& march) { return march.psnr.known_db; });
  }
};

// Seen 5.8 and 2.7 of all px, 4.0 and 0.45 of known ones.
TEST_F(MirrorDuelsTest, aMarchFromPxToPxMirrorsTheRoomAndNoBetterThanTheWalk) {
  expectAhead("mirror floor", {.all_db = 1.5, .known_db = 0.2});
}

// Where rays meet what they see, and no thickness has to be guessed. Most of what the ball mirrors
// no source holds, and both show the environment there: of all px that is a tie, seen 0.005 and
// 0.14. Of known px 1.1 and 3.5.
TEST_F(MirrorDuelsTest, itShowsWhatABallMirrorsAndNoBetterThanTheWalk) {
  expectAhead("mirror sphere", {.all_db = -0.05, .known_db = 0.6});
}

// Seen 4.0 and 3.9 of all px, 4.1 and 3.8 of known ones.
TEST_F(MirrorDuelsTest, itMirrorsARoughFloorNoBetterThanTheWalk) {
  expectAhead("rough floor", {.all_db = 2.5, .known_db = 2.5});
}

// Seen 0.74 and 0.65 of all px, 0.39 and 0.89 of known ones. One that is told that all is 0.02 m
// thick is 0.1 dB ahead of the walk in the first view's known px, and 2 dB behind it in all.
TEST_F(MirrorDuelsTest, itMirrorsMirrorsInMirrorsNoBetterThanTheWalk) {
  expectAhead("facing mirrors", {.all_db = 0.4, .known_db = 0.15});
}

}  // namespace
}  // namespace viewloom::bench::mirror_duels_test
