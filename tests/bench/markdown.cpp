// SPDX-License-Identifier: Apache-2.0
#include "bench/markdown.h"

#include <iomanip>
#include <sstream>
#include <vector>

#include "base/str_cat.h"

namespace viewloom::bench {
namespace {

using Json = nlohmann::ordered_json;
using Cells = std::vector<std::string>;

// In the order in which a reader compares them; `copy` moves a build's bytes, and has no picture.
const Cells kTracing = {"viewloom", "walk", "floor", "dda", "hiz", "embree", "rows", "runs"};
const Cells kBuilding = {"viewloom", "walk", "copy", "dda", "hiz", "embree", "rows", "runs"};
constexpr const char* kNone = "-";

void addRow(std::ostream& text, const Cells& cells) {
  text << "|";
  for (const std::string& cell : cells) text << " " << cell << " |";
  text << "\n";
}

void addHead(std::ostream& text, const std::string& caption, const Cells& cells) {
  text << caption << "\n\n";
  addRow(text, cells);
  text << "|";
  for (size_t i = 0; i < cells.size(); ++i) text << "---|";
  text << "\n";
}

std::string number(double value, int decimals) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value;
  return text.str();
}

// Small ones keep a decimal.
std::string milliseconds(double value) {
  return number(value, value > 0.05 && value < 9.95 ? 1 : 0);
}

const Json* figureOf(const Json& load, const char* figure, const std::string& contestant) {
  const auto found = load.find(figure);
  if (found == load.end()) return nullptr;
  const auto of = found->find(contestant);
  return of == found->end() ? nullptr : &*of;
}

Cells joined(Cells first, const Cells& rest) {
  first.insert(first.end(), rest.begin(), rest.end());
  return first;
}

std::string timesCell(const Json& load, const std::string& contestant) {
  const Json* const build_ms = figureOf(load, "build_ms", contestant);
  const Json* const total_ms = figureOf(load, "total_ms", contestant);
  if (build_ms == nullptr) return kNone;
  const double build = *build_ms;
  if (total_ms == nullptr) return milliseconds(build);
  return strCat(milliseconds(build), " + ", milliseconds(total_ms->get<double>() - build));
}

std::string psnrCell(const Json& load, const std::string& contestant) {
  const Json* const psnr_db = figureOf(load, "psnr_db", contestant);
  return psnr_db == nullptr ? kNone : number(*psnr_db, 1);
}

template <typename Cell>
void addByContestant(std::ostream& text, const Json& loads, const Cells& contestants,
                     const Cell& cell) {
  for (const Json& load : loads) {
    Cells cells{load.at("name"), load.value("method", kNone)};
    for (const std::string& contestant : contestants) cells.push_back(cell(load, contestant));
    addRow(text, cells);
  }
  text << "\n";
}

std::string memoryCell(const Json& load, const char* contestant) {
  const Json* const memory = figureOf(load, "memory_mib", contestant);
  if (memory == nullptr) return kNone;
  return strCat(number(memory->at("total"), 0), " / ", number(memory->at("further_frame"), 0));
}

void addOwnFigures(std::ostream& text, const Json& loads) {
  addHead(
      text,
      "Visits of a walked ray, mean / p99 / max, and of the 8x8 px of a view that look at most; "
      "MiB of a frame and its atlas / of a further frame on its way:",
      {"load", "span px", "visits", "slowest 8x8", "viewloom MiB", "walk MiB"});
  for (const Json& load : loads) {
    const Json& visits = load.at("visits");
    addRow(text, {load.at("name"), number(load.at("disparity_span_px"), 0),
                  strCat(number(visits.at("mean"), 1), " / ", number(visits.at("p99"), 0), " / ",
                         number(visits.at("max"), 0)),
                  number(visits.at("slowest_8x8_sum"), 0), memoryCell(load, "viewloom"),
                  memoryCell(load, "walk")});
  }
  text << "\n";
}

}  // namespace

std::string targetsAsMarkdown(const Json& ratios) {
  std::ostringstream text;
  addHead(text, "Targets; in bold those that are lost:", {"what", "load", "measured", "target"});
  for (const Json& ratio : ratios) {
    const std::string value = number(ratio.at("value"), 2);
    const bool is_met = ratio.at("is_met");
    addRow(text, {ratio.at("what"), ratio.at("load"), is_met ? value : strCat("**", value, "**"),
                  ratio.at("target")});
  }
  return text.str();
}

std::string asMarkdown(const Json& report) {
  const Json& loads = report.at("loads");
  const bool is_traced = !loads.empty() && loads.front().contains("total_ms");
  const Cells& contestants = is_traced ? kTracing : kBuilding;
  std::ostringstream text;
  addHead(text, is_traced ? "Milliseconds of build + trace:" : "Milliseconds of the build:",
          joined({"load", "method"}, contestants));
  addByContestant(text, loads, contestants, timesCell);
  if (is_traced) {
    addHead(text, "PSNR against the true views, dB:", joined({"load", "method"}, contestants));
    addByContestant(text, loads, contestants, psnrCell);
    addOwnFigures(text, loads);
  }
  text << targetsAsMarkdown(report.at("ratios"));
  for (const Json& load : report.value("skipped", Json::array())) {
    text << "\nSkipped " << load.at("name").get<std::string>() << ": "
         << load.at("reason").get<std::string>() << "\n";
  }
  return text.str();
}

}  // namespace viewloom::bench
