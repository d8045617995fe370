// SPDX-License-Identifier: Apache-2.0
// Prints the streams of a server.
#include <viewloom/broken_call.h>
#include <viewloom/catalog.h>

#include <iostream>

int main(int, char** argv) {
  const viewloom::Catalog catalog(viewloom::makeChannel(argv[1]));
  const auto streams = catalog.listStreams();
  if (!streams.ok()) std::cerr << viewloom::connectionProblem(streams.status()) << "\n";
  if (!streams.ok()) return 1;
  for (const auto& stream : streams->streams()) std::cout << stream.name() << "\n";
}
