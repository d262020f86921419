#include "renderer/scene/gltf_json.hpp"

#include <cmath>

namespace limn::gltf {
namespace {

const nlohmann::json kEmptyList = nlohmann::json::array();

/// A parsed value costs up to a hundred bytes, its text as little as two.
constexpr uint64_t kMaxValues = 32'000'000;

struct Extent {
  uint32_t depth = 0;   ///< deepest nesting of brackets
  uint64_t values = 1;  ///< at most as many
};

/// Looks at brackets and commas outside strings.
Extent extentOf(std::string_view text) {
  Extent extent;
  uint32_t depth = 0;
  bool inString = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (inString) {
      if (c == '\\') ++i;
      else if (c == '"') inString = false;
    } else if (c == '"') {
      inString = true;
    } else if (c == '{' || c == '[') {
      extent.depth = std::max(extent.depth, ++depth);
      ++extent.values;
    } else if ((c == '}' || c == ']') && depth > 0) {
      --depth;
    } else if (c == ',') {
      ++extent.values;
    }
  }
  return extent;
}

std::string shown(double v) {
  std::string text = nlohmann::json(v).dump();
  return text;
}

}  // namespace

Value Value::child(const nlohmann::json& json, const char* key, size_t index) const {
  Value v(*this);
  v.m_json = &json;
  if (m_depth < kMaxDepth) v.m_parts[v.m_depth++] = {key, index};
  return v;
}

std::string Value::pointer() const {
  std::string text;
  for (size_t i = 0; i < m_depth; ++i) {
    text += '/';
    if (!m_parts[i].key) {
      text += std::to_string(m_parts[i].index);
      continue;
    }
    for (const char* c = m_parts[i].key; *c; ++c) {  // RFC 6901
      if (*c == '~') text += "~0";
      else if (*c == '/') text += "~1";
      else text += *c;
    }
  }
  return text;
}

void Value::fail(std::string code, std::string message) const {
  gltf::fail(std::move(code), std::move(message), pointer());
}

const Value& Value::object() const {
  if (!m_json->is_object()) fail("bad-file", "must be an object");
  return *this;
}

const Value& Value::array(size_t least) const {
  if (!m_json->is_array()) fail("bad-file", "must be an array");
  if (m_json->size() < least) fail("bad-file", "must have at least " + std::to_string(least) + " elements");
  return *this;
}

std::optional<Value> Value::find(const char* key) const {
  object();
  const auto found = m_json->find(key);
  if (found == m_json->end()) return std::nullopt;
  return child(*found, key, 0);
}

Value Value::need(const char* key) const {
  const std::optional<Value> member = find(key);
  if (!member) fail("bad-file", std::string("\"") + key + "\" is missing");
  return *member;
}

Value Value::list(const char* key) const {
  const std::optional<Value> member = find(key);
  if (!member) return child(kEmptyList, key, 0);
  member->array();
  return *member;
}

std::optional<Value> Value::extension(const char* name) const {
  const std::optional<Value> all = find("extensions");
  if (!all) return std::nullopt;
  const std::optional<Value> one = all->object().find(name);
  if (one) one->object();
  return one;
}

uint64_t Value::asUnsigned(uint64_t low, uint64_t high) const {
  if (!m_json->is_number_integer()) fail("bad-file", "must be an integer");
  if (!m_json->is_number_unsigned() && m_json->get<int64_t>() < 0) fail("out-of-range", "must not be negative");
  const uint64_t v = m_json->get<uint64_t>();
  if (v < low || v > high) {
    fail("out-of-range", std::to_string(v) + " is not in " + std::to_string(low) + " to " + std::to_string(high));
  }
  return v;
}

uint32_t Value::asIndex(size_t count, const char* what) const {
  const uint64_t v = asUnsigned();
  if (v < count) return uint32_t(v);
  fail("out-of-range",
       std::string("there is no ") + what + " " + std::to_string(v) + ", there are " + std::to_string(count));
}

double Value::asNumber(double low, double high) const {
  if (!m_json->is_number()) fail("bad-file", "must be a number");
  const double v = m_json->get<double>();
  if (!(std::isfinite(v) && v >= low && v <= high)) {
    fail("out-of-range", shown(v) + " is not in " + shown(low) + " to " + shown(high));
  }
  return v;
}

const std::string& Value::asString() const {
  if (!m_json->is_string()) fail("bad-file", "must be a string");
  return m_json->get_ref<const std::string&>();
}

bool Value::asBool() const {
  if (!m_json->is_boolean()) fail("bad-file", "must be true or false");
  return m_json->get<bool>();
}

uint64_t Value::unsignedOr(const char* key, uint64_t fallback, uint64_t low, uint64_t high) const {
  const auto member = find(key);
  return member ? member->asUnsigned(low, high) : fallback;
}

int32_t Value::indexOr(const char* key, size_t count, const char* what) const {
  const auto member = find(key);
  return member ? int32_t(member->asIndex(count, what)) : -1;
}

double Value::numberOr(const char* key, double fallback, double low, double high) const {
  const auto member = find(key);
  return member ? member->asNumber(low, high) : fallback;
}

std::string Value::stringOr(const char* key, const char* fallback) const {
  const auto member = find(key);
  return member ? member->asString() : fallback;
}

bool Value::boolOr(const char* key, bool fallback) const {
  const auto member = find(key);
  return member ? member->asBool() : fallback;
}

std::vector<double> Value::numbers(const char* key, size_t count) const {
  const auto member = find(key);
  if (!member) return {};
  member->array();
  if (member->size() != count) member->fail("bad-file", "must have " + std::to_string(count) + " elements");
  std::vector<double> values(count);
  for (size_t i = 0; i < count; ++i) values[i] = (*member)[i].asNumber();
  return values;
}

nlohmann::json parseJson(std::string_view text, uint32_t maxDepth) {
  const Extent extent = extentOf(text);
  if (extent.depth > maxDepth) {
    gltf::fail("limit", "the JSON nests deeper than " + std::to_string(maxDepth) + " levels", "");
  }
  if (extent.values > kMaxValues) {
    gltf::fail("limit", "the JSON holds more than " + std::to_string(kMaxValues) + " values", "");
  }
  try {
    return nlohmann::json::parse(text.begin(), text.end());
  } catch (const nlohmann::json::parse_error& e) {
    gltf::fail("bad-json", "not JSON: byte " + std::to_string(e.byte) + " is not what should stand there", "");
  } catch (const nlohmann::json::exception&) {  // a number beyond double
    gltf::fail("bad-json", "not JSON: a number cannot be held", "");
  }
}

}  // namespace limn::gltf
