# SPDX-License-Identifier: Apache-2.0
"""fuzz_coverage.py BUILD CORPORA: lines of parsers and checks that the corpora reach.
Fails below 90 %. Needs llvm-profdata and llvm-cov.

BUILD has fuzzers that count (the preset fuzz-coverage), CORPORA a folder for each of them.
"""

import json
import os
import pathlib
import re
import subprocess
import sys

LEAST_SHARE = 0.9
# Files that read or check what comes from elsewhere.
READERS = re.compile(r"""
    /server/access/(bearer|json_object|jwt|key_set|rights|rights_json)\.cpp
  | /server/access/(signed_link|token_list|utc_time)\.cpp
  | /server/core/calibration/calibration(_keys)?\.cpp
  | /server/core/certificates/(authorities|certificate|certified_key|fingerprint|pem_file)\.cpp
  | /server/core/display/(fields|display_spec|effects|quilt|stereo|integral|lenticular|rgbd)\.cpp
  | /server/core/frame/(depth|limits|camera)\.cpp
  | /server/core/messages/(display_from_proto|json_fields|message_from_json|source_from_proto)\.cpp
  | /server/config/(toml_file|settings)\.cpp
  | /server/decode/(frame_assembly|frame_decoder|plane_decoder)\.cpp
  | /server/decode/(jpeg_plane|predicted_plane|zstd_plane)\.cpp
  | /server/core/messages/eye_poses_from_proto\.cpp
  | /server/rpc/(frame_from_proto|stream_name)\.cpp
  | /server/rpc/(publish_call|read_chunk|watch_call)\.cpp
  | /server/web/(asked_display|host_policy|quilt_address|url|watch_request)\.cpp
  | /client/eyes/eye_feed\.cpp
  | /client/files/(bmp|dpt|netpbm|npy)_image\.cpp
  | /client/files/(deep_exr|exif|exr_header|exr_unpack|icc_profile|jpeg_segments)\.cpp
  | /client/inputs/tmiv_camera\.cpp
  | /client/lib/(atlas|atlas_assembler)\.cpp
  | /client/photos/(depth_xmp|jpeg_depth)\.cpp
  | /client/recording/(atlas_recording|frame_recording|recording_reader)\.cpp
""", re.VERBOSE)


def is_reader(path):
    return READERS.search(path) is not None


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
    rows = shares(count(pathlib.Path(words[0]), pathlib.Path(words[1])))
    for file, covered, lines in rows:
        print(f"{100 * covered / lines:5.1f} %  {lines:4} lines  {os.path.relpath(file)}")
    covered, lines = sum(row[1] for row in rows), sum(row[2] for row in rows)
    print(f"{100 * covered / lines:5.1f} % of {lines} lines of {len(rows)} files")
    return 0 if covered >= LEAST_SHARE * lines else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
