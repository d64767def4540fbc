// Result<T>: a value, or an Error that says what was tried, on what, why it failed and what to do.
// Member names are those of std::expected, so that it can become an alias once the baseline has C++23.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>

namespace [[gnu::visibility("default")]] duo {

enum class ErrorCode : std::uint8_t {
  kBadInput,     // what the user gave cannot be used (file, picture, rig, option)
  kNotFound,     // a file or device is not there
  kUnsupported,  // this build or this machine cannot do it
  kWriteFailed,  // the output could not be written whole
  kDeviceLost,   // a camera or GPU went away
  kExhausted,    // the machine has no more memory, threads or open files
};

struct Error {
  ErrorCode code = ErrorCode::kBadInput;
  std::string what;  // one line for the user
};

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : held_(std::in_place_index<0>, std::move(value)) {}      // NOLINT: return value;
  Result(Error error) : held_(std::in_place_index<1>, std::move(error)) {}  // NOLINT: return Error{…};

  bool has_value() const { return held_.index() == 0; }
  explicit operator bool() const { return has_value(); }
  T& value() & { return std::get<0>(held_); }
  const T& value() const& { return std::get<0>(held_); }
  T&& value() && { return std::get<0>(std::move(held_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  const Error& error() const { return std::get<1>(held_); }

 private:
  std::variant<T, Error> held_;
};

template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : failed_(true), error_(std::move(error)) {}  // NOLINT: return Error{…};

  bool has_value() const { return !failed_; }
  explicit operator bool() const { return has_value(); }
  const Error& error() const { return error_; }

 private:
  bool failed_ = false;
  Error error_;
};

}  // namespace duo

#define DUO_JOIN_INNER(a, b) a##b
#define DUO_JOIN(a, b) DUO_JOIN_INNER(a, b)

/// Runs `expression` (a Result<void>) and returns its error from the calling function, if it has one.
#define DUO_TRY(expression)                                                                 \
  do {                                                                                      \
    if (auto duo_result = (expression); !duo_result.has_value()) return duo_result.error(); \
  } while (false)

/// Declares `variable` with the value of `expression` (a Result<T>), or returns its error.
#define DUO_TRY_ASSIGN(variable, expression) DUO_TRY_ASSIGN_NAMED(DUO_JOIN(duo_result_, __LINE__), variable, expression)
#define DUO_TRY_ASSIGN_NAMED(result, variable, expression) \
  auto result = (expression);                              \
  if (!result.has_value()) return result.error();          \
  variable = std::move(*result)
