// SPDX-License-Identifier: Apache-2.0
// Names every function that the public headers declare, so that the library must have all of them.
#include <viewloom/access_token.h>
#include <viewloom/atlas.h>
#include <viewloom/atlas_assembler.h>
#include <viewloom/broken_call.h>
#include <viewloom/byte_pool.h>
#include <viewloom/catalog.h>
#include <viewloom/channel.h>
#include <viewloom/color_decoder.h>
#include <viewloom/color_video.h>
#include <viewloom/compress_frame.h>
#include <viewloom/credentials.h>
#include <viewloom/latency.h>
#include <viewloom/publisher.h>
#include <viewloom/quantise_depth.h>
#include <viewloom/retry_loop.h>
#include <viewloom/server_clock.h>
#include <viewloom/status.h>
#include <viewloom/tls_options.h>
#include <viewloom/watcher.h>
#include <viewloom/wire_frame.h>

#include <iostream>

namespace {

using namespace viewloom;

// The volatile copies keep the compiler from leaving functions out.
template <typename... Functions>
bool areThere(Functions... functions) {
  const auto is_there = [](auto function) {
    volatile auto kept = function;
    return kept != nullptr;
  };
  return (is_there(functions) && ...);
}

bool functionsAreThere() {
  return areThere(&tokenOfEnvironment, &readAccessToken, &isSendableToken, &hasWholePlane,
                  &joinJpegBands, &decodePlane, &placeOfView, &cutView, &explainBrokenCall,
                  &connectionProblem, &makeCredentials, &staysOnMachine, &statusFromGrpc,
                  &isFromServer, &isFromTransport, &predictPlane, &compressFrame, &quantiseDepth,
                  &motionLatency, &makeRandom, &isPassing, &steadyNowNs, &fieldError, &invalidField,
                  &fieldOf, &withFieldPrefix);
}

bool methodsAreThere() {
  return areThere(&Atlas::byteCount, &AtlasAssembler::restart, &AtlasAssembler::add,
                  &BytePool::take, &BytePool::takeAsLeft, &BytePool::takeUncleared,
                  &Catalog::listStreams, &Catalog::listDisplays, &Catalog::listPresets,
                  &Catalog::getServerInfo, &Catalog::adviseSource, &ColorDecoder::decode,
                  &FrameLatency::note, &FrameLatency::standing_s, &Publisher::offer,
                  &Publisher::isWaiting, &Publisher::close, &Publisher::finish, &Publisher::ended,
                  &Publisher::waitEnded, &Publisher::counts, &Backoff::nextDelayNs, &Backoff::reset,
                  &RetryLoop::run, &RetryLoop::sleepUntilStopped, &ServerClock::add,
                  &ServerClock::offset, &Watcher::change, &Watcher::sendEyePoses,
                  &Watcher::probeClock, &Watcher::serverClock, &Watcher::reportPresented,
                  &Watcher::stop, &Watcher::ended, &Watcher::waitEnded, &Watcher::counts);
}

// Nobody listens at this Unix socket.
bool objectsAreMade() {
  const auto channel = makeChannel("unix:nobody");
  const BytePool pool(1);
  AtlasAssembler assembler;
  const Backoff backoff({}, makeRandom());
  const RetryLoop loop({}, {});
  const ColorDecoder decoder;
  Publisher publisher(channel, {.stream = "external"}, {});
  Watcher watcher(channel, v1::OpenDisplay(), {});
  { const ClockFollower follower(watcher); }
  watcher.stop();
  return !Catalog(channel).getServerInfo().ok() && watcher.waitEnded(60'000'000'000);
}

}  // namespace

int main() {
  if (!functionsAreThere() || !methodsAreThere() || !objectsAreMade()) return 1;
  std::cout << "every declaration is there\n";
}
