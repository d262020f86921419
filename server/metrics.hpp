#pragma once
#include <string>
#include <string_view>

namespace limn::server {

/// Writes the Prometheus text format, version 0.0.4.
class MetricsText {
 public:
  void counter(std::string_view name, std::string_view help, double value) { add(name, help, "counter", "", value); }
  void gauge(std::string_view name, std::string_view help, double value) { add(name, help, "gauge", "", value); }
  /// A family of gauges, one a label value; call begin once, then sample for each.
  void beginGauges(std::string_view name, std::string_view help);
  void sample(std::string_view name, std::string_view label, std::string_view labelValue, double value);
  const std::string& text() const { return m_text; }

  static constexpr const char* kMime = "text/plain; version=0.0.4; charset=utf-8";

 private:
  void add(std::string_view name, std::string_view help, std::string_view type, std::string_view labels, double value);
  void describe(std::string_view name, std::string_view help, std::string_view type);

  std::string m_text;
};

}  // namespace limn::server
