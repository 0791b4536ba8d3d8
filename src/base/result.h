// Result<T>: a value or an error message. Errors of external input (files, packets, scripts, numbers) are returned as
// results; nothing throws.
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace limber {

/// An error message for the user: the place, the problem, and how to fix it.
struct Error {
  std::string text;
};

/// Either a T or an Error. Check ok() before calling value().
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}
  Result(Error error) : state_(std::move(error)) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }
  T& value() { return std::get<0>(state_); }
  const T& value() const { return std::get<0>(state_); }
  T& operator*() { return value(); }
  const T& operator*() const { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  const std::string& error() const { return std::get<1>(state_).text; }

 private:
  std::variant<T, Error> state_;
};

/// Success, or an Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : failed_(true), error_(std::move(error)) {}

  bool ok() const { return !failed_; }
  explicit operator bool() const { return ok(); }
  const std::string& error() const { return error_.text; }

 private:
  bool failed_ = false;
  Error error_;
};

}  // namespace limber
