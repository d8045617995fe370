# SPDX-License-Identifier: Apache-2.0
"""fuzz_coverage.py BUILD CORPORA: lines of parsers and checks that the corpora reach.
Fails below 90 %, or where one of them is not counted. Needs llvm-profdata and llvm-cov.

BUILD has fuzzers that count (the preset fuzz-coverage), CORPORA a folder for each of them.
"""

import json
import os
import pathlib
import re
import subprocess
import sys

from fuzz_sources import FuzzSources

ROOT = pathlib.Path(__file__).parents[2]
LEAST_SHARE = 0.9
# Files that read or check what comes from elsewhere. Each source that a target is built from is one
# of these or of OTHERS.
READERS = re.compile(r"""
    /server/access/(bearer|json_object|jwt|key_set|rights|rights_json)\.cpp
  | /server/access/(signed_link|token_list|utc_time)\.cpp
  | /server/core/base/json_nesting\.cpp
  | /server/core/calibration/calibration(_keys)?\.cpp
  | /server/core/certificates/(authorities|certificate|certified_key|fingerprint|pem_file)\.cpp
  | /server/core/display/(fields|display_spec|effects|quilt|stereo|integral|lenticular|rgbd)\.cpp
  | /server/core/display/(lens|named_display|tracked_eyes)\.cpp
  | /server/core/frame/(depth|limits|camera|validate_plane)\.cpp
  | /server/core/messages/accepted_encoding\.cpp
  | /server/core/messages/(display_from_proto|json_fields|message_from_json|source_from_proto)\.cpp
  | /server/core/messages/wire_message\.cpp
  | /server/core/video/(annex_b|h264_parameters|openh264_decoder)\.cpp
  | /server/config/(toml_file|settings)\.cpp
  | /server/decode/(arriving_plane|frame_assembly|frame_decoder|plane_decoder)\.cpp
  | /server/decode/(h264_plane|jpeg_plane|predicted_plane|zstd_plane)\.cpp
  | /server/core/messages/eye_poses_from_proto\.cpp
  | /server/rpc/(frame_from_proto|stream_name)\.cpp
  | /server/rpc/(publish_call|read_chunk|watch_call)\.cpp
  | /server/web/(asked_display|host_policy|quilt_address|url|watch_request)\.cpp
  | /client/eyes/eye_feed\.cpp
  | /client/files/(bmp|dpt|netpbm|npy)_image\.cpp
  | /client/files/(deep_exr|exif|exr_header|exr_unpack|icc_profile|jpeg_segments)\.cpp
  | /client/inputs/tmiv_camera\.cpp
  | /client/lib/(atlas|atlas_assembler|color_decoder|stacked_atlas)\.cpp
  | /client/photos/(depth_xmp|jpeg_depth)\.cpp
  | /client/recording/(atlas_recording|frame_recording|recording_reader)\.cpp
""", re.VERBOSE)

# Targets are built from these, too: answers and states behind the checks, and files whose
# bytes a library reads.
OTHERS = re.compile(r"""
    /server/(admission|eye_poses|metrics|publish|tls)/
  | /server/core/(base/(?!json_nesting)|jpeg/|usage/)
  | /server/access/(access_control|audit_log|audit_window|caller|digest|operations)\.cpp
  | /server/access/(quota_account|quota_ledger|watched_file)\.cpp
  | /server/config/(read_config|setting)\.cpp
  | /server/core/calibration/make_lenticular\.cpp
  | /server/core/certificates/openssl\.cpp
  | /server/core/display/(atlas_layout|cameras|depth_budget|display_key|focal_window)\.cpp
  | /server/core/display/(presets|ray_extent|ray_samples|source_demand|taken_defaults)\.cpp
  | /server/core/display/(video_stack|views_outside)\.cpp
  | /server/core/frame/plane_encoding\.cpp
  | /server/core/video/(still_pictures|video_encoder|view_colors)\.cpp
  | /server/decode/(frame_intake|keep_motion|pack_surface|rgb_to_rgba|stream_queue)\.cpp
  | /server/rpc/(asked_picture|atlas_messages|atlas_outbox|bidi_call|call_access)\.cpp
  | /server/rpc/(layout_to_proto|peer_host|publish_offer|publish_place|report_to_proto)\.cpp
  | /server/rpc/(source_wants|status_to_grpc|tls_credentials|used_rate|wanted_message)\.cpp
  | /server/rpc/watch_places\.cpp
  | /client/deep/
  | /client/files/(color_coding|container|deep_layers|depth_packing|exr_description)\.cpp
  | /client/files/(exr_image|exr_layer_names|exr_open|exr_plane_reader|exr_usual)\.cpp
  | /client/files/(file_bytes|foreign_file|frame_manifest|jpeg_image|json_message)\.cpp
  | /client/files/(picture|picture_file|plane_file|plane_image|png_image)\.cpp
  | /client/files/(stored_samples|surface_file|tiff_image|tiff_stream|webp_image)\.cpp
  | /client/files/yuv_image\.cpp
  | /client/inputs/axes\.cpp
  | /client/lib/(file_name_part|frame_messages)\.cpp
  | /client/photos/(heif_image|photo_depth)\.cpp
  | /client/recording/recording_writer\.cpp
""", re.VERBOSE)


def is_reader(path):
    return READERS.search(path) is not None


def built(sources):
    """Sources of server and client that the targets are built from, sorted."""
    files = {path for target in sources.targets() for path in sources.files_of(target)}
    return sorted(path for path in files
                  if path.endswith(".cpp") and path.startswith(("server/", "client/")))


def undecided(paths):
    """Those that are neither of READERS nor of OTHERS, or of both."""
    return [path for path in paths
            if is_reader(f"/{path}") == (OTHERS.search(f"/{path}") is not None)]


def missing(paths, rows):
    """Readers of the tree that no row of the report is about."""
    counted = {file for file, _, _ in rows}
    return [path for path in paths if is_reader(f"/{path}")
            and not any(file.endswith(f"/{path}") for file in counted)]


def shares(report):
    """(file, covered lines, lines) of each reader in a report of llvm-cov; least share first."""
    rows = [(file["filename"], file["summary"]["lines"]["covered"],
             file["summary"]["lines"]["count"])
            for file in report["data"][0]["files"] if is_reader(file["filename"])]
    return sorted(rows, key=lambda row: row[1] / row[2])


def count(build, corpora):
    """The report of llvm-cov after all corpora."""
    fuzzers = sorted((build / "tests/fuzz").glob("*_fuzzer"))
    profiles = []
    for fuzzer in fuzzers:
        name = fuzzer.name.removesuffix("_fuzzer")
        if not (corpora / name).is_dir():
            sys.exit(f"{corpora / name}: no such corpus; first run tests/full.sh fuzz-{name}")
        profile = build / f"{name}.profraw"
        subprocess.run([fuzzer, "-runs=0", corpora / name], check=True, stderr=subprocess.DEVNULL,
                       env={**os.environ, "LLVM_PROFILE_FILE": str(profile)})
        profiles.append(profile)
    merged = build / "fuzz.profdata"
    subprocess.run(["llvm-profdata", "merge", "-o", merged, *profiles], check=True)
    exported = subprocess.run(["llvm-cov", "export", "-summary-only", f"-instr-profile={merged}",
                               build / "tests/fuzz/fuzzer"], check=True, stdout=subprocess.PIPE)
    return json.loads(exported.stdout)


def main(words):
    paths = built(FuzzSources(ROOT))
    for path in undecided(paths):
        sys.exit(f"{path}: a target is built from it; add it to READERS or to OTHERS in {__file__}")
    rows = shares(count(pathlib.Path(words[0]), pathlib.Path(words[1])))
    for path in missing(paths, rows):
        sys.exit(f"{path}: reads what comes from elsewhere, and is not in the report of llvm-cov")
    for file, covered, lines in rows:
        print(f"{100 * covered / lines:5.1f} %  {lines:4} lines  {os.path.relpath(file)}")
    covered, lines = sum(row[1] for row in rows), sum(row[2] for row in rows)
    print(f"{100 * covered / lines:5.1f} % of {lines} lines of {len(rows)} files")
    return 0 if covered >= LEAST_SHARE * lines else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
