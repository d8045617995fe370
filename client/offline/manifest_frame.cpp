// SPDX-License-Identifier: Apache-2.0
#include "offline/manifest_frame.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/byte_pool.h"
#include "base/check.h"
#include "base/str_cat.h"
#include "decode/frame_decoder.h"
#include "files/frame_manifest.h"
#include "files/json_message.h"
#include "messages/display_from_proto.h"
#include "rpc/frame_from_proto.h"
#include "synthetic/synthetic_wire_frame.h"

namespace viewloom {
namespace {

// A list of a thousand posed cameras is a tenth of this.
constexpr uint64_t kDisplayFileBytesMax = uint64_t{1} << 20;

// Checks and decodes what a publisher would send.
absl::StatusOr<FramePtr> frameFromWire(const WireFrame& wire) {
  absl::StatusOr<FrameFormat> format = frameFormatFromProto(wire.header, FrameLimits{});
  if (!format.ok()) return format.status();
  BytePool pool(0);  // one frame: nothing to keep
  FrameDecoder decoder(pool);
  absl::StatusOr<std::unique_ptr<Frame>> frame =
      decoder.decode({.format = *std::move(format), .planes = wire.planes});
  if (!frame.ok()) return frame.status();
  return FramePtr(*std::move(frame));
}

}  // namespace

absl::StatusOr<ManifestFrame> readManifestFrame(const std::filesystem::path& path) {
  const absl::StatusOr<v1::FrameManifest> manifest = files::readFrameManifest(path);
  if (!manifest.ok()) return manifest.status();
  return loadManifestFrame(*manifest, path.parent_path());
}

absl::StatusOr<ManifestFrame> loadManifestFrame(const v1::FrameManifest& manifest,
                                                const std::filesystem::path& folder) {
  absl::StatusOr<files::LoadedFrame> loaded = files::loadFrame(manifest, folder);
  if (!loaded.ok()) return loaded.status();
  absl::StatusOr<FramePtr> frame = frameFromWire(loaded->wire);
  if (!frame.ok()) return frame.status();
  return ManifestFrame{*std::move(frame), std::move(loaded->deep)};
}

FramePtr makeSyntheticFrame(const SyntheticOptions& options) {
  WireFrame wire = syntheticWireFrame(options, 0);
  wire.header.set_number(1);
  const absl::StatusOr<FramePtr> frame = frameFromWire(wire);
  VIEWLOOM_CHECK(frame.ok());
  return *frame;
}

absl::StatusOr<DisplaySpec> readDisplayFile(const std::filesystem::path& path) {
  v1::Display display;
  VIEWLOOM_RETURN_IF_ERROR(
      files::readJsonMessage(path, kDisplayFileBytesMax, "a display", display));
  return displayFromProto(display);
}

}  // namespace viewloom
