// SPDX-License-Identifier: Apache-2.0
// Lets a server on another machine send video to a viewer.
#pragma once

#include <string>

#include "viewloom/v1/display_service.pb.h"

namespace viewloom {

// If the server is not on this machine (staysOnMachine) and the encoding of `open` leaves colour
// open, displays of views come as H.264, and others as the server usually sends them. Tracked
// displays keep that, too: two eyes have little in common that video could use.
void preferVideo(const std::string& server, v1::OpenDisplay& open);

}  // namespace viewloom
