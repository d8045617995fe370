// SPDX-License-Identifier: Apache-2.0
// Moves of a viewer between the rungs of its display, over a real socket and with a clock that is
// turned by hand.
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "unit/publish/paced_readers.h"
#include "unit/web/no_eyes.h"
#include "web/asio.h"
#include "web/http_server.h"

namespace viewloom::test::viewer_places_test {
namespace {

constexpr const char* kRoom = "room";
// encoding={"color":"BAND_ENCODING_H264"}
constexpr const char* kWatchVideo =
    "/ws?stream=room&preset=portrait&width=320&height=240"
    "&encoding=%7B%22color%22%3A%22BAND_ENCODING_H264%22%7D";
// More than the kernel holds of it.
constexpr size_t kAtlasBytes = 400'000;
// A slow browser reads so much from one atlas to the next.
constexpr size_t kSlowBytes = 10'000;
constexpr int kStepsMax = 300;

// Reads when it is told to. Acknowledges all that comes.
class Browser {
 public:
  explicit Browser(uint16_t port) : socket_(io_) {
    tcp::socket& tcp_socket = socket_.next_layer();
    tcp_socket.open(tcp::v4());
    tcp_socket.set_option(net::socket_base::receive_buffer_size(64 << 10));
    tcp_socket.connect({net::ip::make_address("127.0.0.1"), port});
    socket_.handshake("localhost", kWatchVideo);
  }

  // Reads a byte at least. Rung of the atlas that ends with what was read, if one does.
  std::optional<uint32_t> read(size_t bytes_max) {
    socket_.write(net::buffer(std::string(R"({"shown": 1000000})")));
    socket_.read_some(buffer_, bytes_max);
    if (!socket_.is_message_done()) return std::nullopt;
    const std::string message = beast::buffers_to_string(buffer_.data());
    buffer_.clear();
    if (!socket_.got_binary()) throw std::runtime_error(message);
    uint32_t header_bytes = 0;
    std::memcpy(&header_bytes, message.data(), sizeof(header_bytes));
    const auto header = nlohmann::json::parse(message.substr(sizeof(header_bytes), header_bytes));
    return header.at("encoding").at("video_rung").get<uint32_t>();
  }

 private:
  net::io_context io_;
  websocket::stream<tcp::socket> socket_;
  beast::flat_buffer buffer_;
};

class ViewerPlacesTest : public testing::Test {
 protected:
  ViewerPlacesTest() {
    broadcaster_.onDemandChange([this](const std::string&) { serveNewDisplays(); });
    server_.emplace(HttpOptions{}, streams_, broadcaster_, eyes_, metrics_, clock_, access_,
                    [] { return absl::OkStatus(); });
    browser_.emplace(server_->port());
    browser_->read(1);  // of the first atlas: it watches
  }

  std::vector<ActiveDisplayPtr> displays() const { return broadcaster_.displays(kRoom); }

  // Somebody with a fast line at the display of the viewer.
  PacedReader joinBeside() {
    const ActiveDisplayPtr display = displays().front();
    return {.place = join(broadcaster_, kRoom, display->spec, std::make_shared<Watcher>(),
                          display->encoding)};
  }

  // With the lock: the viewer's thread publishes, too.
  void publish(const ActiveDisplay& display) {
    EncodedAtlas atlas;
    atlas.display_id = display.id;
    atlas.sequence = broadcaster_.nextSequence(display.id);
    atlas.layout = layout_;
    atlas.encoding = display.encoding;
    atlas.bands.push_back({.encoding = BandEncoding::kH264, .bytes = bytes_});
    broadcaster_.publish(std::make_shared<EncodedAtlas>(std::move(atlas)));
  }
  void serveNewDisplays() {
    std::lock_guard lock(publish_mutex_);
    for (const ActiveDisplayPtr& display : displays()) {
      if (broadcaster_.newest(display->id) == nullptr) publish(*display);
    }
  }
  void publishAll() {
    std::lock_guard lock(publish_mutex_);
    for (const ActiveDisplayPtr& display : displays()) publish(*display);
  }

  // A tenth of a second in which an atlas of each display comes, and the browser reads little.
  void step(PacedReader& fast) {
    const int64_t now_ns = clock_.nowNs();
    auto bytes = codeAtlases(broadcaster_, kRoom, now_ns, 30'000'000);
    fast.offer(bytes[fast.place->displayId()], now_ns);
    publishAll();
    clock_.advance(kAtlasesApart_ns);
    used_ns_ += kAtlasesApart_ns / 2;
    broadcaster_.remakeStanding(clock_.nowNs());
    browser_->read(kSlowBytes);
  }
  bool movesWithin(int step_count, PacedReader& fast) {
    for (int i = 0; i < step_count && displays().size() == 1; ++i) step(fast);
    return displays().size() == 2;
  }

  // Whether an atlas of this rung comes, while no time passes.
  bool comesOn(uint32_t rung) {
    for (int i = 0; i < kStepsMax; ++i) {
      publishAll();
      if (browser_->read(1 << 16) == rung) return true;
    }
    return false;
  }

  ManualClock clock_;
  int64_t used_ns_ = 0;
  CodingRoom room_{2, [this] { return used_ns_; }};
  Broadcaster broadcaster_{{.display_count_max = 2}, unboundedMemory(), room_};
  std::mutex publish_mutex_;
  const std::shared_ptr<const AtlasLayout> layout_ = std::make_shared<AtlasLayout>();
  const SharedBytes bytes_ = std::make_shared<std::vector<uint8_t>>(kAtlasBytes);
  NoEyes eyes_;
  Metrics metrics_;
  StreamDirectory streams_{clock_, 8};
  AccessControl access_{clock_};
  const std::unique_ptr<StreamDirectory::Claim> claim_ = *streams_.claim(kRoom, "", [] {});
  std::optional<HttpServer> server_;
  std::optional<Browser> browser_;
};

TEST_F(ViewerPlacesTest, areOnTheSecondRungWhereTheLineIsSlowAndOnTheFirstOnceThatHasEnded) {
  PacedReader fast = joinBeside();
  ASSERT_TRUE(movesWithin(kStepsMax, fast));
  EXPECT_TRUE(comesOn(2));
  EXPECT_EQ(metrics_.rung_moves[VideoRung::kSecond].value(), 1);
  const ActiveDisplayPtr second = displays().back();
  EXPECT_EQ(second->encoding.rung, VideoRung::kSecond);
  EXPECT_EQ(displays().front()->subscriber_count, 1u);
  broadcaster_.refuse(second->id, absl::ResourceExhaustedError("planted"));
  EXPECT_TRUE(comesOn(1));
  ASSERT_EQ(displays().size(), 1u);
  EXPECT_EQ(displays().front()->subscriber_count, 2u);
}

TEST_F(ViewerPlacesTest, stayWhereALimitRefusesTheSecondRung) {
  PacedReader fast = joinBeside();
  auto other = join(broadcaster_, "other", quiltOf(2), std::make_shared<Watcher>());
  EXPECT_FALSE(movesWithin(kStepsMax, fast));
  EXPECT_EQ(metrics_.rung_moves[VideoRung::kSecond].value(), 0);
  EXPECT_EQ(displays().front()->subscriber_count, 2u);
  EXPECT_TRUE(comesOn(1));
  other = nullptr;
  EXPECT_TRUE(movesWithin(kStepsMax, fast)) << "it is asked for after a while";
}

}  // namespace
}  // namespace viewloom::test::viewer_places_test
