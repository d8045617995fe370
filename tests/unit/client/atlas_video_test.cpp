// SPDX-License-Identifier: Apache-2.0
#include "recording/atlas_video.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <initializer_list>
#include <iterator>

#include "recording/video_recorder.h"
#include "unit/client/test_files.h"
#include "unit/mp4/box_reader.h"
#include "unit/video/planned_encoder.h"
#include "video/openh264_decoder.h"

namespace viewloom::test::atlas_video_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr int64_t kMs = 1'000'000;
constexpr uint32_t kSide_px = 64;

v1::AtlasLayout layoutOf(const std::string& suffix = "_qs2x1a1") {
  v1::AtlasLayout layout;
  layout.mutable_size()->set_width(kSide_px);
  layout.mutable_size()->set_height(kSide_px);
  layout.mutable_tile_size()->set_width(kSide_px / 2);
  layout.mutable_tile_size()->set_height(kSide_px);
  layout.set_columns(2);
  layout.set_rows(1);
  layout.set_view_count(2);
  layout.set_aspect(1);
  layout.set_suffix(suffix);
  layout.mutable_encoding()->set_color(v1::BAND_ENCODING_RAW);
  return layout;
}

// Both views grey: the left one `level`, the right one 255 - level.
Atlas atlasOf(uint8_t level, int64_t shown_time_ns, const v1::AtlasLayout& layout = layoutOf()) {
  Atlas atlas;
  atlas.layout = std::make_shared<const v1::AtlasLayout>(layout);
  atlas.header.set_shown_time_ns(shown_time_ns);
  std::string row(size_t{3} * kSide_px / 2, char(level));
  row.append(row.size(), char(255 - level));
  std::string rows;
  for (uint32_t y = 0; y < kSide_px; ++y) rows += row;
  atlas.bands.push_back({.row_count = kSide_px, .encoding = v1::BAND_ENCODING_RAW, .bytes = rows});
  return atlas;
}

class AtlasVideoTest : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_.path() / name; }
  std::unique_ptr<AtlasVideo> create() const {
    auto video = AtlasVideo::create(path("clip.mp4"), "demo");
    EXPECT_TRUE(video.ok()) << video.status();
    return *std::move(video);
  }
  static std::vector<uint8_t> bytesOf(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  size_t fileCount() const {
    return size_t(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
  }

  files::TestFolder folder_;
};

TEST_F(AtlasVideoTest, holdsTheAtlasesAtTheTimesOfTheirFrames) {
  const auto video = create();
  for (int i = 0; i < 4; ++i) {
    const absl::Status added =
        video->add(atlasOf(uint8_t(20 * i), 5'000 * kMs + i * 40 * kMs), 100 * kMs + i * 45 * kMs);
    ASSERT_TRUE(added.ok()) << added;
  }
  const absl::Status completed = video->complete(300 * kMs);
  ASSERT_TRUE(completed.ok()) << completed;
  EXPECT_THAT(video->summary(), HasSubstr("clip_qs2x1a1.mp4: 4 pictures of 64x64 px in 0.2 s"));

  const std::vector<uint8_t> bytes = bytesOf(path("clip_qs2x1a1.mp4"));
  EXPECT_EQ(fileCount(), 1U);
  EXPECT_EQ(tagOf(bytes, "\xA9nam"), "demo");
  EXPECT_EQ(tagOf(bytes,
                  "\xA9"
                  "cmt"),
            R"({"LKGNumViews":2,"LKGRows":1,"LKGColumns":2,"LKGAspect":1,"LKGType":"quilt"})");
  const std::vector<ReadSample> samples = samplesOf(bytes);
  ASSERT_EQ(samples.size(), 4U);
  const auto decoder = *OpenH264Decoder::make();
  for (size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].begin_ticks, i * 3600);
    const auto sample = std::span(bytes).subspan(samples[i].offset, samples[i].size);
    const auto picture =
        decoder->decode(annexB(sample, i == 0 ? setsOf(bytes) : std::vector<Bytes>()), {64, 64});
    ASSERT_TRUE(picture.ok()) << picture.status();
    EXPECT_NEAR(picture->y[5], 20 * int(i), 2);
    EXPECT_NEAR(picture->y[60], 255 - 20 * int(i), 2);
  }
}

TEST_F(AtlasVideoTest, takesANameThatSaysTheLayoutAsItIs) {
  const auto video = AtlasVideo::create(path("clip_qs2x1a1.mp4"), "demo");
  ASSERT_TRUE(video.ok());
  ASSERT_TRUE((*video)->add(atlasOf(0, 0), 0).ok());
  ASSERT_TRUE((*video)->complete(kMs).ok());
  EXPECT_TRUE(fs::exists(path("clip_qs2x1a1.mp4")));
}

TEST_F(AtlasVideoTest, refusesTargetsThatCannotBeWritten) {
  const auto refusal = [](const fs::path& path) {
    const auto video = AtlasVideo::create(path, "demo");
    EXPECT_EQ(video.status().code(), absl::StatusCode::kInvalidArgument) << path;
    return std::string(video.status().message());
  };
  EXPECT_THAT(refusal(path("clip.mkv")), HasSubstr("accepted is a name that ends in .mp4"));
  EXPECT_THAT(refusal(path("none/clip.mp4")), HasSubstr("its folder must exist"));
  fs::create_directory(path("folder.mp4"));
  EXPECT_THAT(refusal(path("folder.mp4")), HasSubstr("is a folder"));
}

TEST_F(AtlasVideoTest, refusesDisplaysThatAreForNoPlayer) {
  v1::AtlasLayout panel = layoutOf("");
  panel.set_view_cone_rad(0.7);
  v1::AtlasLayout depth = layoutOf("");
  depth.mutable_depth_codes()->set_bits(8);
  v1::AtlasLayout images = layoutOf("");
  images.set_image_count(2);
  v1::AtlasLayout elsewhere = layoutOf("/../../etc");
  for (const v1::AtlasLayout& layout : {panel, depth, images, elsewhere}) {
    const auto video = create();
    EXPECT_EQ(video->add(atlasOf(0, 0, layout), 0).code(), absl::StatusCode::kFailedPrecondition);
    EXPECT_FALSE(video->complete(0).ok());
    EXPECT_EQ(fileCount(), 0U);
  }
}

TEST_F(AtlasVideoTest, refusesLayoutsThatDoNotHoldTheirViews) {
  const auto refusal = [this](const std::function<void(v1::AtlasLayout&)>& spoil) {
    v1::AtlasLayout layout = layoutOf();
    spoil(layout);
    return create()->add(atlasOf(0, 0, layout), 0);
  };
  for (const auto& spoil : std::initializer_list<std::function<void(v1::AtlasLayout&)>>{
           [](auto& l) { l.mutable_tile_size()->set_width(kSide_px); },
           [](auto& l) { l.set_rows(2); }, [](auto& l) { l.set_padding_top_px(1); },
           [](auto& l) { l.mutable_tile_size()->set_height(0); },
           [](auto& l) { l.set_columns(0x8000'0001); },
           [](auto& l) { l.set_padding_top_px(0xffff'ffff); }}) {
    const absl::Status refused = refusal(spoil);
    EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument) << refused;
    EXPECT_THAT(std::string(refused.message()), HasSubstr("an atlas of 64x64 px does not hold"));
  }
  EXPECT_EQ(fileCount(), 0U);
}

TEST_F(AtlasVideoTest, refusesALaterLayoutThatIsForNoPlayer) {
  const auto video = create();
  ASSERT_TRUE(video->add(atlasOf(0, 0), 0).ok());
  v1::AtlasLayout images = layoutOf();
  images.set_image_count(2);
  const absl::Status refused = video->add(atlasOf(0, 40 * kMs, images), 40 * kMs);
  EXPECT_THAT(std::string(refused.message()), HasSubstr("several images"));
  ASSERT_TRUE(video->complete(80 * kMs).ok()) << "what came before is kept";
}

TEST_F(AtlasVideoTest, endsWhereTheSizeChanges) {
  const auto video = create();
  ASSERT_TRUE(video->add(atlasOf(0, 0), 0).ok());
  v1::AtlasLayout other = layoutOf();
  other.set_columns(1);
  const absl::Status refused = video->add(atlasOf(0, 40 * kMs, other), 40 * kMs);
  EXPECT_THAT(std::string(refused.message()), HasSubstr("the atlases have changed"));
  ASSERT_TRUE(video->complete(80 * kMs).ok()) << "what came before is kept";
  EXPECT_EQ(samplesOf(bytesOf(path("clip_qs2x1a1.mp4"))).size(), 1U);
}

TEST_F(AtlasVideoTest, keepsWhatCameBeforeItsEncoderFailed) {
  // Each encoder fails at its fourth picture. The second one does so too soon.
  const auto encoders = std::make_shared<const VideoEncoderChoice>(
      plannedKind("planned", failingFrom(3)), std::vector<EncoderProbe>());
  const auto video = *AtlasVideo::create(path("clip.mp4"), "demo", encoders);
  for (int i = 0; i < 6; ++i) {
    const absl::Status added = video->add(atlasOf(uint8_t(20 * i), i * 40 * kMs), i * 40 * kMs);
    ASSERT_TRUE(added.ok()) << i << ": " << added;
  }
  const absl::Status failed = video->add(atlasOf(200, 240 * kMs), 240 * kMs);
  EXPECT_EQ(failed.code(), absl::StatusCode::kInternal);
  EXPECT_THAT(std::string(failed.message()),
              HasSubstr("clip_qs2x1a1.mp4: the video encoder planned has failed twice: the device "
                        "is lost; the video ends here and keeps what came before"));
  ASSERT_TRUE(video->complete(280 * kMs).ok());
  const std::vector<uint8_t> bytes = bytesOf(path("clip_qs2x1a1.mp4"));
  const std::vector<ReadSample> samples = samplesOf(bytes);
  ASSERT_EQ(samples.size(), 6U);
  const auto decoder = *OpenH264Decoder::make();
  for (size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].is_sync, i % 3 == 0);
    const auto sample = std::span(bytes).subspan(samples[i].offset, samples[i].size);
    const auto picture = decoder->decode(
        annexB(sample, samples[i].is_sync ? setsOf(bytes) : std::vector<Bytes>()), {64, 64});
    ASSERT_TRUE(picture.ok()) << picture.status();
    EXPECT_NEAR(picture->y[5], 20 * int(i), 2);
  }
}

TEST_F(AtlasVideoTest, recordsTheMessagesOfASubscriber) {
  const SteadyClock clock;
  const auto recorder = VideoRecorder::create(path("clip.mp4"), "demo", clock);
  ASSERT_TRUE(recorder.ok()) << recorder.status();
  const Atlas atlas = atlasOf(90, 0);
  v1::StreamAtlasesResponse layout;
  *layout.mutable_layout() = *atlas.layout;
  v1::StreamAtlasesResponse header;
  header.mutable_header()->set_sequence(1);
  header.mutable_header()->set_band_count(1);
  v1::StreamAtlasesResponse band;
  band.mutable_band()->set_sequence(1);
  band.mutable_band()->set_plane(v1::ATLAS_PLANE_COLOR);
  band.mutable_band()->set_encoding(v1::BAND_ENCODING_RAW);
  band.mutable_band()->set_row_count(kSide_px);
  band.mutable_band()->set_last_piece(true);
  band.mutable_band()->set_data(atlas.bands.front().bytes);
  v1::StreamAtlasesResponse end;
  end.mutable_end()->set_sequence(1);
  for (const auto* message : {&layout, &header, &band}) {
    ASSERT_TRUE((*recorder)->add(*message).ok());
  }
  EXPECT_TRUE((*recorder)->isWithinAtlas());
  ASSERT_TRUE((*recorder)->add(end).ok());
  EXPECT_FALSE((*recorder)->isWithinAtlas());
  ASSERT_TRUE((*recorder)->complete().ok());
  EXPECT_THAT((*recorder)->summary(), HasSubstr("1 picture of 64x64 px"));
  EXPECT_EQ(samplesOf(bytesOf(path("clip_qs2x1a1.mp4"))).size(), 1U);
}

}  // namespace
}  // namespace viewloom::test::atlas_video_test
