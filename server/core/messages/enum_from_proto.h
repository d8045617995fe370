// SPDX-License-Identifier: Apache-2.0
// Converts proto enums by a table. Values that the table lacks are refused, by name or by number.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/generated_enum_reflection.h>

#include "base/status.h"
#include "base/str_cat.h"

namespace viewloom {

template <typename Proto, typename Value>
struct EnumRow {
  Proto proto;
  Value value;
};

// Makes the error for a value. UNIMPLEMENTED if proto has a name for it; INVALID_ARGUMENT for 0 and
// for unknown numbers.
inline absl::Status refuseEnum(const google::protobuf::EnumDescriptor& type, int number,
                               const std::string& accepted, std::string_view field) {
  const auto* known = type.FindValueByNumber(number);
  if (known != nullptr && number != 0) {
    return fieldError(
        absl::StatusCode::kUnimplemented, field,
        strCat("got ", known->name(), ", which is not served yet; accepted is ", accepted));
  }
  const std::string got = known != nullptr ? known->name() : strCat("number ", number);
  return invalidField(field, strCat("got ", got, "; accepted is ", accepted));
}

// Converts a value. A table with the _UNSPECIFIED value has a default; other tables refuse it.
template <typename Proto, typename Value, size_t kRowCount>
absl::StatusOr<Value> enumFromProto(Proto proto, std::string_view field,
                                    const EnumRow<Proto, Value> (&rows)[kRowCount]) {
  for (const auto& row : rows) {
    if (row.proto == proto) return row.value;
  }
  const auto& type = *google::protobuf::GetEnumDescriptor<Proto>();
  std::string accepted;
  for (const auto& row : rows) {
    accepted += strCat(accepted.empty() ? "" : ", ", type.FindValueByNumber(row.proto)->name());
  }
  return refuseEnum(type, proto, accepted, field);
}

}  // namespace viewloom
