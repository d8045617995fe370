# SPDX-License-Identifier: Apache-2.0
"""A copy of the checkout in which commands of a document may write, as after the demo's build."""

import os
import pathlib
import re
import subprocess
import tempfile

import samples

# State of a build that its programs do not need, and that no document may change.
KEPT_OUT = ("Testing", ".ninja_deps", ".ninja_log")
# npm says soon that its registry is out of reach.
NPM = {"npm_config_fetch_retries": "1", "npm_config_fetch_retry_mintimeout": "2000",
       "npm_config_fetch_timeout": "20000"}
# Settings of a developer that no document counts on.
FORGOTTEN = re.compile(r"DISPLAY$|PYTHONPATH$|WAYLAND_|XDG_|VIEWLOOM_")
HEAD_TRACKER = """#!/bin/sh
while echo '{"time_ns": 8, "left": [-0.03, 0, 0.1], "right": [0.03, 0, 0.1]}'; do sleep 0.2; done
"""


def _write_program(path, text):
    path.write_text(text, encoding="utf-8")
    path.chmod(0o755)


class Workplace:
    """`root` is the copy. `viewloomd` and `viewloom` are on the path, but for a program that the
    document puts there itself."""

    def __init__(self, checkout, build, puts_on_path=False):
        self._folder = tempfile.TemporaryDirectory(prefix="viewloom_document_")
        self.root = pathlib.Path(self._folder.name) / "viewloom"
        self.state = pathlib.Path(self._folder.name) / "state"
        self.state.mkdir()
        self.build = pathlib.Path(build)
        self.viewloomd = self.build / "server" / "viewloomd"
        self.viewloom = self.build / "client" / "cli" / "viewloom"
        self._copy_checkout(checkout)
        self._link_build()
        samples.write_all(self.root)
        self._bin = self._make_programs(puts_on_path)
        self._environment = self._make_environment()
        self.forget_state()

    def _copy_checkout(self, checkout):
        """Files that git knows and new ones, as they lie on disk."""
        listed = subprocess.run(["git", "-c", "safe.directory=*", "ls-files", "-z", "--cached",
                                 "--others", "--exclude-standard"], cwd=checkout, check=True,
                                capture_output=True).stdout
        names = [name for name in set(listed.split(b"\0"))
                 if name and os.path.isfile(os.path.join(os.fsencode(checkout), name))]
        self.root.mkdir()
        packed = subprocess.run(["tar", "--create", "--null", "--no-recursion", "--files-from=-"],
                                input=b"\0".join(names), cwd=checkout, check=True,
                                capture_output=True).stdout
        subprocess.run(["tar", "--extract"], input=packed, cwd=self.root, check=True)

    def make_history(self):
        """One commit, for programs that ask git about the checkout."""
        person = ["-c", "user.name=test", "-c", "user.email=test@localhost"]
        for words in (["init", "--quiet"], ["add", "--all"], [*person, "commit", "--quiet",
                                                             "--message=A copy of the checkout"]):
            subprocess.run(["git", *words], cwd=self.root, check=True)

    def _link_build(self):
        """The folder itself is new, and what is in it belongs to the build."""
        release = self.root / "build" / "release"
        release.mkdir(parents=True)
        for entry in self.build.iterdir():
            if entry.name not in KEPT_OUT:
                (release / entry.name).symlink_to(entry)
        for name in ("BEFORE", "AFTER", "BUILD"):
            (self.root / name).symlink_to(self.build)

    def _make_programs(self, puts_on_path):
        """head-tracker stands for the reader's own. cmake finds everything built, and apt-get may
        install nothing."""
        folder = pathlib.Path(self._folder.name) / "bin"
        folder.mkdir()
        (folder / "viewloomd").symlink_to(self.viewloomd)
        if not puts_on_path:
            (folder / "viewloom").symlink_to(self.viewloom)
        _write_program(folder / "head-tracker", HEAD_TRACKER)
        _write_program(folder / "cmake", "#!/bin/sh\n"
                       "case \"$1\" in --list-presets) exec /usr/bin/cmake \"$@\";; esac\n")
        for name in ("apt-get", "sudo"):
            _write_program(folder / name, f"#!/bin/sh\necho 'no test calls {name}' >&2\nexit 1\n")
        return folder

    def _make_environment(self):
        kept = {name: value for name, value in os.environ.items() if not FORGOTTEN.match(name)}
        home = pathlib.Path(self._folder.name) / "home"
        home.mkdir()
        # Without it, curl is content with a page that tells an error.
        (home / ".curlrc").write_text("fail\n", encoding="ascii")
        cache = self.build / "tests" / "documents" / "cache"
        cache.mkdir(parents=True, exist_ok=True)
        npm_cache = os.environ.get("npm_config_cache", os.path.expanduser("~/.npm"))
        return {**kept, **NPM, "PATH": f"{self._bin}:{kept['PATH']}", "HOME": str(home),
                "LC_ALL": "C.UTF-8", "XDG_CACHE_HOME": str(cache), "npm_config_cache": npm_cache,
                "PYTHONDONTWRITEBYTECODE": "1", "VIEWLOOM_PIPELINE_WARM_UP": "false"}

    def environment(self, **more):
        return {**self._environment, **more}

    def folder(self):
        """The folder in which the next command starts."""
        return pathlib.Path((self.state / "folder").read_text(encoding="utf-8").strip())

    def forget_state(self):
        """Opens a new terminal: `cd` of the commands before counts no longer, `export` does."""
        (self.state / "folder").write_text(str(self.root), encoding="utf-8")
        (self.state / "exports").touch()

    def close(self):
        self._folder.cleanup()
