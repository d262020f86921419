#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "renderer/base/result.hpp"

namespace limn::protocol {

/// A JSON text in memory. Numbers are doubles, as in JavaScript; members keep their order and are unique.
struct JsonValue {
  using Array = std::vector<JsonValue>;
  using Object = std::vector<std::pair<std::string, JsonValue>>;
  std::variant<std::monostate, bool, double, std::string, Array, Object> value;

  const bool* boolean() const { return std::get_if<bool>(&value); }
  const double* number() const { return std::get_if<double>(&value); }
  const std::string* string() const { return std::get_if<std::string>(&value); }
  const Array* array() const { return std::get_if<Array>(&value); }
  const Object* object() const { return std::get_if<Object>(&value); }
  /// A member of an object; null when there is none or this is no object.
  const JsonValue* find(std::string_view key) const;
  /// "a number", "an array" ... for error messages.
  std::string_view kind() const;
};

/// Reads one JSON text (RFC 8259, UTF-8 without byte order mark). Errors: "bad-message" with place "byte N" (from 0) for malformed
/// text, invalid UTF-8 and members that appear twice; "out-of-range" for numbers beyond double; "limit" for nesting deeper
/// than `maxDepth`. Any thread.
Result<JsonValue> parseJson(std::string_view text, size_t maxDepth);

}  // namespace limn::protocol
