// SPDX-License-Identifier: Apache-2.0
// A client's side of StreamAtlases: puts atlases together and checks the order of the messages.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include "viewloom/v1/display_service.grpc.pb.h"

namespace viewloom {

// 2x1 tiles of 8x8 px, RAW colour.
v1::OpenDisplay smallQuilt(const std::string& stream);

struct ReceivedAtlas {
  v1::AtlasHeader header;
  std::map<uint32_t, std::string> color_bands;  // by first row
  std::optional<v1::AtlasLayout> layout;        // when a new one came before it
  uint64_t skipped_count = 0;                   // said to have been skipped before it
  size_t piece_count = 0;
  size_t abandoned_count = 0;  // begun and abandoned before it
  v1::AtlasEnd end;
};

// Every wait ends after a minute at the latest: the call then fails. Thread-safety: none.
class TestWatcher {
 public:
  explicit TestWatcher(const std::shared_ptr<grpc::Channel>& channel);
  TestWatcher(const std::shared_ptr<grpc::Channel>& channel, const v1::OpenDisplay& open);
  ~TestWatcher();

  bool send(const v1::StreamAtlasesRequest& request) { return call_->Write(request); }
  void halfClose() { call_->WritesDone(); }
  // The next message, unchecked; empty when the call is over.
  std::optional<v1::StreamAtlasesResponse> readMessage();
  // The next whole atlas, its messages checked; empty when the call is over before its end.
  std::optional<ReceivedAtlas> readAtlas();
  // Reads what is left and returns how the call ended.
  grpc::Status finish();
  void cancel() { context_.TryCancel(); }

 private:
  void checkBand(const v1::Band& band, ReceivedAtlas& atlas);

  std::unique_ptr<v1::DisplayService::Stub> stub_;
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReaderWriter<v1::StreamAtlasesRequest, v1::StreamAtlasesResponse>>
      call_;
  bool finished_ = false;
};

}  // namespace viewloom
