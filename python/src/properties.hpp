#pragma once
/// How functions and classes are bound: signatures from their texts, properties from members of answers.

#include <array>
#include <concepts>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "python/src/arguments.hpp"
#include <lrbscope/clash.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/ids.hpp>

namespace lrb::python {

/// The text of a function, which begins with its signature: "name(a, b=None, *, c=0)", an empty line, the
/// description. Arguments that have a default are None in C++ if they are not given.
class Signature {
 public:
  explicit Signature(const char* text);
  const char* name() const { return name_.c_str(); }
  void apply(py::detail::function_record& function) const;

 private:
  struct Argument {
    std::string name;
    bool is_optional;
  };
  const char* text_;
  std::string name_;
  std::vector<Argument> arguments_;
  std::size_t positional_ = 0;  ///< number of arguments before "*"
};

/// Defines a function of a module, or a method of a class.
template <class Scope, class Function>
void define(Scope& scope, Function&& function, const char* text) {
  const Signature signature(text);
  scope.def(signature.name(), std::forward<Function>(function), signature);
}

/// The numbers of a value in an array: their type and the value's own dimensions.
template <class Value>
struct Numbers {
  using Type = std::conditional_t<std::is_arithmetic_v<Value>, Value,
                                  std::conditional_t<std::is_enum_v<Value>, std::uint8_t, std::uint32_t>>;
  static std::vector<py::ssize_t> shape() { return {}; }
  static void write(const Value& value, Type*& to) { *to++ = static_cast<Type>(value); }
};
template <>
struct Numbers<Eigen::Vector3d> {
  using Type = double;
  static std::vector<py::ssize_t> shape() { return {3}; }
  static void write(const Eigen::Vector3d& v, double*& to) { to = std::copy(v.data(), v.data() + 3, to); }
};
template <class Value, std::size_t n>
struct Numbers<std::array<Value, n>> {
  using Type = typename Numbers<Value>::Type;
  static std::vector<py::ssize_t> shape() {
    std::vector<py::ssize_t> out = Numbers<Value>::shape();
    out.insert(out.begin(), static_cast<py::ssize_t>(n));
    return out;
  }
  static void write(std::span<const Value, n> values, Type*& to) {
    for (const Value& value : values) Numbers<Value>::write(value, to);
  }
};
template <class Value, std::size_t n>
struct Numbers<Value[n]> : Numbers<std::array<Value, n>> {};

/// Returns an array with get(item) for each item: a member, or a function of it.
template <class Items, class Get>
auto column(const Items& items, const Get& get) {
  using Value = Numbers<std::remove_cvref_t<decltype(std::invoke(get, *std::begin(items)))>>;
  std::vector<py::ssize_t> shape = Value::shape();
  shape.insert(shape.begin(), static_cast<py::ssize_t>(std::size(items)));
  py::array_t<typename Value::Type> out(shape);
  auto* to = out.mutable_data();
  for (const auto& item : items) Value::write(std::invoke(get, item), to);
  return out;
}

/// Returns the triangles, or the faces, of a pair as an array's row.
inline constexpr auto kPairOf = [](const auto& pair) { return std::array{pair.a, pair.b}; };

/// Converts a value of an answer: enumerators to str, ids to int, vectors and lists to arrays, intervals and
/// arrays of two to tuples, what is missing or unknown to None.
template <class Value>
py::object to_python(const Value& value) {
  if constexpr (std::derived_from<Value, py::object>)
    return value;
  else if constexpr (std::same_as<Value, lrb::Answer>)
    return value == lrb::Answer::unknown ? py::object(py::none()) : py::bool_(value == lrb::Answer::yes);
  else if constexpr (std::is_enum_v<Value>)
    return py::str(std::string(name_of(value)));
  else if constexpr (std::same_as<Value, ProvedInterval>)
    return py::make_tuple(value.lower, value.upper);
  else if constexpr (std::same_as<Value, Eigen::Vector3d>)
    return array_of(value);
  else if constexpr (std::is_class_v<Value> && std::convertible_to<Value, std::uint32_t>)
    return value == kNull ? py::object(py::none()) : py::int_(value.value());
  else if constexpr (requires { *value, value.has_value(); })
    return value ? to_python(*value) : py::none();
  else
    return py::cast(value);
}

/// Adds a read-only property: a member of the class, or a function of an object.
template <class Class, class Get>
void property(Class& c, const char* name, const Get& get, const char* text) {
  c.def_property_readonly(
      name, [get](const typename Class::type& self) { return to_python(std::invoke(get, self)); }, text);
}

/// Returns counters as a dict.
py::dict dict_of(std::initializer_list<std::pair<const char*, std::uint64_t>> counters);

/// Returns an index as Python counts, from the end if negative. Throws IndexError if it is out of range.
std::size_t checked_index(py::ssize_t i, std::size_t n);

/// Adds an iterator to a list-like class. Type checkers and isinstance() require one for iterables.
template <class Class>
void bind_iterator(Class& c) {
  c.def("__iter__", [](const py::object& self) {
    self.cast<const typename Class::type&>();  // raises TypeError for an object without a value
    return py::reinterpret_steal<py::object>(PySeqIter_New(self.ptr()));
  });
}

/// Answers in the order of the queries.
template <class Result>
struct Sequence {
  std::vector<Result> all;
};

/// Defines a sequence of answers. `name`: of the class; `what`: the queries, in its display.
template <class Result>
py::class_<Sequence<Result>> bind_sequence(py::module_& m, const std::string& name, const std::string& what,
                                           const char* text) {
  using All = Sequence<Result>;
  py::class_<All> c(m, name.c_str(), text);
  c.def("__len__", [](const All& s) { return s.all.size(); });
  c.def("__getitem__", [](const All& s, py::ssize_t i) { return s.all[checked_index(i, s.all.size())]; });
  bind_iterator(c);
  c.def("__repr__", [name, what](const All& s) {
    return "<lrbscope." + name + " of " + std::to_string(s.all.size()) + " " + what + ">";
  });
  return c;
}

}  // namespace lrb::python

template <>
struct pybind11::detail::process_attribute<lrb::python::Signature>
    : process_attribute_default<lrb::python::Signature> {
  static void init(const lrb::python::Signature& signature, function_record* function) {
    signature.apply(*function);
  }
};
