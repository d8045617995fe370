// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <map>
#include <string>

#include "base/check.h"
#include "config/read_config.h"
#include "eyes/eye_feed.h"
#include "files/container.h"
#include "files/deep_exr.h"
#include "files/exif.h"
#include "files/frame_manifest.h"
#include "files/icc_profile.h"
#include "files/jpeg_segments.h"
#include "files/netpbm_image.h"
#include "files/picture_file.h"
#include "fuzz/memory_file.h"
#include "fuzz/script.h"
#include "fuzz/targets.h"
#include "inputs/tmiv_camera.h"
#include "photos/depth_xmp.h"
#include "photos/jpeg_depth.h"
#include "recording/atlas_recording.h"
#include "recording/frame_recording.h"

namespace viewloom {
namespace {

using Decode = absl::StatusOr<files::Picture> (*)(const std::string&, FuzzBytes);

bool isRead(const absl::Status& status) {
  VIEWLOOM_CHECK(status.ok() || !status.message().empty());
  return status.ok();
}

bool isWhole(const absl::StatusOr<files::Picture>& picture) {
  if (!isRead(picture.status())) return false;
  VIEWLOOM_CHECK(picture->bytes.size() == picture->pixelCount() * picture->pixelBytes());
  return true;
}

bool liesWithin(FuzzBytes part, FuzzBytes whole) {
  return part.empty() ||
         (part.data() >= whole.data() && part.data() + part.size() <= whole.data() + whole.size());
}

// How many things a reader of recordings gives before it ends or refuses.
template <typename Reader>
size_t readAll(const MemoryFile& file) {
  absl::StatusOr<std::unique_ptr<Reader>> reader = Reader::open(file.path());
  size_t count = 0;
  while (isRead(reader.status())) {
    const auto next = (*reader)->next();
    if (!isRead(next.status()) || !next->has_value()) break;
    ++count;
  }
  return count;
}

bool describesJpeg(FuzzBytes bytes) {
  if (bytes.size() < 2 || bytes[0] != 0xFF || bytes[1] != 0xD8) return false;
  const files::JpegSegments segments = files::readJpegSegments(bytes);
  VIEWLOOM_CHECK(segments.end <= bytes.size());
  VIEWLOOM_CHECK(liesWithin(segments.exif, bytes) && liesWithin(segments.mpf, bytes));
  for (const FuzzBytes other : files::otherPictures(bytes, segments)) {
    VIEWLOOM_CHECK(liesWithin(other, bytes));
  }
  photos::findJpegDepth(bytes, segments);
  return segments.end > 0;
}

bool describesExif(FuzzBytes bytes) {
  const uint32_t orientation = files::orientationOf(bytes);
  VIEWLOOM_CHECK(orientation >= 1 && orientation <= 8);
  VIEWLOOM_CHECK(liesWithin(files::tiffOfExif(bytes), bytes));
  VIEWLOOM_CHECK(liesWithin(files::tiffOfItem(bytes), bytes));
  return files::focal35mm(bytes).has_value() || !files::pictureEntries(bytes).empty() ||
         orientation > 1;
}

bool describesDepth(FuzzBytes bytes) {
  const photos::DepthXmp apple = photos::parseDepthXmp(asText(bytes));
  VIEWLOOM_CHECK(std::isfinite(apple.float_max.value_or(0)));
  return !apple.image_type.empty() ||
         photos::parseGoogleDepth(asText(bytes), asText(bytes)).has_value();
}

}  // namespace

bool fuzzSettings(FuzzBytes bytes) {
  const MemoryFile file(bytes);
  try {
    readConfig({.file = file.path().string()});
    return true;
  } catch (const ConfigError& error) {
    VIEWLOOM_CHECK(*error.what() != '\0');
    return false;
  }
}

bool fuzzRecording(FuzzBytes bytes) {
  const MemoryFile file(bytes);
  return readAll<FrameRecordingReader>(file) + readAll<AtlasRecordingReader>(file) > 0;
}

bool fuzzPicture(FuzzBytes bytes) {
  const MemoryFile file(bytes);
  files::checkPictureFile(file.path()).IgnoreError();
  bool is_accepted = false;
  for (const Decode decode : {&files::decodeBmp, &files::decodeDpt, &files::decodeNpy,
                              &files::decodePfm, &files::decodePnm}) {
    is_accepted |= isWhole(decode("fuzz", bytes));
  }
  return is_accepted;
}

bool fuzzMetadata(FuzzBytes bytes) {
  bool is_accepted = describesJpeg(bytes);
  is_accepted |= describesExif(bytes);
  is_accepted |= describesDepth(bytes);
  is_accepted |= files::primariesOfIcc(bytes).has_value();
  files::codingOfIcc(bytes);
  return is_accepted;
}

bool fuzzExr(FuzzBytes bytes) {
  const MemoryFile file(bytes);
  absl::StatusOr<files::DeepExr> exr = files::DeepExr::open(file.path(), {});
  if (!isRead(exr.status())) return false;
  const uint32_t width_px = exr->widthPx();
  return isRead(exr->forEachRow([width_px](const files::DeepRow& row) {
    VIEWLOOM_CHECK(row.x + row.counts.size() <= width_px);
  }));
}

bool fuzzManifest(FuzzBytes bytes) {
  const MemoryFile file(bytes);
  const bool is_truth = isRead(files::readTruthManifest(file.path()).status());
  return isRead(files::readFrameManifest(file.path()).status()) || is_truth;
}

bool fuzzCameraList(FuzzBytes bytes) {
  const MemoryFile file(bytes);
  return isRead(inputs::readTmivCamera(file.path(), "", "v0_depth.yuv").status());
}

bool fuzzEyeLine(FuzzBytes bytes) {
  return isRead(parseEyePoses(std::string(asText(bytes))).status());
}

}  // namespace viewloom
