#include "protocol/json_value.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace limn::protocol {
namespace {

/// Builds a JsonValue from nlohmann's events; stops at the first thing that is wrong.
class Builder : public nlohmann::json_sax<nlohmann::json> {
 public:
  Builder(JsonValue& root, size_t maxDepth) : m_root(root), m_maxDepth(maxDepth) {}
  Error error;

  bool null() override { return put(std::monostate{}); }
  bool boolean(bool v) override { return put(v); }
  bool number_integer(number_integer_t v) override { return put(double(v)); }
  bool number_unsigned(number_unsigned_t v) override { return put(double(v)); }
  bool number_float(number_float_t v, const string_t&) override { return put(double(v)); }
  bool string(string_t& v) override { return put(std::move(v)); }
  bool binary(binary_t&) override { return fail("bad-message", "binary data in JSON"); }
  bool start_array(size_t) override { return open<JsonValue::Array>(); }
  bool start_object(size_t) override { return open<JsonValue::Object>(); }
  bool end_array() override { return close(); }
  bool end_object() override { return close(); }

  bool key(string_t& name) override {
    auto& members = std::get<JsonValue::Object>(m_open.back()->value);
    const auto same = [&](const auto& member) { return member.first == name; };
    if (std::any_of(members.begin(), members.end(), same)) return fail("bad-message", "member \"" + name + "\" appears twice");
    if (members.size() >= kMaxMembers) return fail("limit", "an object has more than " + std::to_string(kMaxMembers) + " members");
    members.emplace_back(std::move(name), JsonValue{});
    return true;
  }

  bool parse_error(size_t byte, const std::string&, const nlohmann::detail::exception& e) override {
    const bool range = e.id == 406;  // a number that double cannot hold
    const std::string place = "byte " + std::to_string(byte > 0 ? byte - 1 : 0);  // nlohmann counts bytes read
    error = range ? Error{"out-of-range", "a number is too large", place} : Error{"bad-message", "malformed JSON", place};
    return false;
  }

 private:
  static constexpr size_t kMaxMembers = 256;  // keeps the search for doubles cheap

  bool fail(const char* code, std::string message) {
    error = {code, std::move(message), ""};
    return false;
  }

  /// Where the next value belongs; null as yet.
  JsonValue& slot() {
    if (m_open.empty()) return m_root;
    if (auto* array = std::get_if<JsonValue::Array>(&m_open.back()->value)) return array->emplace_back();
    return std::get<JsonValue::Object>(m_open.back()->value).back().second;
  }

  template <class T>
  bool put(T&& v) {
    slot().value.emplace<std::remove_cvref_t<T>>(std::forward<T>(v));
    return true;
  }

  template <class T>
  bool open() {
    if (m_open.size() >= m_maxDepth) return fail("limit", "nested deeper than " + std::to_string(m_maxDepth));
    m_open.push_back(&slot());
    m_open.back()->value.emplace<T>();
    return true;
  }

  bool close() {
    m_open.pop_back();
    return true;
  }

  JsonValue& m_root;
  size_t m_maxDepth;
  std::vector<JsonValue*> m_open;  // from the root to where values are added; parents do not move while a child is open
};

}  // namespace

const JsonValue* JsonValue::find(std::string_view key) const {
  const Object* members = object();
  if (!members) return nullptr;
  for (const auto& [name, member] : *members)
    if (name == key) return &member;
  return nullptr;
}

std::string_view JsonValue::kind() const {
  static constexpr std::array<std::string_view, 6> kKinds{"null", "a boolean", "a number", "a string", "an array", "an object"};
  return kKinds[value.index()];
}

Result<JsonValue> parseJson(std::string_view text, size_t maxDepth) {
  if (text.starts_with("\xEF\xBB\xBF")) return Error{"bad-message", "a byte order mark", "byte 0"};
  JsonValue root;
  Builder builder(root, maxDepth);
  if (!nlohmann::json::sax_parse(text.begin(), text.end(), &builder)) return builder.error;
  return root;
}

}  // namespace limn::protocol
