// SPDX-License-Identifier: Apache-2.0
// The example file is the manual: it must say everything, and say it right.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "config/read_config.h"
#include "config/settings.h"
#include "config/toml_file.h"

namespace viewloom::example_file_test {
namespace {

std::string exampleText() {
  std::ifstream file(VIEWLOOM_EXAMPLE_FILE);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(ExampleFile, holdsEverySettingWithItsDefault) {
  Config from_file = readConfig({.file = VIEWLOOM_EXAMPLE_FILE});
  Config defaults;
  const std::vector<Setting> read = settingsOf(from_file);
  const std::vector<Setting> expected = settingsOf(defaults);
  std::vector<std::string> keys_in_file;
  for (const TomlEntry& entry : readTomlFile(VIEWLOOM_EXAMPLE_FILE)) {
    keys_in_file.push_back(entry.key);
  }
  ASSERT_EQ(read.size(), expected.size());
  for (size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(valueText(read[i]), valueText(expected[i])) << read[i].key;
    EXPECT_THAT(keys_in_file, testing::Contains(std::string(read[i].key)));
  }
  EXPECT_EQ(keys_in_file.size(), expected.size());
}

TEST(ExampleFile, statesWhatEachSettingAccepts) {
  const std::string text = exampleText();
  Config config;
  size_t from = 0;
  for (const Setting& setting : settingsOf(config)) {
    const std::string name(setting.key.substr(setting.key.rfind('.') + 1));
    const size_t at = text.find("\n" + name + " = " + valueText(setting), from);
    ASSERT_NE(at, std::string::npos) << setting.key << " is missing or out of order";
    // The comment above it, which neighbours may share.
    const size_t accepted = text.rfind("Accepted: ", at);
    EXPECT_THAT(text.substr(accepted, at - accepted),
                testing::HasSubstr("Accepted: " + acceptedText(setting) + "."))
        << setting.key;
    from = at;
  }
}

TEST(Settings, areExplainedInTheHelp) {
  Config config;
  for (const Setting& setting : settingsOf(config)) {
    EXPECT_FALSE(setting.help.empty()) << setting.key;
    EXPECT_FALSE(setting.help.ends_with('.')) << setting.key;  // the accepted values follow it
    EXPECT_FALSE(valueName(setting).empty()) << setting.key;
  }
}

TEST(ExampleFile, namesAVariableThatWorks) {
  EXPECT_THAT(exampleText(), testing::HasSubstr("VIEWLOOM_GRPC_ADDRESS"));
  EXPECT_EQ(readConfig({.environment = {{"VIEWLOOM_GRPC_ADDRESS", "host:1"}}}).grpc.address,
            "host:1");
}

}  // namespace
}  // namespace viewloom::example_file_test
