#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "renderer/base/result.hpp"

namespace limn::gltf {

/// Thrown inside the loader only; loadGltf turns it into its Result. `pointer` is a JSON pointer ("/accessors/3/count")
/// or empty.
struct Fault {
  std::string code, message, pointer;
};
[[noreturn]] inline void fail(std::string code, std::string message, std::string pointer) {
  throw Fault{std::move(code), std::move(message), std::move(pointer)};
}

/// "/meshes/3/primitives/0" from its parts.
template <class... Parts>
std::string pointerOf(const Parts&... parts) {
  std::string text;
  const auto add = [&](const auto& part) {
    text += '/';
    if constexpr (std::is_convertible_v<decltype(part), std::string_view>) text += part;
    else text += std::to_string(part);
  };
  (add(parts), ...);
  return text;
}

/// A JSON value and the way to it, so that every complaint can name its place; the text is made only when something is
/// wrong. Reading checks type and range. A small value; the document and the key texts given to it must outlive it.
class Value {
 public:
  explicit Value(const nlohmann::json& root) : m_json(&root) {}

  const nlohmann::json& json() const { return *m_json; }
  std::string pointer() const;
  [[noreturn]] void fail(std::string code, std::string message) const;

  /// This value must be an object; an array of at least `least` elements. Otherwise bad-file.
  const Value& object() const;
  const Value& array(size_t least = 0) const;
  size_t size() const { return m_json->size(); }
  Value operator[](size_t index) const { return child((*m_json)[index], nullptr, index); }
  bool has(const char* key) const { return m_json->is_object() && m_json->contains(key); }
  std::optional<Value> find(const char* key) const;
  Value need(const char* key) const;
  /// The array `key`, or an empty one.
  Value list(const char* key) const;
  /// extensions.<name>, which must be an object if it is there.
  std::optional<Value> extension(const char* name) const;

  /// This value itself, checked.
  uint64_t asUnsigned(uint64_t low = 0, uint64_t high = kAnyUnsigned) const;
  uint32_t asIndex(size_t count, const char* what) const;  ///< out-of-range unless below count
  double asNumber(double low = -kAnyNumber, double high = kAnyNumber) const;
  const std::string& asString() const;
  bool asBool() const;

  /// Optional members.
  uint64_t unsignedOr(const char* key, uint64_t fallback, uint64_t low = 0, uint64_t high = kAnyUnsigned) const;
  int32_t indexOr(const char* key, size_t count, const char* what) const;  ///< -1 when absent
  double numberOr(const char* key, double fallback, double low = -kAnyNumber, double high = kAnyNumber) const;
  std::string stringOr(const char* key, const char* fallback) const;
  bool boolOr(const char* key, bool fallback) const;
  /// Exactly `count` finite numbers, or an empty vector when absent.
  std::vector<double> numbers(const char* key, size_t count) const;

  static constexpr uint64_t kAnyUnsigned = std::numeric_limits<uint64_t>::max();
  static constexpr double kAnyNumber = std::numeric_limits<double>::max();

 private:
  struct Part {
    const char* key;
    size_t index;
  };                                       // key null: an element
  static constexpr size_t kMaxDepth = 12;  // deeper values tell their ancestor's place

  Value child(const nlohmann::json& json, const char* key, size_t index) const;

  const nlohmann::json* m_json;
  Part m_parts[kMaxDepth] = {};
  size_t m_depth = 0;
};

/// Parses a document whose nesting is at most `maxDepth`; the depth is looked at before anything is built.
/// Throws Fault bad-json, limit.
nlohmann::json parseJson(std::string_view text, uint32_t maxDepth);

}  // namespace limn::gltf
