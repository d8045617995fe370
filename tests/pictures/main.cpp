// SPDX-License-Identifier: Apache-2.0
// viewloom-step-pictures: the pictures of shaders/*.md.
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>

#include "pictures/step_pictures.h"
#include "usage/command_line.h"

static void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

int main(int argc, char** argv) {
  const viewloom::usage::CommandLine app("Draws a picture of each step of the algorithm");
  std::filesystem::path folder;
  std::string device_name;
  app.add("folder", folder, "Where they go: shaders/pictures").required().existingFolder();
  app.add("--device", device_name, "Vulkan device, as viewloomd --device");
  if (const std::optional<int> code = app.parse(argc, argv)) return *code;
  try {
    const viewloom::Device device({.select = device_name});
    for (const viewloom::pictures::Picture& picture : viewloom::pictures::drawSteps(device)) {
      write(folder / picture.file_name, picture.svg);
    }
  } catch (const std::exception& error) {
    std::cerr << "viewloom-step-pictures: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
