# SPDX-License-Identifier: Apache-2.0
"""Programs, library, headers, package files, protos, unit and Python package work as installed."""

import fnmatch
import pathlib
import re
import shutil
import subprocess
import time
import unittest

import installed_tree
from installed_tree import CMAKE, ENVIRONMENT, PREFIX, SCRATCH, VERSION, only, run

EXTERNAL = pathlib.Path(__file__).parent / "external"
ROOT = pathlib.Path(__file__).parents[2]
STREAM = "installed"


class Served:
    """The installed server, and the installed client as its publisher."""

    def __enter__(self):
        self.processes = [subprocess.Popen(
            [PREFIX / "bin/viewloomd", "serve", "--grpc.address", "127.0.0.1:0", "--http.address",
             "127.0.0.1:0"], stdout=subprocess.PIPE, text=True, env=ENVIRONMENT)]
        line = self.processes[0].stdout.readline()
        self.address = re.search(r"grpc=(\S+)", line)[1]
        self.processes.append(subprocess.Popen(
            [PREFIX / "bin/viewloom", "publish", "--synthetic", "--size", "64x48", "--quiet",
             "--stream", STREAM, "--server", self.address], env=ENVIRONMENT))
        return self

    def __exit__(self, *_):
        for process in reversed(self.processes):
            process.terminate()
            process.wait(installed_tree.PATIENCE_S)
        self.processes[0].stdout.close()


class InstalledTree(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        installed_tree.install()
        cls.library = only("lib*/**/libviewloom-client.so").parent
        cls.with_library = {**ENVIRONMENT, "LD_LIBRARY_PATH": str(cls.library)}

    def test_both_programs_say_their_version(self):
        for program in ("viewloom", "viewloomd"):
            self.assertEqual(run(PREFIX / "bin" / program, "--version").strip(), VERSION)

    def test_the_library_has_a_soname_and_its_files_lead_to_one(self):
        real = self.library / f"libviewloom-client.so.{VERSION}"
        self.assertTrue(real.is_file() and not real.is_symlink())
        for name in ("libviewloom-client.so", "libviewloom-client.so.0"):
            self.assertEqual((self.library / name).resolve(), real.resolve())
        self.assertIn("SONAME               libviewloom-client.so.0\n", run("objdump", "-p", real))

    def test_the_library_exports_the_interface_alone(self):
        symbols = run("nm", "-DC", "--defined-only", self.library / "libviewloom-client.so")
        names = [line.split(" ", 2)[2] for line in symbols.splitlines()]
        self.assertTrue(any(name.startswith("viewloom::Publisher::offer(") for name in names))
        ours = re.compile(r"(vtable for |typeinfo (name )?for )?viewloom::"
                          r"|descriptor_table_viewloom_2fv1|VIEWLOOM_CLIENT_0")
        self.assertEqual([name for name in names if not ours.match(name)], [])
        self.assertEqual([name for name in names if "viewloom::strCat" in name
                          or name.startswith("viewloom::writeLog")], [])

    def test_all_protos_of_the_interface_are_there(self):
        sources = {path.name for path in (ROOT / "proto/viewloom/v1").glob("*.proto")}
        there = {path.name for path in (PREFIX / "share/viewloom/proto/viewloom/v1").iterdir()}
        self.assertEqual(there, sources)
        self.assertEqual({path.name for path in (PREFIX / "include/viewloom/v1").iterdir()
                          if ".grpc." not in path.name},
                         {name.replace(".proto", ".pb.h") for name in sources})

    def test_each_file_is_in_a_debian_package(self):
        # Debian has other places for libraries, completions and Python packages.
        debian = {"lib/*/": "lib*/", "zsh/vendor-completions": "zsh/*",
                  "python3/dist-packages": "python3*/*-packages"}
        patterns = []
        for path in (ROOT / "deploy/debian").glob("*.install"):
            for line in path.read_text(encoding="utf-8").splitlines():
                pattern = line.split()[0]
                for place, any_place in debian.items():
                    pattern = pattern.replace(place, any_place)
                patterns += [pattern, pattern + "/*"]
        there = [f"usr/{path.relative_to(PREFIX)}" for path in PREFIX.rglob("*")
                 if not path.is_dir()]
        self.assertEqual([name for name in there if not any(
            fnmatch.fnmatch(name, pattern) for pattern in patterns)], [])

    def test_the_unit_runs_the_installed_server_with_the_installed_settings(self):
        unit = (PREFIX / "lib/systemd/system/viewloomd.service").read_text(encoding="utf-8")
        self.assertIn(f"\nExecStart={PREFIX}/bin/viewloomd serve ", unit)
        for name in ("viewloomd.example.toml", "haproxy.cfg", "nginx.conf", "renew_front.sh"):
            self.assertTrue((PREFIX / "share/viewloom" / name).is_file(), name)

    @unittest.skipUnless(shutil.which("systemd-analyze"), "there is no systemd-analyze")
    def test_the_unit_leaves_the_server_few_rights(self):
        unit = PREFIX / "lib/systemd/system/viewloomd.service"
        run("systemd-analyze", "security", "--offline=true", "--threshold=20", str(unit))

    def test_the_python_package_is_imported_from_there(self):
        package = only("lib/python3*/dist-packages")
        said = run("/usr/bin/python3", "-c", "import viewloom; print(viewloom.__file__)",
                   env={**ENVIRONMENT, "PYTHONPATH": str(package)})
        self.assertEqual(said.strip(), str(package / "viewloom/__init__.py"))
        self.assertTrue((package / "viewloom/py.typed").is_file())

    def test_man_pages_render(self):
        for name, words in (("viewloom.1", "viewloom\\-publish"), ("viewloom-publish.1", "stream"),
                            ("viewloomd.8", "grpc.address")):
            page = PREFIX / f"share/man/man{name[-1]}" / name
            text = run("man", "-l", page)
            self.assertIn(words.replace("\\", ""), text)
            self.assertIn("SYNOPSIS", text)

    def test_a_project_of_cmake_lists_the_streams_of_the_installed_server(self):
        build = SCRATCH / "external"
        run(CMAKE, "-S", EXTERNAL, "-B", build, f"-DCMAKE_PREFIX_PATH={PREFIX}", "-G", "Ninja")
        run(CMAKE, "--build", build, "--target", "list_streams")
        with Served() as served:
            until_s = time.monotonic() + installed_tree.PATIENCE_S
            while not (said := run(build / "list_streams", served.address)):
                self.assertLess(time.monotonic(), until_s)
        self.assertEqual(said, STREAM + "\n")
        nobody = subprocess.run([build / "list_streams", served.address], capture_output=True,
                                text=True, check=False, timeout=installed_tree.PATIENCE_S)
        self.assertEqual((nobody.returncode, nobody.stdout), (1, ""))
        self.assertIn("refused", nobody.stderr)

    def test_a_project_of_pkg_config_reaches_everything_that_the_headers_declare(self):
        environment = {**self.with_library, "PKG_CONFIG_PATH": str(self.library / "pkgconfig")}
        self.assertEqual(run("pkg-config", "--modversion", "viewloom-client", env=environment),
                         VERSION + "\n")
        words = run("pkg-config", "--cflags", "--libs", "viewloom-client", env=environment).split()
        source, program = EXTERNAL / "every_declaration.cpp", SCRATCH / "every_declaration"
        run("g++", "-std=c++20", "-Wall", "-Werror", source, "-o", program, *words,
            env=environment)
        self.assertEqual(run(program, env=environment), "every declaration is there\n")
        public = {path.name for path in (PREFIX / "include/viewloom").glob("*.h")}
        included = re.findall(r"<viewloom/(\w+\.h)>", source.read_text(encoding="utf-8"))
        self.assertEqual(set(included), public)


if __name__ == "__main__":
    unittest.main()
