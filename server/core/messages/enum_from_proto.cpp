// SPDX-License-Identifier: Apache-2.0
#include "messages/enum_from_proto.h"

#include <google/protobuf/descriptor.h>

#include "base/str_cat.h"

namespace viewloom {

absl::Status refuseEnum(const google::protobuf::EnumDescriptor& type, int number,
                        const std::string& accepted, std::string_view field) {
  const auto* known = type.FindValueByNumber(number);
  if (known != nullptr && number != 0) {
    return fieldError(absl::StatusCode::kUnimplemented, field,
                      strCat("got ", known->name(), ", not served yet; accepted: ", accepted));
  }
  const std::string got = known != nullptr ? known->name() : strCat("number ", number);
  return invalidField(field, strCat("got ", got, "; accepted: ", accepted));
}

}  // namespace viewloom
