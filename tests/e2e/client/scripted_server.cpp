// SPDX-License-Identifier: Apache-2.0
#include "e2e/client/scripted_server.h"

#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace viewloom {

ScriptedServer::ScriptedServer(Script<PublishStream> publish, Script<WatchStream> watch)
    : publish_(std::move(publish)), watch_(std::move(watch)) {
  folder_ = (std::filesystem::temp_directory_path() / "viewloom_XXXXXX").string();
  if (mkdtemp(folder_.data()) == nullptr) throw std::runtime_error("no temporary folder");
  address_ = "unix:" + folder_ + "/server";
  start();
}

ScriptedServer::~ScriptedServer() {
  stop();
  std::filesystem::remove_all(folder_);
}

void ScriptedServer::start() {
  grpc::ServerBuilder builder;
  builder.AddListeningPort(address_, grpc::InsecureServerCredentials());
  builder.RegisterService(static_cast<v1::IngestService::Service*>(this));
  builder.RegisterService(static_cast<v1::DisplayService::Service*>(this));
  server_ = builder.BuildAndStart();
  if (server_ == nullptr) throw std::runtime_error("cannot listen at " + address_);
}

void ScriptedServer::stop() {
  if (server_ == nullptr) return;
  server_->Shutdown(std::chrono::system_clock::now());
  server_->Wait();
  server_.reset();
}

grpc::Status ScriptedServer::PublishFrames(grpc::ServerContext* /*context*/,
                                           PublishStream* stream) {
  return publish_(*stream, ++publish_calls_);
}

grpc::Status ScriptedServer::StreamAtlases(grpc::ServerContext* /*context*/, WatchStream* stream) {
  return watch_(*stream, ++watch_calls_);
}

}  // namespace viewloom
