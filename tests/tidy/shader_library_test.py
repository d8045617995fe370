# SPDX-License-Identifier: Apache-2.0
"""Each file of the shader library stands by itself: it compiles if a kernel includes nothing else.

    shader_library_test.py GLSLANG_VALIDATOR

A file that uses a name which the kernel has to declare before it includes the file is refused."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SHADERS = pathlib.Path(__file__).parents[2] / "shaders"
VALIDATOR = "glslangValidator"
HEAD = """#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#extension GL_KHR_shader_subgroup_arithmetic : require
layout(local_size_x = 1) in;
#include "%s"
"""
# A function parameter: the file declares it, and each kernel defines it.
FOLLOW = """
Found follow(Scene scene, Pinhole pinhole, Spot from, Reflected reflected) {
  return Found(vec3(0.0), 0u, false, from, 0.0);
}
"""
DEFINES = {"lib/mirrors/mirrored_px.glsl": FOLLOW, "lib/mirrors/mirrored_walk.glsl": FOLLOW}


def refusals(library, folder):
    """What the compiler says of each file of the library, by its name."""
    for path in sorted(library.rglob("*.glsl")):
        name = "lib/" + path.relative_to(library).as_posix()
        kernel = folder / (name.replace("/", "-") + ".comp")
        kernel.write_text(HEAD % name + DEFINES.get(name, "") + "\nvoid main() {}\n")
        told = subprocess.run(
            [VALIDATOR, "--quiet", "-V", "--target-env", "vulkan1.3", f"-I{library.parent}",
             f"-I{SHADERS}", "-o", folder / "kernel.spv", kernel],
            capture_output=True, text=True, check=False)
        if told.returncode != 0:
            yield name, told.stdout


class ShaderLibrary(unittest.TestCase):
    def setUp(self):
        held = tempfile.TemporaryDirectory()
        self.addCleanup(held.cleanup)
        self.folder = pathlib.Path(held.name)

    def test_each_file_compiles_alone(self):
        self.assertEqual({}, dict(refusals(SHADERS / "lib", self.folder)))

    def test_finds_what_the_kernel_would_have_to_declare(self):
        library = self.folder / "lib"
        library.mkdir()
        (library / "extensions.glsl").write_text((SHADERS / "lib/extensions.glsl").read_text())
        (library / "alone.glsl").write_text("uint width(uint size_px) { return size_px; }\n")
        (library / "global.glsl").write_text("uint width() { return push.size_px; }\n")
        (library / "constant.glsl").write_text("bool isPlain() { return kRaysArePlain; }\n")
        self.assertEqual({"lib/constant.glsl", "lib/global.glsl"},
                         set(dict(refusals(library, self.folder))))


if __name__ == "__main__":
    if len(sys.argv) > 1:
        VALIDATOR = sys.argv.pop(1)
    unittest.main()
