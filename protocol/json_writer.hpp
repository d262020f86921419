#pragma once
#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/messages.gen.hpp"

namespace limn::protocol {

/// Writes JSON byte for byte as JavaScript's JSON.stringify does: no blanks, shortest numbers, -0 as 0, its escapes.
/// float fields are written with the fewest digits that give the same float. Numbers that are not finite become null.
/// Bytes that are not UTF-8 become U+FFFD.
class JsonWriter {
 public:
  void beginObject() { open('{'); }
  void endObject() { close('}'); }
  void beginArray() { open('['); }
  void endArray() { close(']'); }
  void key(std::string_view name);

  void value(bool v) { raw(v ? "true" : "false"); }
  void value(double v);
  void value(float v);
  void value(std::string_view v);
  void value(const std::string& v) { value(std::string_view(v)); }
  void value(Hash v);
  template <std::integral T>
  void value(T v) { raw(std::to_string(v)); }
  template <class T>
    requires std::is_enum_v<T>
  void value(T v) { value(name(v)); }

  template <class T>
  void value(const std::vector<T>& list) {
    beginArray();
    for (const T& item : list) value(item);
    endArray();
  }
  template <class T, size_t N>
  void value(const std::array<T, N>& list) {
    beginArray();
    for (const T& item : list) value(item);
    endArray();
  }
  template <class T>
  void value(const std::vector<std::pair<std::string, T>>& map) {
    beginObject();
    for (const auto& [name, item] : map) field(name, item);
    endObject();
  }
  /// A struct of the schema; its generated writeFields is found by argument lookup.
  template <class T>
    requires requires(JsonWriter& w, const T& v) { writeFields(w, v); }
  void value(const T& v) {
    beginObject();
    writeFields(*this, v);
    endObject();
  }

  template <class T>
  void field(std::string_view name, const T& v) {
    key(name);
    value(v);
  }
  template <class T>
  void field(std::string_view name, const std::optional<T>& v) {
    if (v) field(name, *v);
  }

  std::string take() { return std::move(m_text); }

 private:
  void open(char bracket);
  void close(char bracket);
  void separate();
  void raw(std::string_view text);
  void quote(std::string_view text);

  std::string m_text;
  bool m_first = true;  // nothing stands before the next item in its object or array
};

/// A number as JavaScript's Number::toString writes it.
std::string javascriptNumber(double v);
/// As above, with the fewest digits that give the same float.
std::string javascriptNumber(float v);

}  // namespace limn::protocol
