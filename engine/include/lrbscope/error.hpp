#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

namespace lrb {

/// Thrown for unusable input. The message is one line with the file, the line or element, the expected and
/// the found content, and a remedy. Commands exit with code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown if the machine cannot carry out a request (no off-screen context, disk full, missing font).
/// Commands exit with code 3.
class EnvironmentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Errors as values, for failures that a caller can foresee, such as a damaged file or a pose that is not
// finite. (Modelled on std::expected of C++23.)

/// An error: one line with the file, the line or element, the expected and the found content, and a remedy.
struct Error {
  std::string reason;
  friend bool operator==(const Error&, const Error&) = default;
};

// gcc warns of references that functions of a temporary return. Those of an Expected<T&> refer to an object
// elsewhere.
#if __has_cpp_attribute(gnu::no_dangling)
#define LRB_REFERS_ELSEWHERE [[gnu::no_dangling]]
#else
#define LRB_REFERS_ELSEWHERE
#endif

/// Either a value of type T, which may be a reference, or an error (Error).
template <class T>
class [[nodiscard]] Expected {
  using Value = std::remove_reference_t<T>;
  using Kept = std::conditional_t<std::is_reference_v<T>, std::reference_wrapper<Value>, Value>;

 public:
  using value_type = T;

  /// Contains a value-initialised T.
  Expected() requires std::is_default_constructible_v<T> : kept_(std::in_place_index<0>) {}
  Expected(Kept value) : kept_(std::in_place_index<0>, std::move(value)) {}
  Expected(Value& value) requires std::is_reference_v<T> : kept_(std::in_place_index<0>, value) {}
  Expected(Error error) : kept_(std::in_place_index<1>, std::move(error)) {}

  bool has_value() const { return kept_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  /// Return the value. Precondition: has_value().
  Value& operator*() & requires(!std::is_reference_v<T>) { return *std::get_if<0>(&kept_); }
  const Value& operator*() const& requires(!std::is_reference_v<T>) { return *std::get_if<0>(&kept_); }
  Value&& operator*() && requires(!std::is_reference_v<T>) { return std::move(*std::get_if<0>(&kept_)); }
  Value* operator->() requires(!std::is_reference_v<T>) { return &**this; }
  const Value* operator->() const requires(!std::is_reference_v<T>) { return &**this; }
  // If T is a reference, constness and value category of the Expected do not affect the referenced object.
  LRB_REFERS_ELSEWHERE Value& operator*() const& requires std::is_reference_v<T> {
    return *std::get_if<0>(&kept_);
  }
  Value* operator->() const requires std::is_reference_v<T> { return &**this; }

  /// Return the value. Throw InputError with the reason if there is none.
  Value& value() & requires(!std::is_reference_v<T>) { return check(), **this; }
  const Value& value() const& requires(!std::is_reference_v<T>) { return check(), **this; }
  Value&& value() && requires(!std::is_reference_v<T>) { return check(), std::move(**this); }
  LRB_REFERS_ELSEWHERE Value& value() const& requires std::is_reference_v<T> { return check(), **this; }

  /// Returns the error. Precondition: !has_value().
  const Error& error() const { return *std::get_if<1>(&kept_); }

  friend bool operator==(const Expected&, const Expected&) requires(!std::is_reference_v<T>) = default;

 private:
  void check() const {
    if (!has_value()) throw InputError(error().reason);
  }

  std::variant<Kept, Error> kept_;
};

#undef LRB_REFERS_ELSEWHERE

}  // namespace lrb
