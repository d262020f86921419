#pragma once
#include <array>
#include <concepts>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/json_value.hpp"
#include "protocol/messages.gen.hpp"

namespace limn::protocol {

/// What the schema says about a field beyond its type. Numbers: of each component; length [byte] of each string.
struct Rules {
  double minimum = -std::numeric_limits<double>::infinity(), maximum = std::numeric_limits<double>::infinity();
  size_t maxLength = 1 << 20;
  size_t minItems = 0, maxItems = 1 << 24;
};

/// Where in the message reading is: a chain on the stack, written out as a JSON pointer only when something is wrong.
struct Place {
  const Place* parent = nullptr;
  std::string_view key;
  size_t index = 0;
  std::string pointer() const;
};

/// What one reading shares: how strict it is, and the first error.
struct ReadState {
  bool strict = true;
  std::optional<Error> error;
  /// Keeps the first error only. `code` as in the schema.
  void fail(std::string_view code, std::string message, const Place& place);
};

void readValue(ReadState& state, const Place& place, const JsonValue& json, bool& out, const Rules& rules);
void readValue(ReadState& state, const Place& place, const JsonValue& json, double& out, const Rules& rules);
void readValue(ReadState& state, const Place& place, const JsonValue& json, float& out, const Rules& rules);
void readValue(ReadState& state, const Place& place, const JsonValue& json, std::string& out, const Rules& rules);
void readValue(ReadState& state, const Place& place, const JsonValue& json, Hash& out, const Rules& rules);
/// A whole number within `rules`.
double readInteger(ReadState& state, const Place& place, const JsonValue& json, const Rules& rules);
/// Position of the string among `names`, -1 and an error when it is none of them.
int readName(ReadState& state, const Place& place, const JsonValue& json, std::span<const std::string_view> names);
const JsonValue::Array* readArray(ReadState& state, const Place& place, const JsonValue& json, size_t minItems, size_t maxItems);
const JsonValue::Object* readObject(ReadState& state, const Place& place, const JsonValue& json, size_t maxItems);

template <class E, size_t N>
std::optional<E> enumFromName(const std::array<std::string_view, N>& names, std::string_view name) {
  for (size_t i = 0; i < N; ++i)
    if (names[i] == name) return E(i);
  return std::nullopt;
}

/// The members of one JSON object while a struct is read from it.
class ObjectReader {
 public:
  ObjectReader(ReadState& state, const Place& place, const JsonValue& json);

  template <class T>
  void required(std::string_view name, T& out, const Rules& rules = {});
  template <class T>
  void optional(std::string_view name, std::optional<T>& out, const Rules& rules = {});
  /// Position of the member's string among `tags`; -1 and an error when it is missing or none of them.
  int tag(std::string_view name, std::span<const std::string_view> tags);
  /// Names a member that was read elsewhere.
  void skip(std::string_view name) { take(name); }
  /// Strict readings: a member that nobody asked for is an error.
  void finish();

 private:
  const JsonValue* take(std::string_view name);
  void missing(std::string_view name);

  ReadState& m_state;
  const Place& m_place;
  const JsonValue::Object* m_members;
  std::vector<bool> m_taken;
};

template <std::integral T>
void readValue(ReadState& state, const Place& place, const JsonValue& json, T& out, const Rules& rules) {
  out = T(readInteger(state, place, json, rules));
}

template <class T>
  requires std::is_enum_v<T>
void readValue(ReadState& state, const Place& place, const JsonValue& json, T& out, const Rules&) {
  const int index = readName(state, place, json, namesOf(T{}));
  if (index >= 0) out = T(index);
}

/// A struct or union of the schema; its generated readFields is found by argument lookup.
template <class T>
  requires requires(ObjectReader& o, T& v) { readFields(o, v); }
void readValue(ReadState& state, const Place& place, const JsonValue& json, T& out, const Rules&) {
  ObjectReader object(state, place, json);
  readFields(object, out);
  object.finish();
}

template <class T>
void readValue(ReadState& state, const Place& place, const JsonValue& json, std::vector<T>& out, const Rules& rules) {
  const JsonValue::Array* items = readArray(state, place, json, rules.minItems, rules.maxItems);
  if (!items) return;
  out.resize(items->size());
  for (size_t i = 0; i < out.size() && !state.error; ++i) readValue(state, Place{&place, {}, i}, (*items)[i], out[i], rules);
}

template <class T, size_t N>
void readValue(ReadState& state, const Place& place, const JsonValue& json, std::array<T, N>& out, const Rules& rules) {
  const JsonValue::Array* items = readArray(state, place, json, N, N);
  for (size_t i = 0; items && i < N; ++i) readValue(state, Place{&place, {}, i}, (*items)[i], out[i], rules);
}

template <class T>
void readValue(ReadState& state, const Place& place, const JsonValue& json, std::vector<std::pair<std::string, T>>& out,
               const Rules& rules) {
  const JsonValue::Object* members = readObject(state, place, json, rules.maxItems);
  if (!members) return;
  for (const auto& [name, member] : *members) {
    out.emplace_back(name, T{});
    readValue(state, Place{&place, name, 0}, member, out.back().second, rules);
  }
}

template <class T>
void ObjectReader::required(std::string_view name, T& out, const Rules& rules) {
  if (m_state.error) return;
  if (const JsonValue* json = take(name)) readValue(m_state, Place{&m_place, name, 0}, *json, out, rules);
  else missing(name);
}

template <class T>
void ObjectReader::optional(std::string_view name, std::optional<T>& out, const Rules& rules) {
  if (m_state.error) return;
  if (const JsonValue* json = take(name)) readValue(m_state, Place{&m_place, name, 0}, *json, out.emplace(), rules);
}

/// A text message taken apart as far as its op and seq.
class MessageReader {
 public:
  MessageReader(std::string_view text, size_t maxBytes, size_t maxDepth, bool strict);
  /// 0 when there is none that could be read.
  uint32_t seq() const { return m_seq; }
  /// Position of the op among `ops`, -1 when the message is already known to be wrong.
  int op(std::span<const std::string_view> ops) const;
  /// The reason why op() said -1.
  Error error() const { return *m_error; }

  template <class Variant, class Message>
  Result<Variant> read() const {
    ReadState state{m_strict, {}};
    const Place root;
    Message message;
    ObjectReader object(state, root, m_json);
    object.skip("op");
    readFields(object, message);
    object.finish();
    if (state.error) return placed(*state.error);
    return Variant(std::move(message));
  }

 private:
  Error placed(Error error) const;  ///< with "seq 12 " before the place

  bool m_strict;
  JsonValue m_json;
  uint32_t m_seq = 0;
  mutable std::optional<Error> m_error;
};

}  // namespace limn::protocol
