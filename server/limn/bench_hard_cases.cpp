#include "server/limn/bench_hard_cases.hpp"

#include <algorithm>

#include "protocol/json_value.hpp"
#include "renderer/base/file_bytes.hpp"
#include "server/limn/bench_html.hpp"

namespace limn::bench {
namespace {

using protocol::JsonValue;

constexpr uint64_t kMostBytes = 16u << 20;
constexpr const char* kIntroduction =
    "<h2>Hard cases</h2>\n<p>Scenes that are awkward in one way each, at 48x36 pixels and 64 samples. An unbiased "
    "technique's deviation from the closed form, or from its picture of the same scene without the awkwardness, is "
    "that of the worst block of pixels in standard errors; a biased one's is its relMSE without noise, or the light "
    "that leaks where there should be none. Energy is the mean over the truth's. Fireflies are pixels over 20 times "
    "the truth, as a share. Beside each figure stands what is promised in general; a broken promise is "
    "<span class=\"bad\">red</span>.</p>\n";

/// Reads members and remembers whether all were there.
struct CellReader {
  const JsonValue& value;
  bool good = true;

  const JsonValue* member(const char* key) {
    const JsonValue* found = value.find(key);
    good &= found != nullptr;
    return found;
  }
  template <class T>
  void take(const T* found, T& into) {
    good &= found != nullptr;
    if (found) into = *found;
  }
  void text(const char* key, std::string& into) {
    if (const JsonValue* found = member(key)) take(found->string(), into);
  }
  void flag(const char* key, bool& into) {
    if (const JsonValue* found = member(key)) take(found->boolean(), into);
  }
  void figure(const char* key, HardFigure& into) {
    const JsonValue* found = member(key);
    if (!found) return;
    CellReader inner{*found};
    if (const JsonValue* v = inner.member("value")) inner.take(v->number(), into.value);
    if (const JsonValue* v = inner.member("general")) inner.take(v->number(), into.bound);
    inner.flag("good", into.good);
    good &= inner.good;
  }
};

bool readCell(const JsonValue& value, HardCell& cell) {
  CellReader reader{value};
  reader.text("case", cell.name);
  reader.text("claim", cell.claim);
  reader.text("technique", cell.technique);
  reader.text("unit", cell.unit);
  reader.text("reason", cell.reason);
  reader.flag("sound", cell.sound);
  reader.flag("good", cell.good);
  reader.figure("deviation", cell.deviation);
  reader.figure("energy", cell.energy);
  reader.figure("discarded", cell.discarded);
  reader.figure("fireflies", cell.fireflies);
  return reader.good;
}

std::string figureText(const std::string& name, const HardFigure& figure) {
  return marked(name + " " + number(figure.value) + " (≤ " + number(figure.bound) + ")", !figure.good);
}

std::string cellText(const HardCell& cell) {
  std::string text = figureText(cell.unit == "sigma" ? "σ" : cell.unit, cell.deviation) + "<br>" +
                     figureText("energy", cell.energy) + "<br>" + figureText("fireflies", cell.fireflies) + "<br>" +
                     figureText("discarded", cell.discarded);
  if (!cell.sound) text += "<br>" + marked("not finite", true);
  if (!cell.good && !cell.reason.empty()) text += "<br>" + escaped(cell.reason);
  return text;
}

template <class Member>
std::vector<std::string> distinct(const std::vector<HardCell>& cells, Member member) {
  std::vector<std::string> found;
  for (const HardCell& cell : cells)
    if (std::find(found.begin(), found.end(), cell.*member) == found.end()) found.push_back(cell.*member);
  return found;
}

}  // namespace

Result<std::vector<HardCell>> readHardCases(const std::string& file) {
  std::vector<HardCell> cells;
  if (file.empty()) return cells;
  const Result<std::vector<uint8_t>> bytes = readFileBytes(file, kMostBytes);
  if (!bytes) return bytes.error();
  const Result<JsonValue> json = protocol::parseJson(std::string(bytes->begin(), bytes->end()), 8);
  if (!json) return Error{"bad-file", json.error().text(), file};
  const JsonValue* list = json->find("cells");
  if (!list || !list->array()) return Error{"bad-file", "holds no list of cells", file};
  for (const JsonValue& value : *list->array())
    if (!readCell(value, cells.emplace_back()))
      return Error{"bad-file", "lacks a member", file + "#/cells/" + std::to_string(cells.size() - 1)};
  return cells;
}

std::string hardCasesSection(const std::vector<HardCell>& cells) {
  if (cells.empty()) return "";
  const std::vector<std::string> techniques = distinct(cells, &HardCell::technique);
  std::vector<std::string> heads = {"case"};
  for (const std::string& technique : techniques) heads.push_back(escaped(technique));
  std::string text = kIntroduction;
  const auto good = std::count_if(cells.begin(), cells.end(), [](const HardCell& cell) { return cell.good; });
  text += "<p>" + std::to_string(good) + " of " + std::to_string(cells.size()) + " cells keep every promise.</p>\n";
  text += header(heads);
  for (const std::string& name : distinct(cells, &HardCell::name)) {
    std::vector<std::string> line(heads.size(), "–");
    for (const HardCell& cell : cells) {
      if (cell.name != name) continue;
      line[0] = "<b>" + escaped(name) + "</b><br>" + escaped(cell.claim);
      const auto at = std::find(techniques.begin(), techniques.end(), cell.technique);
      line[size_t(at - techniques.begin()) + 1] = cellText(cell);
    }
    text += row(line);
  }
  return text + "</table>\n";
}

}  // namespace limn::bench
