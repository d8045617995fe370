// SPDX-License-Identifier: Apache-2.0
// Motion JPEG: atlases as the parts of one endless reply.
#pragma once

#include <string>

#include "web/live_stream.h"

namespace viewloom {

inline constexpr const char* kMultipartType = "multipart/x-mixed-replace; boundary=viewloom";

// multipart/x-mixed-replace: each part is one whole JPEG. Players show a part when they have read
// the header of the next one, so that header goes out with the part before it. A picture that
// stands is repeated. The end is the last picture once more, and the closing boundary.
class MultipartStream final : public LiveStream {
 public:
  using LiveStream::LiveStream;

 private:
  net::awaitable<void> writeAtlases(ErrorCode& error) override;
  net::awaitable<void> writeEnd(ErrorCode& error) override;
  // Writes the shown part and its end.
  net::awaitable<void> writePart(std::string end, ErrorCode& error);
  net::awaitable<void> writeText(std::string text, ErrorCode& error);

  AtlasPtr shown_;  // by the part that was written last
};

}  // namespace viewloom
