// SPDX-License-Identifier: Apache-2.0
#include "base/send_queue.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

namespace viewloom {

void limitSendQueue(int fd) {
  const auto bytes = static_cast<int>(kUnsentBytesMax);
  setsockopt(fd, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &bytes, sizeof bytes);
}

}  // namespace viewloom
