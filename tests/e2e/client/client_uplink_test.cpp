// SPDX-License-Identifier: Apache-2.0
// Predicted depth, recordings and their replay through a real viewloomd.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "e2e/client/with_viewloomd.h"
#include "recording/atlas_recording.h"
#include "recording/frame_recording.h"

namespace viewloom::client_uplink_test {
namespace {

namespace fs = std::filesystem;
using test::kLong_ns;
using test::runCommand;
using test::smallFrame;
using testing::HasSubstr;
using testing::Not;

std::string textOf(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

class Uplink : public test::WithViewloomd {
 protected:
  // Runs `viewloom <arguments>`; what it says is in said().
  int run(const std::string& arguments) const {
    return runCommand(command(arguments) + " 2> " + (folder_ / "said").string());
  }
  // Interrupts `viewloom <arguments>` once it has put so many bytes into a recording.
  int runUntilRecorded(const std::string& arguments, const fs::path& file, size_t bytes) const {
    return runCommand(command(arguments) + " 2> " + (folder_ / "said").string() +
                      " & pid=$!; until [ $(stat -c %s " + file.string() +
                      ".part 2>/dev/null || echo 0) -gt " + std::to_string(bytes) +
                      " ]; do sleep 0.02; kill -0 $pid || exit 99; done; "
                      "kill -INT $pid; wait $pid");
  }
  std::string said() const { return textOf(folder_ / "said"); }
  fs::path file(const std::string& name) const { return folder_ / name; }

  static std::vector<RecordedFrame> framesOf(const fs::path& file) {
    std::vector<RecordedFrame> frames;
    const auto reader = FrameRecordingReader::open(file);
    EXPECT_TRUE(reader.ok()) << reader.status();
    for (;;) {
      auto frame = (*reader)->next();
      EXPECT_TRUE(frame.ok()) << frame.status();
      if (!frame.ok() || !frame->has_value()) break;
      frames.push_back(**std::move(frame));
    }
    EXPECT_FALSE((*reader)->isCutShort());
    return frames;
  }

 private:
  std::string command(const std::string& arguments) const {
    return std::string(VIEWLOOM) + " --server " + address_ + " " + arguments;
  }
};

TEST_F(Uplink, hasItsStepMeasuredByTheServer) {
  std::vector<Atlas> atlases;
  const auto watcher = watch(1, [&](const Atlas& atlas) { atlases.push_back(atlas); });
  QuantisedDepth depth;
  PublisherCallbacks callbacks;
  callbacks.on_sent = [&](const CompressedFrame& sent) { depth = sent.depth.at(0); };
  const auto publisher = publish(callbacks, true);
  publisher->offer(smallFrame(0));
  ASSERT_TRUE(watcher->waitEnded(kLong_ns));
  ASSERT_EQ(publisher->finish(kLong_ns), absl::OkStatus());
  ASSERT_EQ(atlases.size(), 1U);
  ASSERT_GT(depth.step, 0);
  EXPECT_NEAR(atlases[0].header.stats().depth_step(), depth.step, 0.05 * depth.step);
}

TEST_F(Uplink, isChosenByTheCommandAndSaysItsStep) {
  const std::string publish = "publish --synthetic --size 64x36 --seconds 0.2 -q";
  EXPECT_EQ(run(publish + " --depth-encoding predicted"), 0);
  EXPECT_THAT(said(), HasSubstr("depth is sent as 16-bit inverse depth in steps of "));
  EXPECT_EQ(run(publish), 0) << "auto: a socket stays on this machine";
  EXPECT_THAT(said(), Not(HasSubstr("16-bit")));
  EXPECT_EQ(run(publish + " --depth-encoding finest"), 2);
}

TEST_F(Uplink, sendsColorAsVideoIfAskedTo) {
  const std::string publish = "publish --synthetic --layers 2 --size 321x181 --seconds 0.2 -q ";
  const fs::path recording = file("video.vlr");
  EXPECT_EQ(run(publish + "--color-encoding video --record " + recording.string()), 0) << said();
  EXPECT_THAT(said(), HasSubstr("colour is sent as video"));
  for (const RecordedFrame& recorded : framesOf(recording)) {
    for (const v1::Layer& layer : recorded.frame.header.sources(0).layers()) {
      EXPECT_EQ(layer.planes(0).encoding(), v1::PLANE_ENCODING_H264);
      EXPECT_EQ(layer.planes(1).encoding(), v1::PLANE_ENCODING_DEPTH_F32);
    }
  }
  const fs::path replayed = file("replayed.vlr");
  ASSERT_EQ(run("publish --replay " + recording.string() + " -q --record " + replayed.string()), 0)
      << said();
  EXPECT_EQ(*framesOf(replayed).at(0).frame.planes.at(0),
            *framesOf(recording).at(0).frame.planes.at(0));
  EXPECT_EQ(run(publish), 0) << "auto: a socket stays on this machine";
  EXPECT_THAT(said(), Not(HasSubstr("video")));
  EXPECT_EQ(run(publish + "--color-encoding finest"), 2);
  EXPECT_EQ(run(publish + "--color-encoding video --color-qp 19"), 2);
}

TEST_F(Uplink, replaysTheBytesOfRecordedFramesAndTheirTimes) {
  const fs::path first = file("first.vlr");
  const fs::path second = file("second.vlr");
  ASSERT_EQ(run("publish --synthetic --size 64x36 --seconds 0.5 --fps 20 -q --zstd 1 "
                "--depth-encoding predicted --record " +
                first.string()),
            0);
  EXPECT_THAT(said(), HasSubstr("frames recorded"));
  ASSERT_EQ(run("publish --stream t --replay " + first.string() + " --speed 4 -q --record " +
                second.string()),
            0)
      << said();
  const std::vector<RecordedFrame> were = framesOf(first);
  const std::vector<RecordedFrame> are = framesOf(second);
  ASSERT_GT(were.size(), 2U);
  ASSERT_EQ(are.size(), were.size());
  for (size_t i = 0; i < are.size(); ++i) {
    v1::FrameHeader was = were[i].frame.header;
    const v1::FrameHeader& is = are[i].frame.header;
    ASSERT_EQ(are[i].frame.planes.size(), were[i].frame.planes.size());
    for (size_t p = 0; p < are[i].frame.planes.size(); ++p) {
      EXPECT_EQ(*are[i].frame.planes[p], *were[i].frame.planes[p]);
    }
    EXPECT_EQ(is.number(), i + 1);
    const int64_t was_since_ns = was.capture_time_ns() - were[0].frame.header.capture_time_ns();
    const int64_t is_since_ns = is.capture_time_ns() - are[0].frame.header.capture_time_ns();
    EXPECT_EQ(is_since_ns, was_since_ns / 4);
    was.set_number(is.number());
    was.set_capture_time_ns(is.capture_time_ns());
    EXPECT_EQ(is.SerializeAsString(), was.SerializeAsString());
  }
}

TEST_F(Uplink, recordsAtlasesThatAreWatchedLikeThoseOfAStream) {
  const auto publisher = publish();
  publisher->offer(smallFrame(0));
  const std::string display = " --columns 2 --rows 2 --size 96x64 -q ";
  const fs::path recording = file("kept.vlr");
  ASSERT_EQ(run("record s --count 1" + display + "--out " + recording.string()), 0) << said();
  EXPECT_THAT(said(), HasSubstr("kept.vlr: 1 atlas recorded"));
  ASSERT_EQ(run("watch s --count 1" + display + "--out " + file("live").string()), 0) << said();
  ASSERT_EQ(run("watch --from " + recording.string() + " --out " + file("from").string()), 0)
      << said();
  EXPECT_THAT(said(), HasSubstr("kept.vlr: 1 atlas in 0.0 s, 96x64, 4 views of 48x32"));
  const fs::path replayed = file("from") / "kept_000001_000001_qs2x2a1.5.jpg";
  EXPECT_EQ(textOf(replayed), textOf(fs::directory_iterator(file("live"))->path()));
  EXPECT_GT(fs::file_size(replayed), 500U);
}

TEST_F(Uplink, completesRecordingsWhenInterrupted) {
  const auto publisher = publish();
  publisher->offer(smallFrame(0));
  const fs::path atlases = file("atlases.vlr");
  EXPECT_EQ(
      runUntilRecorded("record s --columns 2 --rows 2 --size 96x64 -q --out " + atlases.string(),
                       atlases, 1000),
      0)
      << said();
  const auto reader = AtlasRecordingReader::open(atlases);
  ASSERT_TRUE(reader.ok()) << reader.status();
  EXPECT_TRUE((*reader)->next()->has_value());
  EXPECT_FALSE((*reader)->next()->has_value());
  EXPECT_FALSE((*reader)->isCutShort());

  const fs::path frames = file("frames.vlr");
  EXPECT_EQ(
      runUntilRecorded("publish --stream t --synthetic --size 64x36 -q --record " + frames.string(),
                       frames, 50'000),
      0)
      << said();
  EXPECT_GE(framesOf(frames).size(), 1U);
  EXPECT_FALSE(fs::exists(frames.string() + ".part"));
}

TEST_F(Uplink, saysWhatIsWrongWithRecordings) {
  const auto publisher = publish();
  publisher->offer(smallFrame(0));
  const fs::path recording = file("a.vlr");
  ASSERT_EQ(
      run("record s --count 1 --columns 2 --rows 2 --size 96x64 -q --out " + recording.string()),
      0);
  const struct {
    std::string arguments;
    const char* reason;
  } cases[] = {
      {"publish --replay " + recording.string(), "is a recording of atlases"},
      {"publish --replay " + file("none.vlr").string(), "none.vlr: no such file"},
      {"publish --replay " + std::string(VIEWLOOM), "is no recording"},
      {"publish --synthetic --speed 2", "--speed"},
      {"publish --replay " + recording.string() + " --record " + recording.string(),
       "this file is being replayed"},
      {"publish --synthetic --record " + file("no/where.vlr").string(), "cannot be written"},
      {"record s --out " + file("no/where.vlr").string(), "cannot be written"},
      {"watch --from " + file("none.vlr").string(), "none.vlr: no such file"}};
  for (const auto& bad : cases) {
    EXPECT_EQ(run(bad.arguments), 2) << bad.arguments;
    EXPECT_THAT(said(), HasSubstr(bad.reason));
  }
  EXPECT_EQ(run("record none --no-wait -q --out " + file("b.vlr").string()), 1);
  EXPECT_FALSE(fs::exists(file("b.vlr")));
  EXPECT_FALSE(fs::exists(file("b.vlr.part")));
}

}  // namespace
}  // namespace viewloom::client_uplink_test
