// SPDX-License-Identifier: Apache-2.0
#include "base/send_queue.h"

#include <fcntl.h>
#include <linux/sockios.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <vector>

#include <gtest/gtest.h>

#include "support/loopback.h"

namespace viewloom::send_queue_test {
namespace {

// Two ends of a connection over loopback.
class Ends {
 public:
  Ends() {
    const int listener = test::listenAnywhere();
    EXPECT_TRUE(test::connectTo(reader_, test::portIn(test::addressOf(listener))));
    writer = accept4(listener, nullptr, nullptr, SOCK_NONBLOCK);
    close(listener);
  }
  ~Ends() {
    close(reader_);
    close(writer);
  }
  Ends(const Ends&) = delete;
  Ends& operator=(const Ends&) = delete;

  // Unsent bytes in the writer's kernel once it takes no more. Nobody reads.
  int waitingBytes() const {
    const std::vector<char> bytes(64 << 10);
    while (send(writer, bytes.data(), bytes.size(), MSG_NOSIGNAL) > 0) {
    }
    int waiting_bytes = 0;
    EXPECT_EQ(ioctl(writer, SIOCOUTQNSD, &waiting_bytes), 0);
    return waiting_bytes;
  }

  int writer = -1;

 private:
  const int reader_ = socket(AF_INET, SOCK_STREAM, 0);
};

TEST(SendQueue, isShortForAClientThatNeverReads) {
  const Ends ends;
  limitSendQueue(ends.writer);
  const int waiting_bytes = ends.waitingBytes();
  EXPECT_GT(waiting_bytes, 0);
  EXPECT_LE(waiting_bytes, int{kSendQueueBytes});
}

// Otherwise the test above would show nothing.
TEST(SendQueue, isLongWithoutALimit) {
  const Ends ends;
  EXPECT_GT(ends.waitingBytes(), int{kSendQueueBytes});
}

TEST(SendQueue, leavesOtherSocketsAlone) {
  int pair[2] = {-1, -1};
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, pair), 0);
  limitSendQueue(pair[0]);
  EXPECT_EQ(write(pair[0], "x", 1), 1);
  close(pair[0]);
  close(pair[1]);
}

}  // namespace
}  // namespace viewloom::send_queue_test
