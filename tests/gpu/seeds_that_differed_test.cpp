// SPDX-License-Identifier: Apache-2.0
// Scenes of viewloom-oracle-soak on which the walk or the sweep once differed from the oracle, and
// what each was.
#include <ostream>

#include "gpu/judge_seed.h"
#include "support/test_device.h"

namespace viewloom::seeds_that_differed_test {
namespace {

struct OnceDiffered {
  uint64_t seed;
  const char* mistake;
};

std::ostream& operator<<(std::ostream& out, const OnceDiffered& once) {
  return out << once.seed << ", " << once.mistake;
}

// A ray moving away from a rough surface met the error of a plane as a step up, and hit it, or was
// taken for behind or in front of it although the facets said otherwise.
constexpr const char* kMovesAway = "moves away from a plane within its error";
// From an eye behind the source the tolerance grows towards the eye; a plane was taken by that of
// its near end, far too much for where the ray met it.
constexpr const char* kEyeBehindTheSource = "hits where the tolerance is least in its cell";
// At the edge of a link to a lower layer, a ray that came closer hit from as far off as the
// display's tolerance allows, where no walk had taken a plane for the facets.
constexpr const char* kHitsFromAfar = "hits a link from further off than any error";
// The other way round: the walk of the lower layer took a plane just in front of which the ray left
// the facet, so that its link alone is left to be hit.
constexpr const char* kHitsWithinAPlane = "hits a link that a plane of the lower layer has missed";
// Oracle and walk both missed the sky that ends a facet which falls below it in its footprint.
constexpr const char* kComesOutOverTheSky = "comes out from behind a facet and ends at the sky";
// The judge compared with moved rays that had all hit elsewhere on the same surface.
constexpr const char* kBesideItsOwnHit = "lies within the tolerance of its own ray's hit alone";
// The judge compared with rays moved by the whole tolerance, which all hit one surface again, and
// with none between.
constexpr const char* kMissesBetween = "misses, as rays do that are moved by less";
// Oracle and walk differed on facets whose slopes carry them before the layer in front of them.
constexpr const char* kBeforeItsLayer = "passes facets that stand before the layer before them";
// A ray that came out from behind a facet by less than rounding hit the next one.
constexpr const char* kComesOutByRounding = "comes out from behind a facet by less than rounding";
// A plane whose error reaches before all facets was taken for what a ray began behind, or went on
// behind, although it was in front of the facets.
constexpr const char* kTakenForBehind = "is taken for behind by the error of a plane";
// A ray that came out by more than its rounding, and less than that of the largest inv_z as a plane
// of large error had raised it, went on as if behind.
constexpr const char* kRoundsTooMuch = "comes out from behind a facet by more than rounding";
// The judge looked for the answer around that of the true surface alone.
constexpr const char* kSkims = "skims a rough surface and hits it within the tolerance, px away";

constexpr OnceDiffered kSeeds[] = {
    {12495, kMovesAway},
    {14247, kMovesAway},
    {14721, kMovesAway},
    {20172, kMovesAway},
    {20868, kMovesAway},
    {22798, kMovesAway},
    {31065, kMovesAway},
    {33720, kMovesAway},
    {33966, kEyeBehindTheSource},
    {43278, kEyeBehindTheSource},
    {43360, kEyeBehindTheSource},
    {13320, kHitsFromAfar},
    {28710, kHitsWithinAPlane},
    {13472, kComesOutOverTheSky},
    {13827, kBesideItsOwnHit},
    {24972, kMissesBetween},
    {26357, kBeforeItsLayer},
    {30742, kBeforeItsLayer},
    {33983, kBeforeItsLayer},
    {34922, kBeforeItsLayer},
    {53702, kBeforeItsLayer},
    {32671, kComesOutByRounding},
    {56144, kRoundsTooMuch},
    {47695, kTakenForBehind},
    {58966, kTakenForBehind},
    {2043, kSkims},
    {4591, kSkims},
    {4740, kSkims},
    {7104, kHitsFromAfar},
    {9288, kSkims},
};

// In the sweep: a ray passed by the end of a facet, but not by the run that stands for it. So it
// was neither in front of the one nor behind the other.
constexpr const char* kPassesItsRun = "passes between a facet and the end of its run";
// The part that goes on in front of a far side was measured from facets, or from a run along their
// slope.
constexpr const char* kComesOutOverARun = "comes out over a run that strays from its facets";

// The surface behind was taken from the middle of an edge where the far side is the nearer one.
constexpr const char* kFarIsNearer = "has its far side in front, in the middle of the edge";

constexpr OnceDiffered kSweptSeeds[] = {
    {150, kPassesItsRun},
    {3311, kComesOutOverARun},
    {4997, kComesOutOverARun},
    {3574, kFarIsNearer},
};

class SeedsThatDiffered : public GpuTest, public testing::WithParamInterface<OnceDiffered> {};

TEST_P(SeedsThatDiffered, agreeWithTheOracle) {
  const JudgedSeed judged = judgeSeed(shared<WalkUnderTest>(), GetParam().seed);
  EXPECT_TRUE(judged.agrees()) << judged.text();
}

class SweptSeedsThatDiffered : public testing::TestWithParam<OnceDiffered> {};

TEST_P(SweptSeedsThatDiffered, agreeWithTheOracle) {
  SweepUnderTest sweep;
  const JudgedSeed judged = judgeSweptSeed(sweep, GetParam().seed);
  EXPECT_TRUE(judged.agrees()) << judged.text();
}

std::string nameOf(const testing::TestParamInfo<OnceDiffered>& once) {
  return "seed" + std::to_string(once.param.seed);
}

INSTANTIATE_TEST_SUITE_P(Each, SeedsThatDiffered, testing::ValuesIn(kSeeds), nameOf);
INSTANTIATE_TEST_SUITE_P(Each, SweptSeedsThatDiffered, testing::ValuesIn(kSweptSeeds), nameOf);

}  // namespace
}  // namespace viewloom::seeds_that_differed_test
