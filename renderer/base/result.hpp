#pragma once
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "renderer/base/check.hpp"

namespace limn {

/// What went wrong with somebody's input, and where: a file and a JSON pointer, a byte offset, a message seq.
struct Error {
  std::string code;     ///< stable word for programs: "bad-file", "out-of-range", "unsupported", "limit", "io", "device", ...
  std::string message;  ///< one sentence for people
  std::string place;    ///< "room.glb#/accessors/3/count"; empty when there is no place

  std::string text() const { return place.empty() ? message : place + ": " + message; }
};

/// A value or an Error. Bad input travels as a Result; a bug is a LIMN_CHECK.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : m_state(std::move(value)) {}
  Result(Error error) : m_state(std::move(error)) {}

  bool ok() const { return m_state.index() == 0; }
  explicit operator bool() const { return ok(); }
  T& value() { LIMN_CHECK(ok()); return *std::get_if<0>(&m_state); }
  const T& value() const { LIMN_CHECK(ok()); return *std::get_if<0>(&m_state); }
  T take() { LIMN_CHECK(ok()); return std::move(*std::get_if<0>(&m_state)); }
  T& operator*() { return value(); }
  const T& operator*() const { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  const Error& error() const { LIMN_CHECK(!ok()); return *std::get_if<1>(&m_state); }

 private:
  std::variant<T, Error> m_state;
};

/// Success or an Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : m_error(std::move(error)) {}
  bool ok() const { return !m_error; }
  explicit operator bool() const { return ok(); }
  const Error& error() const { LIMN_CHECK(m_error.has_value()); return *m_error; }

 private:
  std::optional<Error> m_error;
};

}  // namespace limn
