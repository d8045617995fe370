# SPDX-License-Identifier: Apache-2.0
"""Every display that a document names is opened by that name, in every way that takes names."""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import urllib.error
import urllib.parse
import urllib.request

import viewloomd  # takes its argument

import scene
import viewloom

VIEWLOOM = sys.argv.pop(1)
ROOT = pathlib.Path(__file__).parents[2]
DOCUMENTS = sorted(file for pattern in ("*.md", "*/*.md", "*/*/*.md", "proto/*/*/*.proto",
                                        "deploy/*.toml")
                   for file in ROOT.glob(pattern) if "build" not in file.relative_to(ROOT).parts)
# Where a document names a display: an option, an address, a field of a message, and the rows of a
# table of devices.
NAMED = (r"--preset[ =]`?([A-Za-z0-9_]+)", r"/(?:still|stream)/[a-z]+/([a-z0-9_]+)(?![\w.])",
         r"\bpreset\"?'?: ?[\"']([A-Za-z0-9_]+)[\"']", r"(?:still|watch)\(\"\w+\", \"(\w+)\"")
DEVICE_TABLE = re.compile(r"^\| device \|.*\n\|[-| ]+\n((?:\|.*\n)+)", re.MULTILINE)
QUOTED_DEVICE = r"[`\"](\d+(?:_\w+)?|near_eye_\d+|wowvx\w*|go_p|kiosk)[`\"]"
SMALL = viewloom.encoding(jpeg_quality=20)


# Words of the protos that are in quotes as names of devices are.
DISPLAY_KINDS = {"quilt", "lenticular", "integral", "rgbd"}


def cmake_presets():
    """Their option has the same name."""
    presets = json.loads((ROOT / "CMakePresets.json").read_text(encoding="utf-8"))
    return {entry["name"] for entry in presets["configurePresets"]}


def documented_names():
    """Name of a display → the documents that use it."""
    found = {}
    for document in DOCUMENTS:
        text = document.read_text(encoding="utf-8")
        names = {name for form in NAMED for name in re.findall(form, text)}
        for table in DEVICE_TABLE.findall(text):
            for row in table.splitlines():
                names |= set(re.findall(r"[\w]+", re.sub(r"\(.*?\)", "", row.split("|")[1])))
        names |= {name for name in re.findall(QUOTED_DEVICE, text) if "_" in name}
        for name in names - cmake_presets() - {"NAME", "PRESET", "DEVICE"}:
            found.setdefault(name, []).append(document.name)
    return found


class DocumentedDisplays(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.daemon = viewloomd.Viewloomd()
        cls.addClassCleanup(cls.daemon.stop)
        cls.server = viewloom.connect(cls.daemon.address)
        cls.addClassCleanup(cls.server.close)
        cls.publisher = cls.server.publish("demo")
        cls.addClassCleanup(cls.publisher.close)
        cls.publisher.send(scene.source(scene.smooth_color(), scene.step_depth())).result(
            viewloomd.PATIENCE_S)
        cls.names = {name: files for name, files in documented_names().items()
                     if name not in DISPLAY_KINDS}

    def command(self, *words):
        return subprocess.run([VIEWLOOM, *words, "--server", self.daemon.address], check=False,
                              capture_output=True, text=True, timeout=viewloomd.PATIENCE_S)

    def test_the_documents_name_displays_of_every_kind(self):
        self.assertLessEqual({"portrait", "near_eye_2013", "wowvx", "wowvx_declipse", "8_9_gen1",
                              "16_gen3_l", "16_gen3_p", "32_gen3_l", "32_gen3_p", "go_p", "65"},
                             set(self.names))

    def test_each_is_listed(self):
        listed = {preset.name for preset in self.server.presets()}
        self.assertEqual({name: files for name, files in self.names.items()
                          if name not in listed}, {})
        said = self.command("list", "presets").stdout
        self.assertEqual([name for name in self.names if name not in said], [])
        with urllib.request.urlopen(self.daemon.url + "api/presets") as answer:
            for_page = {entry["name"] for entry in json.load(answer)["presets"]}
        self.assertEqual(set(self.names) - for_page, set())

    def test_elemental_images_and_colour_with_depth_are_opened_by_their_names(self):
        for name in ("near_eye_2013", "wowvx", "wowvx_declipse"):
            with self.subTest(name):
                atlas = self.server.still("demo", name, timeout_s=viewloomd.PATIENCE_S)
                with urllib.request.urlopen(f"{self.daemon.url}still/demo/{name}") as still:
                    self.assertEqual(still.headers["Content-Type"], "image/jpeg")
                    self.assertEqual(still.read()[:3], b"\xff\xd8\xff")
                with tempfile.TemporaryDirectory() as folder:
                    done = self.command("watch", "demo", "--preset", name, "--count", "1", "--out",
                                        folder)
                    self.assertEqual(done.returncode, 0, done.stderr)
                    self.assertEqual(len(list(pathlib.Path(folder).iterdir())), 1)
                self.assertGreater(atlas.color.max(), 100)

    def test_each_quilt_is_opened_by_its_name(self):
        """The largest are many Mpx: of those the server's answer is the layout alone."""
        kinds = {preset.name: preset for preset in self.server.presets()}
        for name in self.names:
            preset = kinds[name]
            if "quilt" not in preset.kinds:
                continue
            display = {"quilt": {"preset": name, "size": {"width": 480, "height": 480}}}
            layout = self.server.still("demo", display, encoding=SMALL).layout
            self.assertEqual((layout.columns, layout.rows),
                             (preset.layout.columns, preset.layout.rows), name)
            with self.assertRaises(urllib.error.HTTPError) as redirect:
                self.first_answer(f"still/demo/{name}")
            location = redirect.exception.headers["Location"]
            self.assertIn("/still/demo_qs", urllib.parse.urljoin(redirect.exception.url, location))

    def first_answer(self, path):
        class Stays(urllib.request.HTTPRedirectHandler):
            def redirect_request(self, *_):
                return None

        return urllib.request.build_opener(Stays).open(self.daemon.url + path)

    def test_a_name_that_is_none_gets_the_nearest(self):
        for wrong, meant in (("portrat", "portrait"), ("near_eye", "near_eye_2013"),
                             ("wowx", "wowvx"), ("16_gen3", "16_gen3_l")):
            with self.assertRaises(viewloom.ViewloomError) as unknown:
                self.server.still("demo", wrong)
            self.assertEqual(unknown.exception.status.name, "NOT_FOUND")
            suggestion = rf"did you mean .*{meant}\b.*\?"
            self.assertRegex(unknown.exception.message, suggestion)
            with self.assertRaises(urllib.error.HTTPError) as answer:
                urllib.request.urlopen(f"{self.daemon.url}still/demo/{wrong}")
            self.assertEqual(answer.exception.code, 404)
            self.assertRegex(answer.exception.read().decode(), suggestion)

    def test_options_that_a_device_does_not_take_are_named(self):
        for option in (("--cone", "40"), ("--columns", "5"), ("--focal-distance", "2")):
            done = self.command("watch", "demo", "--preset", "near_eye_2013", *option)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(option[0], done.stderr)
        done = self.command("cast", "demo", "--preset", "near_eye_2013", "--bridge",
                            "http://127.0.0.1:9")
        self.assertIn("near_eye_2013", done.stderr + done.stdout)


if __name__ == "__main__":
    unittest.main()
