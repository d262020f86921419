#include "server/limn/bench_html.hpp"

#include <cmath>
#include <cstdio>

namespace limn::bench {

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
  return safe;
}

std::string number(double value, const char* format) {
  if (!std::isfinite(value)) return "–";
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string marked(const std::string& text, bool bad) { return bad ? "<span class=\"bad\">" + text + "</span>" : text; }

std::string row(const std::vector<std::string>& cells, const char* tag) {
  std::string line = "<tr>";
  const std::string open = "<" + std::string(tag) + ">", close = "</" + std::string(tag) + ">";
  for (const std::string& cell : cells) line += open + cell + close;
  return line + "</tr>\n";
}

std::string header(const std::vector<std::string>& cells) { return "<table>\n" + row(cells, "th"); }

}  // namespace limn::bench
