#include "server/metrics.hpp"

#include <charconv>
#include <cmath>

namespace limn::server {
namespace {

std::string number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "+Inf" : "-Inf";
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\' || c == '"') out += '\\';
    if (c == '\n') out += "\\n";
    else out += c;
  }
  return out;
}

}  // namespace

void MetricsText::describe(std::string_view name, std::string_view help, std::string_view type) {
  m_text.append("# HELP ")
      .append(name)
      .append(" ")
      .append(help)
      .append("\n# TYPE ")
      .append(name)
      .append(" ")
      .append(type)
      .append("\n");
}

void MetricsText::add(std::string_view name, std::string_view help, std::string_view type, std::string_view labels,
                      double value) {
  describe(name, help, type);
  m_text.append(name).append(labels).append(" ").append(number(value)).append("\n");
}

void MetricsText::beginGauges(std::string_view name, std::string_view help) { describe(name, help, "gauge"); }

void MetricsText::sample(std::string_view name, std::string_view label, std::string_view labelValue, double value) {
  m_text.append(name)
      .append("{")
      .append(label)
      .append("=\"")
      .append(escaped(labelValue))
      .append("\"} ")
      .append(number(value))
      .append("\n");
}

}  // namespace limn::server
