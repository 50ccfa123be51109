#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

namespace lrb {

/// Thrown for input that cannot be used. The message is one line that names the file, the line or element,
/// what was expected and what to do. Commands end with exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown when the machine cannot do what is asked (no off-screen context, disk full, a missing font).
/// Commands end with exit code 3.
class EnvironmentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// An answer, or the reason why there is none: for whatever a caller can foresee to fail, such as a file that
// is damaged or a pose that is not finite. (std::expected is of C++23; the names are its.)

/// Why something was refused: one line that names the file, the line or element, what was expected and what
/// to do.
struct Refusal {
  std::string reason;
  friend bool operator==(const Refusal&, const Refusal&) = default;
};

/// A T, which may be a reference, or a Refusal.
template <class T>
class [[nodiscard]] Expected {
  using Value = std::remove_reference_t<T>;
  using Kept = std::conditional_t<std::is_reference_v<T>, std::reference_wrapper<Value>, Value>;

 public:
  using value_type = T;

  /// Holds a T as T{} makes it.
  Expected() requires std::is_default_constructible_v<T> : kept_(std::in_place_index<0>) {}
  Expected(Kept value) : kept_(std::in_place_index<0>, std::move(value)) {}
  Expected(Value& value) requires std::is_reference_v<T> : kept_(std::in_place_index<0>, value) {}
  Expected(Refusal refusal) : kept_(std::in_place_index<1>, std::move(refusal)) {}

  bool has_value() const { return kept_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  /// Return the T. There must be one.
  Value& operator*() & requires(!std::is_reference_v<T>) { return *std::get_if<0>(&kept_); }
  const Value& operator*() const& requires(!std::is_reference_v<T>) { return *std::get_if<0>(&kept_); }
  Value&& operator*() && requires(!std::is_reference_v<T>) { return std::move(*std::get_if<0>(&kept_)); }
  Value* operator->() requires(!std::is_reference_v<T>) { return &**this; }
  const Value* operator->() const requires(!std::is_reference_v<T>) { return &**this; }
  // A reference refers to the same object, const or temporary as the Expected may be.
  Value& operator*() const& requires std::is_reference_v<T> { return *std::get_if<0>(&kept_); }
  Value* operator->() const requires std::is_reference_v<T> { return &**this; }

  /// Return the T. Throw the reason as an InputError if there is none.
  Value& value() & requires(!std::is_reference_v<T>) { return check(), **this; }
  const Value& value() const& requires(!std::is_reference_v<T>) { return check(), **this; }
  Value&& value() && requires(!std::is_reference_v<T>) { return check(), std::move(**this); }
  Value& value() const& requires std::is_reference_v<T> { return check(), **this; }

  /// Returns why there is none. There must not be one.
  const Refusal& error() const { return *std::get_if<1>(&kept_); }

  friend bool operator==(const Expected&, const Expected&) requires(!std::is_reference_v<T>) = default;

 private:
  void check() const {
    if (!has_value()) throw InputError(error().reason);
  }

  std::variant<Kept, Refusal> kept_;
};

}  // namespace lrb
