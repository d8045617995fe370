// SPDX-License-Identifier: Apache-2.0
#include "fidelity/report.h"

#include <iomanip>
#include <sstream>

#include "offline/compare_views.h"

namespace viewloom::fidelity {
namespace {

using Json = nlohmann::ordered_json;

// Empty where there is no figure.
std::string figure(const Json& scores, const char* pixel_class, const char* name, int decimals) {
  const Json& value = scores.at(pixel_class).at(name);
  if (!value.is_number()) return value.is_null() ? "" : value.get<std::string>();
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value.get<double>();
  return text.str();
}

void addRow(std::ostringstream& text, const std::string& name, const Json& scores) {
  text << "  " << std::left << std::setw(22) << name << std::right;
  for (const char* pixel_class : {"covered", "all", "hidden"}) {
    text << std::setw(9) << figure(scores, pixel_class, "psnr_db", 2);
  }
  for (const char* measure : {"ssim", "flip"}) {
    text << std::setw(9) << figure(scores, "hidden", measure, 3);
  }
  text << std::setw(10) << figure(scores, "hidden", "share", 4) << std::setw(10)
       << figure(scores, "outside", "share", 4) << "\n";
}

}  // namespace

Json trialJson(const Trial& trial, const TrialReport& report) {
  Json json{{"name", trial.set.name},
            {"transfer", trial.transfer == ScoreTransfer::kSrgb ? "srgb" : "gamma2.2"},
            {"border_px", trial.border_px},
            {"cut_px", trial.cut_px},
            {"views", Json::array()}};
  for (size_t i = 0; i < trial.set.views.size(); ++i) {
    const test::TrueView& view = trial.set.views[i];
    Json methods;
    for (const MethodReport& method : report.methods) {
      methods[method.method] = scoreJson(method.by_mask[i]);
    }
    json["views"].push_back({{"view", view.name},
                             {"columns", view.columns},
                             {"rows", view.rows},
                             {"methods", methods},
                             {"viewloom_by_own_classes", scoreJson(report.by_own_classes[i])}});
  }
  for (const MethodReport& method : report.methods) {
    json["row_flicker"][method.method] = method.row_flicker;
    if (method.column_flicker) json["column_flicker"][method.method] = *method.column_flicker;
  }
  return json;
}

std::string asTable(const Json& trial) {
  std::ostringstream text;
  text << trial.at("name").get<std::string>() << ", " << trial.at("transfer").get<std::string>()
       << ", " << trial.at("border_px") << " px of border left out; dB, SSIM and FLIP\n"
       << std::left << std::setw(24) << "" << std::right << std::setw(9) << "covered"
       << std::setw(9) << "full" << std::setw(9) << "hidden" << std::setw(9) << "SSIM"
       << std::setw(9) << "FLIP" << std::setw(10) << "hidden" << std::setw(10) << "outside"
       << "\n";
  for (const Json& view : trial.at("views")) {
    text << "view " << view.at("view").get<std::string>() << "\n";
    for (const auto& [method, scores] : view.at("methods").items()) addRow(text, method, scores);
    addRow(text, "viewloom, own classes", view.at("viewloom_by_own_classes"));
  }
  for (const char* stack : {"row_flicker", "column_flicker"}) {
    if (!trial.contains(stack)) continue;
    text << stack << ", 1/255:" << std::fixed << std::setprecision(3);
    for (const auto& [method, value] : trial.at(stack).items()) {
      text << "  " << method << " " << value.get<double>();
    }
    text << "\n";
  }
  return text.str();
}

}  // namespace viewloom::fidelity
