# SPDX-License-Identifier: Apache-2.0
"""Data flows one way: which folder may include which, and which third party it may know.

All folders share one include root, so no compiler stops an upward include. This table does.
"""

import os
import re

from tree import Finding

BAND = "encode/encoded_band.h"
CHAIN = "encode/video_chain.h"
SHADERS_SHARED = "shaders/shared"
ENGINE = "engine/engine.h"
WALK = "engine/walk"
LIB = "shaders/lib"
LIB_ROOT = [LIB + "/fault.glsl", LIB + "/memory.glsl"]

# Folder: (what of ours it may include beside itself, which third parties). An entry of the first
# list is a folder or a single header.
LAYERS = {
    # Libraries that server and client share.
    "server/core/base": ([], ["absl", "spdlog"]),
    "server/core/certificates": (["base"], ["absl", "openssl"]),
    "server/core/jpeg": ([], ["jpeg"]),
    "server/core/frame": (["base"], ["absl", "glm"]),
    "server/core/calibration": (["base", "frame/size.h", SHADERS_SHARED], ["absl", "nlohmann"]),
    "server/core/display": (["base", "frame", "calibration", "video/quantisation.h",
                             SHADERS_SHARED],
                            ["absl", "glm", "nlohmann"]),
    "server/core/messages": (["base", "frame", "display", "video/h264_parameters.h"],
                             ["absl", "grpc", "nlohmann", "protobuf"]),
    "server/core/usage": (["base"], ["cli11"]),
    "server/core/video": (["base", "frame/size.h", SHADERS_SHARED], ["absl", "jpeg", "openh264"]),
    "server/core/codecs": (["base", "frame/size.h", "video"], ["absl", "avcodec"]),
    "server/core/mp4": (["base", "frame/size.h", "video"], ["absl"]),
    "server/metrics": (["base"], ["prometheus"]),
    # Prices of memory, and its ledger.
    "server/admission": (["base", "frame", "display", SHADERS_SHARED], ["absl"]),
    "server/config": (["base", "usage"], ["absl", "toml++"]),
    # Knows neither door, and no stream but by its name.
    "server/access": (["base"], ["absl", "nlohmann", "openssl"]),
    # Takes rights from the process; the kernel's interface and libseccomp only.
    "server/containment": (["base"], ["absl", "nlohmann", "seccomp"]),
    "server/tls": (["admission", "base", "certificates"], ["absl", "openssl"]),
    "server/decode": (["base", "jpeg", "frame", "admission", "video", SHADERS_SHARED],
                      ["absl", "glm", "jpeg", "zstd"]),
    "server/picture": (["base", "frame", "calibration", "display", SHADERS_SHARED],
                       ["absl", "glm"]),
    # The interface of engines; make_engines, which knows them all, is above them.
    "server/engine": (["base", "frame", "display", "picture"], ["absl"]),
    "server/engine/sweep": (["base", "frame", "display", "picture", "admission", ENGINE,
                             SHADERS_SHARED],
                            ["absl", "glm", "highway"]),
    "server/engine/walk": (["base", "frame", "display", "picture", "admission", ENGINE,
                            SHADERS_SHARED], ["absl"]),
    "server/engine/walk/gpu": (["base", SHADERS_SHARED], ["absl", "vulkan"]),
    "server/engine/walk/structure": (["base", "frame", WALK + "/gpu", SHADERS_SHARED],
                                     ["absl", "glm"]),
    "server/engine/walk/trace": (["base", "frame", "display", "picture", WALK + "/gpu",
                                  WALK + "/structure", SHADERS_SHARED], ["absl", "glm"]),
    "server/engine/walk/lens": (["base", "frame", "display", "picture", WALK + "/structure",
                                 WALK + "/trace", "engine/sweep/vectors_inl.h", SHADERS_SHARED],
                                ["glm", "highway"]),
    "server/retime": (["base", "frame", "engine/sweep", SHADERS_SHARED], ["glm", "highway"]),
    "server/temporal": (["base", "frame", "display"], ["absl", "glm"]),
    "server/encode": (["base", "jpeg", "frame", "display", "video", SHADERS_SHARED],
                      ["absl", "jpeg", "png", "zlib", "zstd"]),
    # Poses come in as frames do.
    "server/eye_poses": (["base", "display"], []),
    "server/publish": (["base", "frame", "display", "admission", "eye_poses", BAND, CHAIN],
                       ["absl"]),
    # Decides what to render when. It has no threads (schedule_rules.py); the pipeline has them.
    "server/schedule": (["base", "frame", "display", "picture", "eye_poses", "temporal", "publish"],
                        ["absl"]),
    # Only make_engines includes the inside of an engine.
    "server/pipeline": (["base", "frame", "config", "decode", "display", "picture", "admission",
                         ENGINE, "engine/engines.h", "eye_poses", "retime", "temporal", "encode",
                         "publish", "schedule", "metrics", "video/annex_b.h",
                         "video/encoder_choice.h",
                         SHADERS_SHARED],
                        ["absl", "glm"]),
    "server/rpc": (["base", "access", "frame", "decode", "display", "admission", "eye_poses",
                    "messages", "metrics", BAND, "publish", "tls", "video/h264_parameters.h"],
                   ["absl", "grpc", "protobuf"]),
    "server/web": (["base", "access", "certificates", "frame", "display", "admission", "messages",
                     "decode/jpeg_plane.h", "eye_poses", "metrics", "mp4", "publish",
                     "schedule/fair_shares.h", "tls", "video/encoder_choice.h",
                     "video/h264_parameters.h", BAND],
                   ["absl", "boost", "nlohmann", "openssl", "protobuf"]),
    "client/text": (["base", "frame/size.h"], ["absl", "sdl"]),
    "client/patterns": (["base", "frame", "synthetic", "text"], ["absl", "glm"]),
    "client/synthetic": (["base", "frame", "lib/wire_frame.h"], ["glm", "protobuf"]),
    "client/deep": ([], ["glm"]),
    "client/files": (["base", "deep", "messages", "lib/wire_frame.h"],
                     ["absl", "openexr", "png", "jpeg", "tiff", "webp", "zlib", "protobuf"]),
    "client/photos": (["base", "files"], ["absl", "heif", "protobuf"]),
    "client/inputs": (["base", "files", "inspect", "lib/wire_frame.h", "photos"],
                      ["absl", "glm", "nlohmann", "openexr", "protobuf"]),
    "client/inspect": (["base", "frame", "messages", "files", SHADERS_SHARED],
                       ["absl", "glm", "protobuf"]),
    "client/lib": (["base", "certificates", "frame", "messages", "video"],
                   ["absl", "grpc", "protobuf", "zstd", "jpeg"]),
    "client/eyes": (["base"], ["absl", "nlohmann", "protobuf"]),
    "client/recording": (["base", "display", "lib", "mp4", "codecs",
                          "video/encoder_choice.h", "video/quantisation.h"],
                         ["absl", "protobuf"]),
    "client/show": (["base", "frame/size.h", "calibration", "eyes", "lib", "files/file_bytes.h",
                     "text"],
                    ["absl", "epoxy", "grpc", "protobuf", "sdl"]),
    "client/scoring": (["base", "frame"], ["absl"]),
    "client/bridge": (["base", "certificates", "lib/tls_parts.h"],
                      ["absl", "boost", "nlohmann", "openssl"]),
    "client/cli": (["base", "bridge", "calibration", "certificates/server_address.h", "display",
                    "messages", "frame", "eyes", "lib", "files", "inputs", "inspect", "patterns",
                    "photos", "recording", "show", "synthetic", "usage", "video/quantisation.h"],
                   ["absl", "glm", "grpc", "protobuf", "jpeg", "nlohmann"]),
    "shaders/shared": ([], ["glm"]),
    "shaders/lib": ([SHADERS_SHARED], []),
    "shaders/lib/structure": (LIB_ROOT + [SHADERS_SHARED], []),
    "shaders/lib/rays": (LIB_ROOT + [SHADERS_SHARED], []),
    "shaders/lib/walk": (LIB_ROOT + [LIB + "/structure", LIB + "/rays", SHADERS_SHARED], []),
    "shaders/lib/sources": (LIB_ROOT + [SHADERS_SHARED], []),
    "shaders/lib/light": (LIB_ROOT + [LIB + "/structure", LIB + "/rays", LIB + "/walk",
                                      SHADERS_SHARED], []),
    "shaders/lib/lens": (LIB_ROOT + [LIB + "/structure", LIB + "/rays", LIB + "/walk",
                                     LIB + "/light", SHADERS_SHARED], []),
    "shaders/lib/mirrors": (["shaders/lib", SHADERS_SHARED], []),
    "shaders/structure": (["shaders/lib", SHADERS_SHARED], []),
    "shaders/trace": (["shaders/lib", SHADERS_SHARED], []),
    "shaders/show": ([SHADERS_SHARED], []),
}

# These join the stages, so they may include everything; those of the server nothing of the client.
COMPOSITION = ("server/main.cpp", "server/service", "server/commands", "server/engine_room",
               "server/engine_checks", "server/empty_engine_room", "server/engine/make_engines",
               "client/cli/main.cpp", "client/offline")

# Code that judges other code must not include it.
INDEPENDENT = {
    "tests/oracle": ["server/engine", "server/picture", "server/pipeline", "server/schedule",
                     "shaders"],
}

THIRD_PARTY = [
    ("absl", r"absl/"), ("avcodec", r"libav(codec|util)/"), ("spdlog", r"spdlog/|fmt/"),
    ("prometheus", r"prometheus/"),
    ("glm", r"glm/"), ("toml++", r"toml\+\+/"), ("nlohmann", r"nlohmann/"),
    ("zstd", r"zstd(_errors)?\.h"), ("jpeg", r"turbojpeg\.h|jpeglib\.h|jerror\.h|jmorecfg\.h"),
    ("png", r"png\.h"), ("tiff", r"tiffio\.h"), ("webp", r"webp/"), ("heif", r"libheif/"),
    ("openexr", r"OpenEXR/|Imath/|Imf|Imath"), ("cli11", r"CLI/"),
    ("vulkan", r"vulkan/"), ("boost", r"boost/"), ("zlib", r"zlib\.h"),
    ("highway", r"hwy/"), ("openssl", r"openssl/"), ("sdl", r"SDL\w*\.h"), ("epoxy", r"epoxy/"),
    ("seccomp", r"seccomp\.h"), ("openh264", r"wels/"),
    ("grpc", r"grpcpp/|grpc/|.*\.grpc\.pb\.h"),
    ("protobuf", r"google/protobuf/|.*\.pb\.h"),
    ("gtest", r"gtest/|gmock/"), ("benchmark", r"benchmark/"),
]
# Headers of others that one of ours stands for.
STANDS_FOR = {"absl/strings/str_cat.h": "server/core/base/str_cat.h"}
# The language and the operating system below it are everybody's.
SYSTEM = re.compile(r"[a-z_0-9]+(\.h)?|c?x?xabi\.h|(sys|arpa|netinet|net|linux)/[a-z_0-9]+\.h")

# Compiled at build time (shaders/CMakeLists.txt), for those who run them.
EMBEDDED_SHADER = re.compile(r"shaders/[a-z_0-9]+\.h")
RUN_SHADERS = ("server/engine/walk/structure", "server/engine/walk/trace")

INCLUDE = re.compile(r'\s*#\s*include\s+([<"])([^>"]+)[>"]')
ROOTS = ("server/core", "server/engine/walk", "server/engine", "server", "client", "shaders",
         "tests", "")


def owner(path, folders):
    """The longest of the folders that holds path, or None."""
    holding = [folder for folder in folders if path.startswith(folder + "/")]
    return max(holding, key=len) if holding else None


def resolve(tree, path, target):
    """The repository file that an include names, or None."""
    for root in (os.path.dirname(path),) + ROOTS:
        candidate = os.path.normpath(os.path.join(root, target))
        if candidate in tree:
            return candidate
    return None


def third_party(target):
    for name, pattern in THIRD_PARTY:
        if re.match(pattern, target):
            return name
    return None


def _allowed_ours(folder, included, allowed):
    if included.startswith(folder + "/"):
        return True
    for entry in allowed:
        for root in ("server/core", "server", "client", ""):
            full = os.path.join(root, entry)
            if included == full or included.startswith(full + "/"):
                return True
    return False


def _judge(tree, path, target):
    """The sentence that is wrong with this include, or None."""
    included = resolve(tree, path, target)
    for folder, forbidden in INDEPENDENT.items():
        if path.startswith(folder + "/") and included and owner(included, forbidden):
            return f"{folder} judges {owner(included, forbidden)} and must not include {target}"
    if path.startswith("server/") and included and included.startswith("client/"):
        return f"the server knows no client, not {target}"
    if STANDS_FOR.get(target, path) != path:
        return f"{STANDS_FOR[target]} stands for {target}"
    if path.startswith(COMPOSITION):
        return None
    folder = owner(path, LAYERS)
    if folder is None:
        return None
    allowed, parties = LAYERS[folder]
    if included:
        if _allowed_ours(folder, included, allowed):
            return None
        return f"{folder} may include {', '.join(allowed) or 'nothing of ours'}, not {target}"
    party = third_party(target)
    if party:
        if party in parties:
            return None
        return f"{folder} may know {', '.join(parties) or 'no third party'}, not {target}"
    if SYSTEM.fullmatch(target):
        return None
    if EMBEDDED_SHADER.fullmatch(target) and folder in RUN_SHADERS:
        return None
    return f"{target} is in no include root and no known library"


def check(tree):
    for path in tree.text_files(".h", ".cpp", ".glsl", ".comp", ".vert", ".frag"):
        for number, line in enumerate(tree.lines(path), 1):
            match = INCLUDE.match(line)
            if match:
                message = _judge(tree, path, match.group(2))
                if message:
                    yield Finding(path, number, "layers", message)
