// SPDX-License-Identifier: Apache-2.0
#include "lib/preferred_video.h"

#include "lib/channel.h"

namespace viewloom {

void preferVideo(const std::string& server, v1::OpenDisplay& open) {
  if (staysOnMachine(server) || open.display().stereo().tracked()) return;
  open.add_accepted()->set_color(v1::BAND_ENCODING_H264);
  open.add_accepted();  // no color: the usual choice
}

}  // namespace viewloom
