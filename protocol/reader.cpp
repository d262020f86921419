#include "protocol/reader.hpp"

#include <cmath>

#include "protocol/json_writer.hpp"

namespace limn::protocol {
namespace {

constexpr double kLargestInteger = 9007199254740991.0;  // 2^53 - 1: beyond it a double skips integers

void wrongType(ReadState& state, const Place& place, std::string_view expected, const JsonValue& json) {
  state.fail("bad-message", "expected " + std::string(expected) + ", found " + std::string(json.kind()), place);
}

const double* readNumber(ReadState& state, const Place& place, const JsonValue& json, const Rules& rules) {
  const double* number = json.number();
  if (!number) {
    wrongType(state, place, "a number", json);
    return nullptr;
  }
  if (*number >= rules.minimum && *number <= rules.maximum) return number;
  const bool below = *number < rules.minimum;
  state.fail("out-of-range", javascriptNumber(*number) + (below ? " is below " : " is above ") +
                                 javascriptNumber(below ? rules.minimum : rules.maximum), place);
  return nullptr;
}

}  // namespace

std::string Place::pointer() const {
  if (!parent) return "";
  std::string step;
  for (const char c : key) step += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return parent->pointer() + "/" + (key.data() ? step : std::to_string(index));
}

void ReadState::fail(std::string_view code, std::string message, const Place& place) {
  if (!error) error = Error{std::string(code), std::move(message), place.pointer()};
}

void readValue(ReadState& state, const Place& place, const JsonValue& json, bool& out, const Rules&) {
  if (const bool* v = json.boolean()) out = *v;
  else wrongType(state, place, "a boolean", json);
}

void readValue(ReadState& state, const Place& place, const JsonValue& json, double& out, const Rules& rules) {
  if (const double* v = readNumber(state, place, json, rules)) out = *v;
}

void readValue(ReadState& state, const Place& place, const JsonValue& json, float& out, const Rules& rules) {
  const double* v = readNumber(state, place, json, rules);
  if (!v) return;
  out = float(*v);
  if (!std::isfinite(out)) state.fail("out-of-range", javascriptNumber(*v) + " is too large for a 32-bit float", place);
}

void readValue(ReadState& state, const Place& place, const JsonValue& json, std::string& out, const Rules& rules) {
  const std::string* v = json.string();
  if (!v) return wrongType(state, place, "a string", json);
  if (v->size() > rules.maxLength)
    return state.fail("out-of-range", "longer than " + std::to_string(rules.maxLength) + " bytes", place);
  out = *v;
}

void readValue(ReadState& state, const Place& place, const JsonValue& json, Hash& out, const Rules&) {
  const std::string* v = json.string();
  const bool wellFormed = v && v->size() == 16 && v->find_first_not_of("0123456789abcdef") == std::string::npos;
  if (!wellFormed) return state.fail("bad-message", "expected 16 lower-case hexadecimal digits", place);
  out.value = std::stoull(*v, nullptr, 16);
}

double readInteger(ReadState& state, const Place& place, const JsonValue& json, const Rules& rules) {
  const double* v = readNumber(state, place, json, rules);
  if (!v) return 0.0;
  if (std::trunc(*v) == *v && std::fabs(*v) <= kLargestInteger) return *v;
  state.fail("bad-message", "expected a whole number, found " + javascriptNumber(*v), place);
  return 0.0;
}

int readName(ReadState& state, const Place& place, const JsonValue& json, std::span<const std::string_view> names) {
  const std::string* v = json.string();
  if (!v) {
    wrongType(state, place, "a string", json);
    return -1;
  }
  std::string list;
  for (size_t i = 0; i < names.size(); ++i) {
    if (names[i] == *v) return int(i);
    list += (i ? ", " : "") + std::string(names[i]);
  }
  state.fail("out-of-range", "expected one of " + list, place);
  return -1;
}

const JsonValue::Array* readArray(ReadState& state, const Place& place, const JsonValue& json, size_t minItems, size_t maxItems) {
  const JsonValue::Array* items = json.array();
  if (!items) {
    wrongType(state, place, "an array", json);
    return nullptr;
  }
  if (items->size() >= minItems && items->size() <= maxItems) return items;
  const std::string found = " items, found " + std::to_string(items->size());
  if (minItems == maxItems) state.fail("bad-message", "expected " + std::to_string(minItems) + found, place);
  else state.fail("out-of-range", "expected " + std::to_string(minItems) + " to " + std::to_string(maxItems) + found, place);
  return nullptr;
}

const JsonValue::Object* readObject(ReadState& state, const Place& place, const JsonValue& json, size_t maxItems) {
  const JsonValue::Object* members = json.object();
  if (!members) {
    wrongType(state, place, "an object", json);
    return nullptr;
  }
  if (members->size() <= maxItems) return members;
  state.fail("out-of-range", "more than " + std::to_string(maxItems) + " members", place);
  return nullptr;
}

ObjectReader::ObjectReader(ReadState& state, const Place& place, const JsonValue& json)
    : m_state(state), m_place(place), m_members(json.object()) {
  if (!m_members) wrongType(state, place, "an object", json);
  else m_taken.resize(m_members->size());
}

const JsonValue* ObjectReader::take(std::string_view name) {
  for (size_t i = 0; m_members && i < m_members->size(); ++i) {
    if ((*m_members)[i].first != name) continue;
    m_taken[i] = true;
    return &(*m_members)[i].second;
  }
  return nullptr;
}

int ObjectReader::tag(std::string_view name, std::span<const std::string_view> tags) {
  if (m_state.error) return -1;
  const JsonValue* json = take(name);
  if (json) return readName(m_state, Place{&m_place, name, 0}, *json, tags);
  missing(name);
  return -1;
}

void ObjectReader::missing(std::string_view name) {
  m_state.fail("bad-message", "field " + std::string(name) + " is missing", Place{&m_place, name, 0});
}

void ObjectReader::finish() {
  if (!m_state.strict || m_state.error) return;
  for (size_t i = 0; i < m_taken.size(); ++i)
    if (!m_taken[i]) return m_state.fail("bad-message", "unknown field", Place{&m_place, (*m_members)[i].first, 0});
}

MessageReader::MessageReader(std::string_view text, size_t maxBytes, size_t maxDepth, bool strict) : m_strict(strict) {
  if (text.size() > maxBytes) {
    m_error = Error{"limit", "a message of more than " + std::to_string(maxBytes) + " bytes", ""};
    return;
  }
  Result<JsonValue> parsed = parseJson(text, maxDepth);
  if (!parsed) {
    m_error = parsed.error();
    return;
  }
  m_json = parsed.take();
  if (!m_json.object()) {
    m_error = Error{"bad-message", "expected an object, found " + std::string(m_json.kind()), ""};
    return;
  }
  const JsonValue* seq = m_json.find("seq");
  const double* number = seq ? seq->number() : nullptr;
  if (number && *number >= 1.0 && *number <= 4294967295.0 && std::trunc(*number) == *number) m_seq = uint32_t(*number);
}

int MessageReader::op(std::span<const std::string_view> ops) const {
  if (m_error) return -1;
  const JsonValue* json = m_json.find("op");
  const std::string* word = json ? json->string() : nullptr;
  if (!word) {
    m_error = placed(Error{"bad-message", json ? "op is not a string" : "field op is missing", "/op"});
    return -1;
  }
  for (size_t i = 0; i < ops.size(); ++i)
    if (ops[i] == *word) return int(i);
  m_error = placed(Error{"unknown-op", "no such op", "/op"});
  return -1;
}

Error MessageReader::placed(Error error) const {
  if (m_seq != 0) error.place = "seq " + std::to_string(m_seq) + (error.place.empty() ? "" : " " + error.place);
  return error;
}

}  // namespace limn::protocol
