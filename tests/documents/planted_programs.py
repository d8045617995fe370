# SPDX-License-Identifier: Apache-2.0
"""A checkout and a build in which viewloom and viewloomd are scripts that do what a case asks."""

import pathlib
import subprocess
import tempfile

VIEWLOOM = r"""#!/bin/sh
case "$*" in
  *watch*--help) echo "  --count UINT    Atlases to receive"
                 echo "  --out TEXT      Folder"; exit;;
  *--help) echo "  --server TEXT   Address"; echo "Commands:"; echo "  watch       Receives"
           exit;;
  "watch --count 1 --out nowhere") ;;
  "watch --count 1 --out here") mkdir here; touch here/atlas.jpg;;
  "watch --count 1") echo "atlas 8x8 of 3 views";;
  *) echo "viewloom: cannot do that" >&2; exit 2;;
esac
"""
VIEWLOOMD = r"""#!/bin/sh
case "$*" in
  *--help) echo "  --config TEXT   Settings file"; echo "Commands:"; echo "  serve       Runs"
           exit;;
esac
{serve}
"""
# Ends in order on Ctrl-C.
SERVES = """trap 'exit 0' INT TERM
echo "viewloomd listening grpc=127.0.0.1:1"
while :; do sleep 0.1; done"""
NEVER_READY = SERVES.replace("echo", ": ")
WRONG_EXIT = SERVES.replace("exit 0", "exit 3")
ENDS_AT_ONCE = "echo 'address already in use' >&2; exit 2"


class PlantedPrograms:
    def __init__(self, serve=SERVES):
        self._folder = tempfile.TemporaryDirectory()
        self.checkout = pathlib.Path(self._folder.name) / "checkout"
        self.build = pathlib.Path(self._folder.name) / "build"
        self._write(self.build / "client" / "cli" / "viewloom", VIEWLOOM)
        self._write(self.build / "server" / "viewloomd", VIEWLOOMD.format(serve=serve))
        self._write(self.checkout / "client" / "tool.py",
                    "import argparse\nargparse.ArgumentParser().add_argument(\"--size\")\n")
        subprocess.run(["git", "init", "--quiet"], cwd=self.checkout, check=True)

    @staticmethod
    def _write(path, text):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        path.chmod(0o755)

    def close(self):
        self._folder.cleanup()
