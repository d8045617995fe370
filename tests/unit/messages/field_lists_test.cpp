// SPDX-License-Identifier: Apache-2.0
// The field lists of displays (display/fields.h) against the descriptors that protoc made.
#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "display/display_spec.h"
#include "messages/display_from_proto.h"

namespace viewloom::field_lists_test {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

// A visitor that notes the path of every field.
class Paths {
 public:
  template <typename... Parts>
  void operator()(const char* name, const Parts&...) {
    add(name);
  }
  template <typename... Parts>
  void word(const char* name, const Parts&...) {
    add(name);
  }
  template <typename... Parts>
  void label(const char* name, const Parts&...) {
    add(name);
  }
  void color(const char* name, uint32_t) { add(name); }
  void cameras(const char* name, const std::vector<ViewCamera>&, const Range&) { add(name); }
  void pose(const char* name, const std::optional<Pose>&) { add(name); }
  template <typename Spec>
  void part(const char* name, const std::optional<Spec>&) {
    group(name, [&] {
      const Spec any;
      visitFields(any, *this);
    });
  }
  template <typename Function>
  void group(const char* name, const Function& visit) {
    const std::string outer = prefix_;
    prefix_ += std::string(name) + ".";
    visit();
    prefix_ = outer;
  }
  void kind(const DisplayKind&) {
    add("preset");
    forEachKind([this](const auto& spec) { part(spec.kName, std::optional(spec)); });
  }
  template <typename Function>
  void made(const Function&) {}

  std::set<std::string> all;

 private:
  void add(const char* name) {
    EXPECT_TRUE(all.insert(prefix_ + name).second) << prefix_ << name << " stands in a list twice";
  }

  std::string prefix_;
};

// Messages of geometry are values.
bool isValue(const FieldDescriptor& field) {
  return field.message_type() == nullptr ||
         field.message_type()->file()->name() == "viewloom/v1/geometry.proto";
}

void addPaths(const Descriptor& type, const std::string& prefix, std::set<std::string>& all) {
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (isValue(field)) {
      all.insert(prefix + field.name());
    } else {
      addPaths(*field.message_type(), prefix + field.name() + ".", all);
    }
  }
}

TEST(FieldLists, haveEveryFieldOfTheProtoAndNoOther) {
  Paths paths;
  const DisplaySpec any;
  visitFields(any, paths);
  std::set<std::string> wanted;
  addPaths(*v1::Display::descriptor(), "", wanted);
  EXPECT_EQ(paths.all, wanted);
}

TEST(FieldLists, giveEveryNumberARangeThatHoldsSomething) {
  EXPECT_EQ(rangeOf("quilt.columns").max, 50);
  EXPECT_EQ(rangeOf("effects.lens.gathered_samples").max, 256);
  EXPECT_EQ(rangeOf("integral.panel_size.width").min, 1);
  for (const auto& [path, range] : fieldRanges()) EXPECT_LT(range.min, range.max) << path;
}

// The key tells displays apart by every field that changes the picture: set one, and it changes.
v1::Display wholeQuilt() {
  v1::Display display;
  v1::QuiltDisplay& quilt = *display.mutable_quilt();
  quilt.set_columns(4);
  quilt.set_rows(4);
  quilt.mutable_size()->set_width(64);
  quilt.mutable_size()->set_height(64);
  return display;
}

std::string keyOf(const v1::Display& display) {
  const absl::StatusOr<DisplaySpec> spec = displayFromProto(display);
  EXPECT_TRUE(spec.ok()) << spec.status();
  return spec.ok() ? displayKey(*spec) : "";
}

TEST(FieldLists, makeAnotherKeyOfEveryNumberOfAQuilt) {
  const std::string plain = keyOf(wholeQuilt());
  for (const auto& [name, value] : std::map<std::string, double>{{"aspect", 2},
                                                                 {"view_cone_rad", 0.5},
                                                                 {"focal_distance_m", 3},
                                                                 {"fov_y_rad", 1},
                                                                 {"depthiness", 0.5},
                                                                 {"cone_begin", 0.25},
                                                                 {"cone_end", 0.75}}) {
    v1::Display display = wholeQuilt();
    v1::QuiltDisplay& quilt = *display.mutable_quilt();
    quilt.GetReflection()->SetDouble(&quilt, quilt.GetDescriptor()->FindFieldByName(name), value);
    EXPECT_NE(keyOf(display), plain) << name;
  }
  v1::Display best = wholeQuilt();
  best.set_quality(v1::QUALITY_BALANCED);
  EXPECT_EQ(keyOf(best), plain) << "what is the default says nothing";
  best.set_quality(v1::QUALITY_BEST);
  EXPECT_NE(keyOf(best), plain) << "its tolerance is another";
}

}  // namespace
}  // namespace viewloom::field_lists_test
