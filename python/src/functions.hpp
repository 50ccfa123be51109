#pragma once
/// How functions, methods and constructors are bound: each has a text that begins with its signature, and
/// reads its arguments by their names.

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "python/src/arguments.hpp"

namespace lrb::python {

/// The signature at the beginning of a text: "name(a, b=None, *, c=0)".
struct Signature {
  explicit Signature(std::string_view text);

  struct Parameter {
    std::string name;
    bool is_optional;
  };
  std::string name, parentheses;  ///< parentheses: their contents
  std::vector<Parameter> parameters;
  std::size_t positional = 0;  ///< number of parameters before "*"
};

/// The arguments of a call.
class Given {
 public:
  static constexpr std::size_t kMax = 16;  ///< number of parameters

  /// made: the object of a constructor. Throws TypeError for arguments that do not fit.
  Given(const Signature& signature, py::handle self, py::detail::value_and_holder* made,
        const py::args& positional, std::size_t begin, const py::kwargs& named);

  /// Returns an argument, None if it was not given. Fastest in the order of the signature.
  Argument operator[](std::string_view name) const;
  /// Returns None also for an argument that the function does not have; its name is null.
  Argument optional(std::string_view name) const;

  /// Returns the object whose method was called.
  template <class Class>
  Class& self() const {
    py::detail::make_caster<Class> found;
    if (self_.is_none() || !found.load(self_, true)) reject_self();
    return py::detail::cast_op<Class&>(found);
  }
  py::detail::value_and_holder& made() const { return *made_; }

 private:
  [[noreturn]] void reject(const std::string& why) const;
  [[noreturn]] void reject_self() const;

  const Signature& signature_;
  py::handle self_;
  py::detail::value_and_holder* made_;
  std::array<py::handle, kMax> values_;
  mutable std::size_t next_ = 0;  ///< where the next argument is expected
};

enum class Kind { function, static_method, method, constructor };

/// Adds a function to a module or a class. text: a signature, an empty line, the description. Arguments that
/// have a default are None in C++ if they are not given.
void add_function(py::handle scope, const char* text, Kind kind,
                  std::function<py::object(const Given&)> function);

/// Wraps function(), function(given), function(self) or function(self, given).
template <class Self, class Function>
std::function<py::object(const Given&)> wrapped(const Function& function) {
  const auto call = [function](const Given& given) -> decltype(auto) {
    if constexpr (std::is_invocable_v<const Function&>)
      return function();
    else if constexpr (std::is_invocable_v<const Function&, const Given&>)
      return function(given);
    else if constexpr (std::is_invocable_v<const Function&, Self&>)
      return function(given.self<Self>());
    else
      return function(given.self<Self>(), given);
  };
  return [call](const Given& given) -> py::object {
    if constexpr (std::is_void_v<decltype(call(given))>)
      return call(given), py::none();
    else if constexpr (std::is_base_of_v<py::object, decltype(call(given))>)
      return call(given);
    else
      return py::cast(call(given));
  };
}

/// Define a function of a module, or a method of a class.
template <class Function>
void define(py::module_& m, const char* text, const Function& function) {
  add_function(m, text, Kind::function, wrapped<int>(function));
}
template <class Self, class... Options, class Function>
void define(py::class_<Self, Options...>& c, const char* text, const Function& function) {
  add_function(c, text, Kind::method, wrapped<Self>(function));
}
template <class Class, class Function>
void define_static(Class& c, const char* text, const Function& function) {
  add_function(c, text, Kind::static_method, wrapped<int>(function));
}
/// Defines a constructor: function(given) returns the object, or a pointer to it as the class holds it.
template <class Class, class Function>
void define_constructor(Class& c, const char* text, const Function& function) {
  add_function(c, text, Kind::constructor, [function](const Given& given) -> py::object {
    py::detail::value_and_holder& made = given.made();
    py::detail::initimpl::construct<Class>(made, function(given), Py_TYPE(made.inst) != made.type->type);
    return py::none();
  });
}

}  // namespace lrb::python
