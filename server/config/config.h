// SPDX-License-Identifier: Apache-2.0
// The settings of viewloomd, typed, with their defaults. config/settings.cpp holds key, unit, help
// text and range of each. deploy/viewloomd.example.toml and deploy/settings.md explain them.
#pragma once

#include <cstdint>
#include <string>

namespace viewloom {

struct GrpcConfig {
  std::string address = "127.0.0.1:50051";
  uint32_t keepalive_s = 10;
  uint32_t unread_s = 60;  // in which a client takes at least one message
  uint32_t connections_max = 1024;
};

struct HttpConfig {
  bool enabled = true;
  std::string address = "127.0.0.1:8080";
  std::string allowed_hosts;    // names separated by commas
  std::string allowed_origins;  // "https://studio.example", separated by commas
  uint32_t videos_max = 4;      // live MP4 streams at once
};

// Without a token file and a JWKS file, everybody may do everything.
struct AccessConfig {
  std::string token_file;
  std::string jwks_file;  // needs audience and issuer
  std::string audience;
  std::string issuer;
  std::string audit_file;

  bool isOpen() const { return token_file.empty() && jwks_file.empty(); }
};

// Files in PEM; without a certificate, nothing is encrypted.
struct TlsConfig {
  std::string certificate;
  std::string key;
  std::string client_ca;  // empty = clients are not asked for certificates
  bool client_required = true;
};

struct LimitsConfig {
  uint64_t frame_bytes_max = uint64_t{3} << 29;  // 1.5 GiB
  uint32_t plane_side_px_max = 8192;
  uint32_t streams_max = 16;
  uint32_t displays_max = 64;
  uint32_t subscribers_max = 1024;
  uint32_t atlas_side_px_max = 16384;
  uint32_t views_max = 2500;
};

struct MemoryConfig {
  uint64_t budget = 0;  // bytes; 0 = three quarters of what the machine or its cgroup has
};

struct PipelineConfig {
  uint32_t decode_threads = 0;  // 0 = see threadCount
  uint32_t encode_threads = 0;
  uint32_t video_threads = 1;
  std::string video_encoder = "auto";  // or the name of one (codecs/video_kinds.h)
  uint32_t structure_slots = 2;        // of each stream
  uint32_t trace_slots = 3;
  bool warm_up = true;  // compile kernels of likely displays before they are asked for
};

struct ContainmentConfig {
  bool enabled = true;
  bool core_dumps = false;
  std::string readable;  // absolute paths separated by commas
};

struct LogConfig {
  std::string level = "info";
};

struct Config {
  std::string device;  // part of a device's name, or its index; empty = a real GPU, else lavapipe
  std::string kernel_folder = "auto";  // auto = the user's cache; empty = none
  bool validation = false;
  bool open = false;  // listen beyond this machine, though nothing keeps strangers out
  GrpcConfig grpc{};
  HttpConfig http{};
  AccessConfig access{};
  TlsConfig tls{};
  LimitsConfig limits{};
  MemoryConfig memory{};
  PipelineConfig pipeline{};
  ContainmentConfig containment{};
  LogConfig log{};
};

// Threads meant by a setting of which 0 says "one per core, 8 at most".
uint32_t threadCount(uint32_t setting);

}  // namespace viewloom
