#include "protocol/json_writer.hpp"

#include <charconv>
#include <cmath>

#include "protocol/utf8.hpp"

namespace limn::protocol {
namespace {

/// ECMA-262, Number::toString, from the shortest decimal digits of |v|.
template <class T>
std::string shortest(T v) {
  if (!std::isfinite(v)) return "null";
  if (v == T(0)) return "0";
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, std::fabs(v), std::chars_format::scientific).ptr;
  const std::string_view text(buffer, size_t(end - buffer));
  const size_t e = text.find('e');
  std::string digits(text.substr(0, 1));
  if (e > 2) digits.append(text.substr(2, e - 2));
  int exponent = 0;
  const size_t sign = text[e + 1] == '+' ? 1 : 0;
  std::from_chars(text.data() + e + 1 + sign, end, exponent);

  const int k = int(digits.size()), n = exponent + 1;
  std::string out;
  if (v < T(0)) out.push_back('-');
  if (k <= n && n <= 21) {
    out.append(digits).append(size_t(n - k), '0');
  } else if (0 < n && n <= 21) {
    out.append(digits, 0, size_t(n)).push_back('.');
    out.append(digits, size_t(n));
  } else if (-6 < n && n <= 0) {
    out.append("0.").append(size_t(-n), '0').append(digits);
  } else {
    out.push_back(digits[0]);
    if (k > 1) out.append(".").append(digits, 1);
    out.append(n > 0 ? "e+" : "e-").append(std::to_string(std::abs(n - 1)));
  }
  return out;
}

}  // namespace

std::string javascriptNumber(double v) { return shortest(v); }
std::string javascriptNumber(float v) { return shortest(v); }

void JsonWriter::open(char bracket) {
  separate();
  m_text += bracket;
  m_first = true;
}

void JsonWriter::close(char bracket) {
  m_text += bracket;
  m_first = false;
}

void JsonWriter::separate() {
  if (!m_first) m_text += ',';
  m_first = false;
}

void JsonWriter::raw(std::string_view text) {
  separate();
  m_text += text;
}

void JsonWriter::key(std::string_view name) {
  separate();
  quote(name);
  m_text += ':';
  m_first = true;
}

void JsonWriter::value(double v) { raw(shortest(v)); }
void JsonWriter::value(float v) { raw(shortest(v)); }

void JsonWriter::value(std::string_view v) {
  separate();
  quote(v);
}

void JsonWriter::value(Hash v) {
  char buffer[17];
  std::snprintf(buffer, sizeof buffer, "%016llx", static_cast<unsigned long long>(v.value));
  value(std::string_view(buffer));
}

void JsonWriter::quote(std::string_view text) {
  static constexpr char kHex[] = "0123456789abcdef";
  m_text += '"';
  while (!text.empty()) {
    const unsigned char c = static_cast<unsigned char>(text.front());
    const size_t length = utf8Length(text);
    switch (c) {
      case '"': m_text += "\\\""; break;
      case '\\': m_text += "\\\\"; break;
      case '\b': m_text += "\\b"; break;
      case '\f': m_text += "\\f"; break;
      case '\n': m_text += "\\n"; break;
      case '\r': m_text += "\\r"; break;
      case '\t': m_text += "\\t"; break;
      default:
        if (c < 0x20) m_text += {'\\', 'u', '0', '0', kHex[c >> 4], kHex[c & 15]};
        else if (length == 0) m_text += "\xEF\xBF\xBD";
        else m_text += text.substr(0, length);
    }
    text.remove_prefix(length ? length : 1);
  }
  m_text += '"';
}

}  // namespace limn::protocol
