// SPDX-License-Identifier: Apache-2.0
#include "unit/photos/auxiliary_boxes.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>

namespace viewloom::test {
namespace {

constexpr size_t kVersionBytes = 4;  // version and flags of a full box

struct Box {
  std::string type;
  Bytes payload;
};

uint64_t numberAt(const Bytes& bytes, size_t offset, size_t byte_count) {
  uint64_t number = 0;
  for (size_t i = 0; i < byte_count; ++i) number = number << 8 | bytes.at(offset + i);
  return number;
}

void setNumber(Bytes& bytes, size_t offset, size_t byte_count, uint64_t number) {
  for (size_t i = 0; i < byte_count; ++i) {
    bytes.at(offset + i) = static_cast<uint8_t>(number >> (8 * (byte_count - 1 - i)));
  }
}

void addNumber(Bytes& bytes, size_t byte_count, uint64_t number) {
  bytes.resize(bytes.size() + byte_count);
  setNumber(bytes, bytes.size() - byte_count, byte_count, number);
}

void addBytes(Bytes& bytes, const Bytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

std::vector<Box> boxesOf(const Bytes& bytes, size_t from) {
  std::vector<Box> boxes;
  while (from < bytes.size()) {
    const size_t size = numberAt(bytes, from, 4);
    if (size < 8 || from + size > bytes.size()) throw std::runtime_error("box of odd size");
    const auto begin = bytes.begin() + static_cast<ptrdiff_t>(from);
    boxes.push_back({std::string(begin + 4, begin + 8),
                     Bytes(begin + 8, begin + static_cast<ptrdiff_t>(size))});
    from += size;
  }
  return boxes;
}

Bytes joined(const Bytes& head, const std::vector<Box>& boxes) {
  Bytes bytes = head;
  for (const Box& box : boxes) {
    addNumber(bytes, 4, box.payload.size() + 8);
    addBytes(bytes, Bytes(box.type.begin(), box.type.end()));
    addBytes(bytes, box.payload);
  }
  return bytes;
}

Bytes headOf(const Bytes& full_box) {
  return {full_box.begin(), full_box.begin() + kVersionBytes};
}

Box& boxNamed(std::vector<Box>& boxes, std::string_view type) {
  const auto found =
      std::find_if(boxes.begin(), boxes.end(), [&](const Box& box) { return box.type == type; });
  if (found == boxes.end()) throw std::runtime_error("no box " + std::string(type));
  return *found;
}

// One more property for the item: `index` counts from 1.
void associate(Bytes& ipma, uint32_t item, size_t index) {
  const size_t item_bytes = ipma.at(0) == 0 ? 2 : 4;
  const size_t index_bytes = (ipma.at(3) & 1) != 0 ? 2 : 1;
  size_t at = kVersionBytes + 4;
  for (uint64_t left = numberAt(ipma, kVersionBytes, 4); left > 0; --left) {
    const uint64_t its_item = numberAt(ipma, at, item_bytes);
    const size_t count_at = at + item_bytes;
    const uint8_t count = ipma.at(count_at);
    at = count_at + 1 + count * index_bytes;
    if (its_item != item) continue;
    ipma.at(count_at) = static_cast<uint8_t>(count + 1);
    Bytes added;
    addNumber(added, index_bytes, index);
    ipma.insert(ipma.begin() + static_cast<ptrdiff_t>(at), added.begin(), added.end());
    return;
  }
  throw std::runtime_error("the item has no properties");
}

// Moves the file offsets of all data behind the meta box by `by` bytes.
void moveExtents(Bytes& iloc, size_t by) {
  const uint8_t version = iloc.at(0);
  const size_t offset_bytes = iloc.at(4) >> 4, length_bytes = iloc.at(4) & 15;
  const size_t base_bytes = iloc.at(5) >> 4, index_bytes = version == 0 ? 0 : iloc.at(5) & 15;
  size_t at = 6;
  const auto take = [&](size_t byte_count) {
    at += byte_count;
    return numberAt(iloc, at - byte_count, byte_count);
  };
  const auto move = [&](size_t byte_count) {
    setNumber(iloc, at, byte_count, numberAt(iloc, at, byte_count) + by);
  };
  for (uint64_t items = take(version < 2 ? 2 : 4); items > 0; --items) {
    take(version < 2 ? 2 : 4);
    const bool is_in_file = version == 0 || (take(2) & 15) == 0;
    take(2);
    if (is_in_file && base_bytes > 0) move(base_bytes);
    take(base_bytes);
    for (uint64_t extents = take(2); extents > 0; --extents) {
      take(index_bytes);
      if (is_in_file && base_bytes == 0) move(offset_bytes);
      take(offset_bytes + length_bytes);
    }
  }
}

}  // namespace

Bytes withAuxiliary(const Bytes& file, const AuxiliaryImage& auxiliary) {
  std::vector<Box> boxes = boxesOf(file, 0);
  Box& meta = boxNamed(boxes, "meta");
  std::vector<Box> children = boxesOf(meta.payload, kVersionBytes);

  Box& iprp = boxNamed(children, "iprp");
  std::vector<Box> properties = boxesOf(iprp.payload, 0);
  Box& ipco = boxNamed(properties, "ipco");
  Box auxc{"auxC", Bytes(kVersionBytes)};
  addBytes(auxc.payload, Bytes(auxiliary.type.begin(), auxiliary.type.end()));
  auxc.payload.push_back(0);
  addBytes(auxc.payload, auxiliary.subtypes);
  std::vector<Box> list = boxesOf(ipco.payload, 0);
  list.push_back(auxc);
  ipco.payload = joined({}, list);
  associate(boxNamed(properties, "ipma").payload, auxiliary.item, list.size());
  iprp.payload = joined({}, properties);

  const bool has_references = std::any_of(children.begin(), children.end(),
                                          [](const Box& box) { return box.type == "iref"; });
  if (!has_references) children.push_back({"iref", Bytes(kVersionBytes)});
  Box& iref = boxNamed(children, "iref");
  std::vector<Box> references = boxesOf(iref.payload, kVersionBytes);
  const size_t item_bytes = iref.payload.front() == 0 ? 2 : 4;
  Box& auxl = references.emplace_back(Box{"auxl", {}});
  addNumber(auxl.payload, item_bytes, auxiliary.item);
  addNumber(auxl.payload, 2, 1);
  addNumber(auxl.payload, item_bytes, auxiliary.of_item);
  iref.payload = joined(headOf(iref.payload), references);

  const size_t size_before = meta.payload.size();
  const size_t size_after = joined(headOf(meta.payload), children).size();
  moveExtents(boxNamed(children, "iloc").payload, size_after - size_before);
  meta.payload = joined(headOf(meta.payload), children);
  return joined({}, boxes);
}

Bytes withSizeStated(const Bytes& file, size_t n, uint32_t width_px, uint32_t height_px) {
  constexpr std::string_view kName = "ispe";
  Bytes changed = file;
  auto at = changed.begin();
  for (size_t i = 0; i <= n; ++i) {
    at = std::search(at, changed.end(), kName.begin(), kName.end());
    if (at == changed.end()) throw std::runtime_error("too few sizes");
    at += kName.size();
  }
  const auto offset = static_cast<size_t>(at - changed.begin()) + kVersionBytes;
  setNumber(changed, offset, 4, width_px);
  setNumber(changed, offset + 4, 4, height_px);
  return changed;
}

}  // namespace viewloom::test
