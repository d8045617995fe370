# SPDX-License-Identifier: Apache-2.0
"""The functions of Vulkan and what each may return, from the registry of Debian's libvulkan-dev.

As a program it writes the table of the layer's hooks. Argument: the file to write.
"""

import re
import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

REGISTRY = "/usr/share/vulkan/registry/vk.xml"
HEADER = "/usr/include/vulkan/vulkan_core.h"
# Asked before there is an instance, where an explicit layer is not asked; or by the loader alone.
UNHOOKED = ("vkEnumerateInstanceExtensionProperties", "vkEnumerateInstanceLayerProperties",
            "vkEnumerateInstanceVersion", "vkGetInstanceProcAddr", "vkGetDeviceProcAddr")
RESULTS = {"VK_SUCCESS": 0, "VK_NOT_READY": 1, "VK_TIMEOUT": 2, "VK_ERROR_OUT_OF_HOST_MEMORY": -1,
           "VK_ERROR_OUT_OF_DEVICE_MEMORY": -2, "VK_ERROR_INITIALIZATION_FAILED": -3,
           "VK_ERROR_DEVICE_LOST": -4, "VK_ERROR_MEMORY_MAP_FAILED": -5,
           "VK_ERROR_LAYER_NOT_PRESENT": -6, "VK_ERROR_EXTENSION_NOT_PRESENT": -7,
           "VK_ERROR_FEATURE_NOT_PRESENT": -8, "VK_ERROR_INCOMPATIBLE_DRIVER": -9,
           "VK_ERROR_TOO_MANY_OBJECTS": -10}
LOST = "VK_ERROR_DEVICE_LOST"
# Answers that are no errors, and that are not what the caller asked for.
UNWANTED = ("VK_NOT_READY", "VK_TIMEOUT")


@dataclass(frozen=True)
class Function:
    name: str
    faults: tuple  # names of results that it may return, and that are no success

    @property
    def may_lose(self):
        return LOST in self.faults


def _faults(command):
    """Codes of extensions that viewloom does not use are left out."""
    codes = (command.get("successcodes") or "").split(",")
    codes = [code for code in codes if code in UNWANTED]
    codes += (command.get("errorcodes") or "").split(",")
    return tuple(code for code in codes if RESULTS.get(code))


def functions(registry=REGISTRY, header=HEADER):
    """All functions of the header that a layer can hook, in a fixed order."""
    declared = re.findall(r"\(VKAPI_PTR \*PFN_(vk\w+)\)", Path(header).read_text(encoding="utf-8"))
    commands = {}
    aliases = {}
    for command in ElementTree.parse(registry).getroot().find("commands"):
        if command.get("alias"):
            aliases[command.get("name")] = command.get("alias")
        else:
            commands[command.find("proto/name").text] = command
    known = {name: commands[aliases.get(name, name)] for name in declared
             if aliases.get(name, name) in commands}
    return [Function(name, _faults(command)) for name, command in sorted(known.items())
            if name not in UNHOOKED]


def hooks():
    lines = [f"HOOK({function.name}, {'true' if function.may_lose else 'false'})"
             for function in functions()]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(hooks(), encoding="utf-8")
