// SPDX-License-Identifier: Apache-2.0
#include "mp4/movie_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include "unit/mp4/box_reader.h"
#include "unit/mp4/coded_movie.h"
#include "video/openh264_decoder.h"

namespace viewloom::test::movie_file_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr int64_t kMs = 1'000'000;

std::vector<uint8_t> bytesOf(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class MovieFileTest : public testing::Test {
 protected:
  MovieFileTest() {
    folder_ = testing::TempDir() + "movie-" + std::to_string(getpid());
    fs::create_directory(folder_);
  }
  ~MovieFileTest() override { fs::remove_all(folder_); }

  fs::path path() const { return folder_ / "demo.mp4"; }
  std::unique_ptr<MovieFile> create() const {
    auto file = MovieFile::create(path(), {.title = "demo"});
    EXPECT_TRUE(file.ok()) << file.status();
    return *std::move(file);
  }

  fs::path folder_;
};

TEST_F(MovieFileTest, holdsEveryPictureAtItsTime) {
  const auto file = create();
  const std::vector<std::vector<uint8_t>> units = codedMovie(6, 4);
  const int64_t times_ns[] = {0, 33 * kMs, 66 * kMs, 1000 * kMs, 1001 * kMs, 1050 * kMs};
  for (size_t i = 0; i < units.size(); ++i) {
    const absl::Status added = file->add(units[i], times_ns[i]);
    ASSERT_TRUE(added.ok()) << added;
  }
  EXPECT_FALSE(fs::exists(path())) << "not before it is complete";
  const absl::Status completed = file->complete(2000 * kMs);
  ASSERT_TRUE(completed.ok()) << completed;

  const std::vector<uint8_t> bytes = bytesOf(path());
  const std::vector<ReadSample> samples = samplesOf(bytes);
  ASSERT_EQ(samples.size(), units.size());
  auto decoder = OpenH264Decoder::make();
  ASSERT_TRUE(decoder.ok());
  for (size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].begin_ticks, uint64_t(times_ns[i]) * 9 / 100'000);
    EXPECT_EQ(samples[i].is_sync, i % 4 == 0);
    const auto sample = std::span(bytes).subspan(samples[i].offset, samples[i].size);
    const std::vector<Bytes> sets = samples[i].is_sync ? setsOf(bytes) : std::vector<Bytes>();
    const auto picture = (*decoder)->decode(annexB(sample, sets), kMovieSize_px);
    ASSERT_TRUE(picture.ok()) << picture.status();
    EXPECT_GT(psnrOfLuma(*picture, SamplePicture::texture(kMovieSize_px, 2 * double(i)).video()),
              38);
  }
  EXPECT_EQ(samples.back().begin_ticks + samples.back().duration_ticks, 180'000U);
  EXPECT_EQ(boxesOf(bytes).back().type, "mdat");
  EXPECT_EQ(boxesOf(bytes).back().content_begin, samples.front().offset);
}

TEST_F(MovieFileTest, leavesNothingBehindWithoutItsEnd) {
  std::ofstream(path()) << "older";
  {
    const auto file = create();
    ASSERT_TRUE(file->add(codedMovie(1, 1).front(), 0).ok());
    EXPECT_TRUE(fs::exists(path().string() + ".part"));
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
  EXPECT_THAT(bytesOf(path()), testing::ElementsAre('o', 'l', 'd', 'e', 'r'));
}

TEST_F(MovieFileTest, isNotWrittenWithoutPictures) {
  const auto file = create();
  EXPECT_EQ(file->complete(0).code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_FALSE(fs::exists(path()));
}

TEST_F(MovieFileTest, refusesTargetsThatCannotBeWritten) {
  fs::create_directory(path());
  const auto folder = MovieFile::create(path(), {});
  EXPECT_EQ(folder.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(folder.status().message()), HasSubstr("is a folder"));
  const auto nowhere = MovieFile::create(folder_ / "none" / "demo.mp4", {});
  EXPECT_THAT(std::string(nowhere.status().message()), HasSubstr("its folder must exist"));
}

TEST_F(MovieFileTest, leavesOutBytesThatDoNotBelongToIt) {
  const auto file = create();
  const std::vector<std::vector<uint8_t>> units = codedMovie(2, 2);
  EXPECT_FALSE(file->add(units[1], 0).ok()) << "the first picture needs its parameter sets";
  ASSERT_TRUE(file->add(units[0], 0).ok());
  EXPECT_FALSE(file->add({}, 10 * kMs).ok());
  ASSERT_TRUE(file->add(units[1], 20 * kMs).ok());
  ASSERT_TRUE(file->complete(30 * kMs).ok());
  EXPECT_EQ(samplesOf(bytesOf(path())).size(), 2U);
}

TEST_F(MovieFileTest, keepsWhatFitsOnAFullDisk) {
  const std::vector<std::vector<uint8_t>> units = codedMovie(12, 3);
  uint64_t all_bytes = 0;
  for (const auto& unit : units) all_bytes += unit.size();
  signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto file = create();
  rlimit small = before;
  small.rlim_cur = all_bytes;  // the index does not fit beside all pictures
  setrlimit(RLIMIT_FSIZE, &small);
  for (size_t i = 0; i < units.size(); ++i) (void)file->add(units[i], int64_t(i) * 100 * kMs);
  const absl::Status completed = file->complete(1200 * kMs);
  setrlimit(RLIMIT_FSIZE, &before);
  ASSERT_TRUE(completed.ok()) << completed;
  const std::vector<uint8_t> bytes = bytesOf(path());
  const std::vector<ReadSample> samples = samplesOf(bytes);
  EXPECT_GE(samples.size(), 3U);
  EXPECT_LT(samples.size(), units.size());
  EXPECT_EQ(samples.back().offset + samples.back().size, bytes.size());
}

}  // namespace
}  // namespace viewloom::test::movie_file_test
