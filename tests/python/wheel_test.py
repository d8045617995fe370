# SPDX-License-Identifier: Apache-2.0
"""The wheel is made without a network, installed in a venv and used outside the checkout.

wheel_test.py PACKAGE VERSION [VIEWLOOMD]: the package in the build tree, the version of viewloom.
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import zipfile

ROOT = pathlib.Path(__file__).parents[2]
PACKAGE, VERSION = pathlib.Path(sys.argv.pop(1)).resolve(), sys.argv.pop(1)
SOURCES = ROOT / "client" / "python"
HAS_SERVER = len(sys.argv) > 1 and not sys.argv[1].startswith("-")
if HAS_SERVER:
    import viewloomd  # takes its argument

PATIENCE_S = 120
# Neither the build tree nor what the user has installed.
ENVIRONMENT = {**{name: value for name, value in os.environ.items() if name != "PYTHONPATH"},
               "PYTHONNOUSERSITE": "1", "PYTHONDONTWRITEBYTECODE": "1",
               "PIP_CONFIG_FILE": os.devnull}

WHERE = """
import importlib.metadata, pathlib, sys
import viewloom, viewloom.aio, viewloom.v1.display_pb2
assert pathlib.Path(viewloom.__file__).is_relative_to(sys.prefix), viewloom.__file__
print(viewloom.__version__, importlib.metadata.version("viewloom"))
"""


class Wheel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.run_here("/usr/bin/python3", SOURCES / "make_wheel.py", PACKAGE, cls.folder / "wheel")
        cls.wheel, = (cls.folder / "wheel").iterdir()
        cls.python = cls.folder / "venv" / "bin" / "python"
        # pip is Debian's, which the venv sees.
        cls.run_here("/usr/bin/python3", "-m", "venv", "--system-site-packages", "--without-pip",
                     cls.folder / "venv")
        cls.pip("install", "--no-index", "--no-deps", "--no-compile", cls.wheel)

    @classmethod
    def run_here(cls, *command, may_fail=False):
        """What a command prints that runs outside the checkout and the build tree."""
        done = subprocess.run(command, cwd=cls.folder, env=ENVIRONMENT, timeout=PATIENCE_S,
                              capture_output=True, text=True, check=False)
        assert done.returncode == 0 or may_fail, done.stdout + done.stderr
        return done.stdout

    @classmethod
    def pip(cls, *words, **more):
        return cls.run_here(cls.python, "-m", "pip", "--disable-pip-version-check", *words, **more)

    def test_it_is_named_after_the_version_and_runs_on_every_system(self):
        self.assertEqual(self.wheel.name, f"viewloom-{VERSION}-py3-none-any.whl")

    def test_it_holds_the_package_with_types_and_nothing_else(self):
        names = set(zipfile.ZipFile(self.wheel).namelist())
        modules = {name for name in names if not name.startswith(f"viewloom-{VERSION}.dist-info/")}
        written = {str(file.relative_to(SOURCES)) for file in (SOURCES / "viewloom").rglob("*")
                   if file.suffix in (".py", ".typed")} | {"viewloom/version.py"}
        made = modules - written
        self.assertEqual(written - modules, set())
        self.assertIn("viewloom/v1/display_service_pb2_grpc.py", made)
        for name in made:
            self.assertRegex(name, r"^viewloom/(v1|rpc)/\w+_pb2(_grpc\.py|\.pyi?)$")
            if name.endswith("_pb2.py"):
                self.assertIn(name + "i", made)
        self.assertIn(f"viewloom-{VERSION}.dist-info/LICENSE", names)

    def test_it_is_imported_from_where_it_was_installed(self):
        self.assertEqual(self.run_here(self.python, "-c", WHERE), f"{VERSION} {VERSION}\n")

    def test_the_packages_of_this_system_are_those_that_it_asks_for(self):
        said = self.pip("check", may_fail=True)  # other packages may lack something
        self.assertEqual([line for line in said.splitlines() if line.startswith("viewloom ")], [])
        asked = self.pip("show", "viewloom")
        self.assertRegex(asked, r"(?m)^Requires: grpcio, numpy, Pillow, protobuf, zstandard$")

    def test_it_works_without_a_server(self):
        """As the suite asks of the package in the build tree."""
        for test in ("python_atlas_file_test.py", "python_arrays_test.py"):
            self.run_here(self.python, ROOT / "tests" / "python" / test)

    @unittest.skipUnless(HAS_SERVER, "this build has no viewloomd")
    def test_it_publishes_and_watches(self):
        daemon = viewloomd.Viewloomd()
        self.addCleanup(daemon.stop)
        said = self.run_here(self.python, SOURCES / "examples" / "first_picture.py", daemon.address)
        self.assertEqual(said, f"wrote {self.folder / 'ball.jpg'}\n")
        self.assertEqual((self.folder / "ball.jpg").read_bytes()[:2], b"\xff\xd8")


if __name__ == "__main__":
    unittest.main()
