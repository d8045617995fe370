// SPDX-License-Identifier: Apache-2.0
// viewloom-step-pictures: the pictures of shaders/README.md.
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "pictures/step_pictures.h"

static void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

int main(int argc, char** argv) {
  CLI::App app("Draws a picture of each step of the algorithm");
  std::filesystem::path folder;
  std::string device_name;
  app.add_option("folder", folder, "Where they go: shaders/pictures")
      ->required()
      ->check(CLI::ExistingDirectory);
  app.add_option("--device", device_name, "Vulkan device, as viewloomd --device");
  CLI11_PARSE(app, argc, argv);
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
