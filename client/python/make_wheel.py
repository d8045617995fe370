# SPDX-License-Identifier: Apache-2.0
"""Makes the wheel of the package that lies in a build folder, without a network.

make_wheel.py BUILD_FOLDER/client/python OUTPUT_FOLDER
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

LICENSE = pathlib.Path(__file__).parents[2] / "LICENSE"
FILES = "wheel_files.txt"  # what CMakeLists.txt puts together; older files may lie beside
NEEDED = {"pip": "python3-pip", "setuptools": "python3-setuptools", "wheel": "python3-wheel"}


def stage(package, folder):
    """Copies what belongs to the wheel, and nothing else that lies in the build folder."""
    listed = (package / FILES).read_text(encoding="utf-8").splitlines()
    for file in map(pathlib.Path, listed):
        copy = folder / file.relative_to(package)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, copy)
    shutil.copyfile(LICENSE, folder / "LICENSE")


def make_wheel(package, output):
    """The path of the new wheel. Wheels of viewloom that were in the folder before are removed."""
    output.mkdir(parents=True, exist_ok=True)
    for old in output.glob("viewloom-*.whl"):
        old.unlink()
    # Modules of a build tree must not stand in for those that pip needs.
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    with tempfile.TemporaryDirectory() as folder:
        stage(package, pathlib.Path(folder))
        done = subprocess.run(
            [sys.executable, "-m", "pip", "wheel", "--no-index", "--no-deps",
             "--no-build-isolation", "--no-cache-dir", "--disable-pip-version-check",
             "--wheel-dir", output, folder],
            env=environment, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"pip could not make the wheel:\n{done.stdout}{done.stderr}")
    wheel, = output.glob("viewloom-*.whl")
    return wheel


def missing_packages():
    """The Debian packages without which no wheel can be made."""
    return [package for module, package in NEEDED.items()
            if subprocess.run([sys.executable, "-I", "-c", f"import {module}"],
                              capture_output=True, check=False).returncode != 0]


def main():
    package, output = map(pathlib.Path, sys.argv[1:])
    missing = missing_packages()
    if missing:
        sys.exit(f"make_wheel: {', '.join(missing)} missing: sudo apt-get install "
                 f"--no-install-recommends {' '.join(missing)}")
    try:
        print("wrote", make_wheel(package.resolve(), output))
    except RuntimeError as problem:
        sys.exit(f"make_wheel: {problem}")


if __name__ == "__main__":
    main()
