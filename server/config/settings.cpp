// SPDX-License-Identifier: Apache-2.0
#include "config/settings.h"

namespace viewloom {
namespace {

constexpr uint64_t kMiB = uint64_t{1} << 20;
constexpr uint64_t kGiB = uint64_t{1} << 30;

std::vector<Setting> machineSettings(Config& config) {
  return {
      {"device", "",
       "Vulkan device: part of its name, or its index in `viewloomd doctor`; empty takes a GPU, "
       "else the CPU",
       TextSetting{&config.device}},
      {"kernel_folder", "",
       "Folder that keeps compiled GPU kernels between starts; auto is the user's cache, empty is "
       "none",
       TextSetting{&config.kernel_folder}},
      {"validation", "", "Load the Vulkan validation layers and log their messages; slow",
       BoolSetting{&config.validation}},
  };
}

std::vector<Setting> addressSettings(bool& open, GrpcConfig& grpc, HttpConfig& http) {
  using Form = TextSetting::Form;
  return {
      {"open", "",
       "Listen beyond this machine without encryption and access control, in a network that you "
       "trust",
       BoolSetting{.value = &open, .is_switch = true}},
      {"grpc.address", "",
       "Address for publishers and viewers; beyond loopback it needs tls.certificate and access "
       "control, or --open. Port 0 takes a free port",
       TextSetting{&grpc.address, Form::kGrpcAddress}},
      {"grpc.keepalive_s", "s",
       "Silence after which a connection is tested; it is closed if no answer comes in half that "
       "time",
       CountSetting{&grpc.keepalive_s, 1, 3600}},
      {"grpc.unread_s", "s",
       "Time after which a call is cut whose client has not read a message (up to 1 MiB)",
       CountSetting{&grpc.unread_s, 1, 3600}},
      {"grpc.connections_max", "",
       "Most gRPC connections at once; fewer if the system allows fewer open files",
       CountSetting{&grpc.connections_max, 1, 65536}},
      {"http.enabled", "", "Serve the viewer page, stills, motion JPEG and /metrics over HTTP",
       BoolSetting{&http.enabled}},
      {"http.address", "",
       "Address of the viewer page, with the same needs as grpc.address. Port 0 takes a free port",
       TextSetting{&http.address, Form::kHostPort}},
      {"http.allowed_hosts", "",
       "Further host names that requests may use, such as the name of a proxy",
       TextSetting{&http.allowed_hosts, Form::kHostNames}},
      {"http.allowed_origins", "",
       "Pages of others that may watch and show pictures, such as https://studio.example",
       TextSetting{&http.allowed_origins, Form::kOrigins}},
      {"http.videos_max", "",
       "Most live videos (MP4) at once; each one is encoded by itself, which costs much CPU time",
       CountSetting{&http.videos_max, 0, 64}},
  };
}

std::vector<Setting> accessSettings(AccessConfig& access) {
  using Form = TextSetting::Form;
  return {
      {"access.token_file", "",
       "File of access tokens, made with `viewloomd token add`; empty needs no token",
       TextSetting{&access.token_file, Form::kFile}},
      {"access.jwks_file", "",
       "File of public keys (JSON Web Key Set) whose JWTs are accepted; needs audience and issuer",
       TextSetting{&access.jwks_file, Form::kFile}},
      {"access.audience", "", "Audience (aud) that a JWT must name", TextSetting{&access.audience}},
      {"access.issuer", "", "Issuer (iss) that a JWT must name", TextSetting{&access.issuer}},
      {"access.audit_file", "",
       "File to which each grant, refusal and change is appended, as a line of JSON; empty is none",
       TextSetting{&access.audit_file, Form::kFile}},
  };
}

std::vector<Setting> tlsSettings(TlsConfig& tls) {
  using Form = TextSetting::Form;
  return {
      {"tls.certificate", "",
       "Certificate in PEM, with those between it and its authority, for both ports; empty is no "
       "encryption",
       TextSetting{&tls.certificate, Form::kFile}},
      {"tls.key", "", "Private key in PEM of tls.certificate, without a passphrase",
       TextSetting{&tls.key, Form::kFile}},
      {"tls.client_ca", "",
       "Certificates in PEM of the authorities that certificates of clients come from; empty asks "
       "for none",
       TextSetting{&tls.client_ca, Form::kFile}},
      {"tls.client_required", "", "Refuse clients without a certificate of tls.client_ca",
       BoolSetting{&tls.client_required}},
  };
}

std::vector<Setting> limitSettings(LimitsConfig& limits) {
  return {
      {"limits.frame_bytes_max", "bytes", "Largest frame, with all its planes uncompressed",
       CountSetting{&limits.frame_bytes_max, kMiB, 16 * kGiB}},
      {"limits.plane_side_px_max", "px", "Largest side of a colour or depth plane",
       CountSetting{&limits.plane_side_px_max, 1, 8192}},
      {"limits.streams_max", "", "Most streams at once; each keeps its newest frame in memory",
       CountSetting{&limits.streams_max, 1, 1024}},
      {"limits.displays_max", "",
       "Most displays at once that differ in stream, picture or encoding; each is rendered by "
       "itself",
       CountSetting{&limits.displays_max, 1, 4096}},
      {"limits.subscribers_max", "", "Most viewers at once, all displays together",
       CountSetting{&limits.subscribers_max, 1, 65536}},
      {"limits.atlas_side_px_max", "px",
       "Largest side of an atlas (a quilt, a stereo pair); the device may allow less",
       CountSetting{&limits.atlas_side_px_max, 1, 16384}},
      {"limits.views_max", "", "Most views of one display",
       CountSetting{&limits.views_max, 1, 2500}},
  };
}

std::vector<Setting> memorySettings(MemoryConfig& memory) {
  return {
      {"memory.budget", "bytes",
       "Memory that the server may take, frames, displays and viewers included. 0 is three "
       "quarters of the machine's or the container's",
       CountSetting{&memory.budget, 0, 64 * 1024 * kGiB}},
  };
}

std::vector<Setting> pipelineSettings(PipelineConfig& pipeline) {
  return {
      {"pipeline.decode_threads", "", "Threads that decode frames; 0 is one per core, up to 8",
       CountSetting{&pipeline.decode_threads, 0, 64}},
      {"pipeline.encode_threads", "",
       "Threads that encode atlases and render on the CPU; 0 is one per core, up to 8",
       CountSetting{&pipeline.encode_threads, 0, 64}},
      {"pipeline.video_threads", "", "Threads that encode one picture of H.264 together, in slices",
       CountSetting{&pipeline.video_threads, 1, 16}},
      {"pipeline.video_encoder", "",
       "Encoder of H.264: openh264, or one that `viewloomd doctor` lists; auto takes a GPU's, else "
       "openh264",
       TextSetting{&pipeline.video_encoder}},
      {"pipeline.structure_slots", "",
       "Frames of one stream in memory at once: one is rendered while the next is prepared",
       CountSetting{&pipeline.structure_slots, 2, 16}},
      {"pipeline.trace_slots", "",
       "Strips of atlases (on the CPU, whole atlases) in work at once; more takes more memory",
       CountSetting{&pipeline.trace_slots, 2, 16}},
      {"pipeline.warm_up", "",
       "Compile the kernels of common displays after the start, before a viewer needs them",
       BoolSetting{&pipeline.warm_up}},
  };
}

std::vector<Setting> containmentSettings(ContainmentConfig& containment) {
  return {
      {"containment.enabled", "",
       "Let the kernel refuse files and system calls that a server does not need",
       BoolSetting{&containment.enabled}},
      {"containment.core_dumps", "",
       "Allow images of the memory after a crash, and debuggers; both show pictures and secrets",
       BoolSetting{&containment.core_dumps}},
      {"containment.readable", "",
       "Further files and folders that the server may read, such as drivers in unusual places",
       TextSetting{&containment.readable, TextSetting::Form::kPaths}},
  };
}

}  // namespace

std::vector<Setting> settingsOf(Config& config) {
  std::vector<Setting> settings = machineSettings(config);
  for (const std::vector<Setting>& part :
       {addressSettings(config.open, config.grpc, config.http), tlsSettings(config.tls),
        accessSettings(config.access), limitSettings(config.limits), memorySettings(config.memory),
        pipelineSettings(config.pipeline), containmentSettings(config.containment)}) {
    settings.insert(settings.end(), part.begin(), part.end());
  }
  settings.push_back({"log.level", "", "Lowest level of messages to log to standard error",
                      TextSetting{&config.log.level, TextSetting::Form::kLogLevel}});
  return settings;
}

}  // namespace viewloom
