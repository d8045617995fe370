// SPDX-License-Identifier: Apache-2.0
#include "gpu/kernel_cache.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

#include "base/log.h"
#include "base/output_file.h"

namespace viewloom {
namespace {

constexpr std::array<char, 8> kMagic = {'V', 'L', 'K', 'E', 'R', 'N', '0', '1'};

struct Head {
  std::array<char, 8> magic = kMagic;
  uint64_t checksum = 0;
};

// FNV-1a: it has to find damage, not malice; who writes this file can write the program.
uint64_t checksumOf(std::span<const uint8_t> bytes) {
  uint64_t sum = 0xcbf29ce484222325;
  for (const uint8_t byte : bytes) sum = (sum ^ byte) * 0x100000001b3;
  return sum;
}

std::string_view textOf(std::span<const uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

absl::Status writeFile(const std::filesystem::path& path, const Head& head,
                       std::span<const uint8_t> kernels) {
  std::error_code ignored;  // then the file cannot be created either, which is told
  std::filesystem::create_directories(path.parent_path(), ignored);
  absl::StatusOr<std::unique_ptr<OutputFile>> file = OutputFile::create(path);
  if (!file.ok()) return file.status();
  VIEWLOOM_RETURN_IF_ERROR(
      (*file)->write(textOf({reinterpret_cast<const uint8_t*>(&head), sizeof head})));
  VIEWLOOM_RETURN_IF_ERROR((*file)->write(textOf(kernels)));
  return (*file)->replace();
}

}  // namespace

std::vector<uint8_t> KernelCache::read() {
  std::ifstream stream(file_, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
  Head head;
  if (bytes.size() < sizeof head) return {};
  std::memcpy(&head, bytes.data(), sizeof head);
  const std::vector<uint8_t> kernels(bytes.begin() + sizeof head, bytes.end());
  if (head.magic != kMagic || head.checksum != checksumOf(kernels)) return {};
  checksum_ = head.checksum;
  return kernels;
}

void KernelCache::write(std::span<const uint8_t> kernels) {
  const Head head{.checksum = checksumOf(kernels)};
  if (has_failed_ || head.checksum == checksum_) return;
  const absl::Status status = writeFile(file_, head, kernels);
  if (status.ok()) {
    checksum_ = head.checksum;
    return;
  }
  has_failed_ = true;
  log(LogLevel::kWarning, "compiled kernels are not kept: ", status.message());
}

}  // namespace viewloom
