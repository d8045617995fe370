// SPDX-License-Identifier: Apache-2.0
// A publisher's side of PublishFrames, message by message, with frames of 4x4 px.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include "viewloom/v1/ingest_service.grpc.pb.h"

namespace viewloom {

// One layer of RGB8 colour and binary32 depth.
v1::FrameHeader smallHeader(uint64_t number);
v1::FrameChunk chunkOf(uint32_t plane_index, uint64_t offset_bytes, std::string data);

// Every wait ends after a minute at the latest: the call then fails. Thread-safety: none.
class TestPublisher {
 public:
  explicit TestPublisher(const std::shared_ptr<grpc::Channel>& channel);
  // Opens the stream and reads `accepted`.
  TestPublisher(const std::shared_ptr<grpc::Channel>& channel, const std::string& stream,
                const std::string& session_id = "");
  ~TestPublisher();

  bool send(const v1::PublishFramesRequest& request) { return call_->Write(request); }
  bool sendSettings(const std::string& stream, const std::string& session_id = "");
  bool sendHeader(const v1::FrameHeader& header);
  bool sendChunk(const v1::FrameChunk& chunk);
  // A whole small frame.
  bool sendFrame(uint64_t number);
  // Empty when the call is over.
  std::optional<v1::PublishFramesResponse> read();
  // The next report, other messages skipped.
  std::optional<v1::FrameReport> readReport();
  // The next word on what displays want, other messages skipped.
  std::optional<v1::Wanted> readWanted();
  void halfClose() { call_->WritesDone(); }
  // Reads what is left and returns how the call ended.
  grpc::Status finish();
  void cancel() { context_.TryCancel(); }

 private:
  std::unique_ptr<v1::IngestService::Stub> stub_;
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReaderWriter<v1::PublishFramesRequest, v1::PublishFramesResponse>>
      call_;
  bool finished_ = false;
};

}  // namespace viewloom
