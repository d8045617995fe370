// SPDX-License-Identifier: Apache-2.0
#include "inputs/interpret_deep.h"

#include "files/exr_description.h"
#include "files/file_bytes.h"
#include "inputs/exr_header_facts.h"
#include "inputs/exr_windows.h"

namespace viewloom::inputs {

absl::StatusOr<Interpretation> interpretDeep(const InputSettings& settings, v1::DeepFile& deep) {
  const absl::StatusOr<files::ExrDescription> description = files::describeExr(deep.file());
  if (!description.ok()) return description.status();
  Interpretation result;
  if (settings.pixel_aspect) result.pixel_aspect = *settings.pixel_aspect;
  readHeaderFacts(settings, *description, result);
  if (result.projection != Projection::kFlat) {
    return files::refuseFile(deep.file(),
                             "is a deep panorama; accepted are panoramas of flat files, and "
                             "--projection flat to read it as a flat picture");
  }
  for (const files::ExrDescribedPart& part : description->parts) {
    if (!part.isDeep()) continue;
    settleWindow({part.display, part.data}, *deep.mutable_window(), result);
    break;
  }
  VIEWLOOM_RETURN_IF_ERROR(readHeaderCamera(settings, deep.file(), *description, result));
  return result;
}

}  // namespace viewloom::inputs
