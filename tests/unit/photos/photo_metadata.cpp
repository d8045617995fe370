// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "unit/photos/written_photo.h"

namespace viewloom::test {
namespace {

class BitWriter {
 public:
  void add(uint64_t number, int bit_count) {
    for (int bit = bit_count - 1; bit >= 0; --bit) {
      if (used_bits_ % 8 == 0) bytes_.push_back(0);
      if ((number >> bit & 1) != 0) bytes_.back() |= static_cast<uint8_t>(128 >> used_bits_ % 8);
      ++used_bits_;
    }
  }
  // ue(v) of H.265.
  void addExpGolomb(uint32_t number) {
    int length = 0;
    while ((number + 1) >> (length + 1) != 0) ++length;
    add(0, length);
    add(number + 1, length + 1);
  }
  // depth_rep_info_element: sign, exponent + 31, length of the mantissa - 1, mantissa. 16 bits of
  // mantissa, as phones write.
  void addElement(double number) {
    const int exponent = std::ilogb(number);
    const double fraction = std::ldexp(std::abs(number), -exponent) - 1;
    add(number < 0 ? 1 : 0, 1);
    add(static_cast<uint64_t>(exponent + 31), 7);
    add(15, 5);
    add(static_cast<uint64_t>(std::ldexp(fraction, 16)), 16);
  }
  const Bytes& bytes() const { return bytes_; }

 private:
  Bytes bytes_;
  size_t used_bits_ = 0;
};

void addNumber(Bytes& bytes, uint64_t number, int byte_count) {
  for (int byte = byte_count - 1; byte >= 0; --byte) {
    bytes.push_back(static_cast<uint8_t>(number >> (8 * byte)));
  }
}

void addZeros(Bytes& bytes, size_t up_to) {
  while (bytes.size() < up_to) bytes.push_back(0);
}

void addText(Bytes& bytes, const std::string& text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
}

}  // namespace

std::string appleXmp(const std::string& type, const std::string& float_min,
                     const std::string& float_max) {
  return R"(<x:xmpmeta xmlns:x="adobe:ns:meta/" x:xmptk="XMP Core 6.0.0">
   <rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">
      <rdf:Description rdf:about=""
            xmlns:apdi="http://ns.apple.com/pixeldatainfo/1.0/"
            xmlns:depthData="http://ns.apple.com/depthData/1.0/">
         <apdi:IntMaxValue>255</apdi:IntMaxValue>
         <apdi:IntMinValue>0</apdi:IntMinValue>
         <apdi:FloatMaxValue>)" +
         float_max + "</apdi:FloatMaxValue>\n         <apdi:FloatMinValue>" + float_min +
         "</apdi:FloatMinValue>\n         <apdi:AuxiliaryImageType>" + type +
         R"(</apdi:AuxiliaryImageType>
         <depthData:Accuracy>relative</depthData:Accuracy>
      </rdf:Description>
   </rdf:RDF>
</x:xmpmeta>)";
}

Bytes iccProfile(const std::array<std::array<double, 3>, 3>& colorants) {
  constexpr uint32_t kHeaderBytes = 128, kTagsBytes = 4 + 3 * 12, kXyzBytes = 20;
  Bytes profile;
  addNumber(profile, kHeaderBytes + kTagsBytes + 3 * kXyzBytes, 4);
  addZeros(profile, 12);
  addText(profile, "mntrRGB XYZ ");
  addZeros(profile, 36);
  addText(profile, "acsp");
  addZeros(profile, kHeaderBytes);
  addNumber(profile, 3, 4);
  uint32_t offset = kHeaderBytes + kTagsBytes;
  for (const char* name : {"rXYZ", "gXYZ", "bXYZ"}) {
    addText(profile, name);
    addNumber(profile, offset, 4);
    addNumber(profile, kXyzBytes, 4);
    offset += kXyzBytes;
  }
  for (const std::array<double, 3>& xyz : colorants) {
    addText(profile, "XYZ ");
    addNumber(profile, 0, 4);
    for (const double value : xyz) {
      addNumber(profile, static_cast<uint32_t>(std::lround(65536 * value)), 4);
    }
  }
  return profile;
}

Bytes depthRepresentation(uint32_t type, bool is_disparity, const std::array<double, 2>& ends) {
  BitWriter bits;
  bits.add(is_disparity ? 0b0011 : 0b1100, 4);
  bits.addExpGolomb(type);
  if (is_disparity) bits.addExpGolomb(0);  // the reference view
  for (const double end : ends) bits.addElement(end);
  bits.add(1, 1);  // of the trailing bits
  const Bytes& message = bits.bytes();
  Bytes unit{39 << 1, 1};  // prefix SEI
  unit.push_back(177);
  unit.push_back(static_cast<uint8_t>(message.size()));
  unit.insert(unit.end(), message.begin(), message.end());
  Bytes subtypes;
  addNumber(subtypes, unit.size() + 4, 4);
  addNumber(subtypes, unit.size(), 4);
  subtypes.insert(subtypes.end(), unit.begin(), unit.end());
  return subtypes;
}

}  // namespace viewloom::test
