#pragma once
/// How classes are bound: properties from members of answers.

#include <array>
#include <concepts>
#include <functional>
#include <ranges>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "python/src/arguments.hpp"
#include "python/src/pickle.hpp"
#include <lrbscope/clash.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/core/fields.hpp>
#include <lrbscope/ids.hpp>

namespace lrb::python {

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

/// Returns an array of str.
py::array array_of(const std::vector<std::string>& texts);

/// Returns an array with get(item) for each item: a member, or a function of it.
template <class Items, class Get>
auto column(const Items& items, const Get& get) {
  using Item = std::remove_cvref_t<decltype(std::invoke(get, *std::begin(items)))>;
  if constexpr (std::same_as<Item, std::string>) {
    std::vector<std::string> all;
    for (const auto& item : items) all.push_back(std::invoke(get, item));
    return array_of(all);
  } else {
    using Value = Numbers<Item>;
    std::vector<py::ssize_t> shape = Value::shape();
    shape.insert(shape.begin(), static_cast<py::ssize_t>(std::size(items)));
    py::array_t<typename Value::Type> out(shape);
    auto* to = out.mutable_data();
    for (const auto& item : items) Value::write(std::invoke(get, item), to);
    return out;
  }
}

/// True for lists of numbers, ids or vectors, and of arrays of these.
template <class Value>
inline constexpr bool IsNumber = std::is_arithmetic_v<Value> || std::is_convertible_v<Value, std::uint32_t> ||
                                 std::same_as<Value, Eigen::Vector3d>;
template <class Value, std::size_t n>
inline constexpr bool IsNumber<std::array<Value, n>> = IsNumber<Value>;
template <class Value>
concept IsNumbers = std::ranges::range<Value> && !std::convertible_to<Value, std::string_view> &&
                    IsNumber<std::ranges::range_value_t<Value>>;

template <class Value>
concept IsTwoOfNumbers = requires {
  std::tuple_size<Value>::value;
  typename Value::value_type;
}
&&std::tuple_size_v<Value> == 2 && IsNumbers<typename Value::value_type>;

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
    return column(std::span(value.data(), 3), std::identity());
  else if constexpr (std::is_class_v<Value> && std::convertible_to<Value, std::uint32_t>)
    return value == kNull ? py::object(py::none()) : py::int_(value.value());
  else if constexpr (requires { *value, value.has_value(); })
    return value ? to_python(*value) : py::none();
  else if constexpr (IsNumbers<Value>)
    return column(value, std::identity());
  else if constexpr (IsTwoOfNumbers<Value>)
    return py::make_tuple(to_python(value[0]), to_python(value[1]));
  else
    return py::cast(value);
}

/// Adds a read-only property: a member of the class, or a function of an object.
template <class Class, class Get>
void property(Class& c, const char* name, const char* text, const Get& get) {
  c.def_property_readonly(
      name, [get](const typename Class::type& self) { return to_python(std::invoke(get, self)); }, text);
}

/// Returns a function that adds properties of a part of the object: of(self), a member or a function.
template <class Class, class Part>
auto properties_of(Class& c, const Part& of) {
  return [&c, of](const char* name, const char* text, const auto& get) {
    property(c, name, text,
             [of, get](const auto& self) { return to_python(std::invoke(get, std::invoke(of, self))); });
  };
}

/// Returns a function that adds arrays with get(item) for each of items(self).
template <class Class, class Items>
auto columns_of(Class& c, const Items& items) {
  return [&c, items](const char* name, const char* text, const auto& get) {
    property(c, name, text, [items, get](const auto& self) { return column(std::invoke(items, self), get); });
  };
}

/// As columns_of(), for the items that are the object's length and are called `what` in its display. Such
/// objects are data: they can be pickled.
template <class Class, class Items>
auto rows_of(Class& c, const std::string& what, const Items& items) {
  const auto size = [items](const typename Class::type& self) { return std::size(std::invoke(items, self)); };
  const std::string begin = "<lrbscope." + std::string(py::str(c.attr("__name__"))) + " of ";
  c.def("__len__", size);
  c.def("__repr__", [=](const typename Class::type& self) {
    return begin + std::to_string(size(self)) + " " + what + ">";
  });
  make_picklable(c);
  return columns_of(c, items);
}

/// Returns counters, a record with a table of fields, as a dict.
template <class Counters>
py::dict dict_of(const Counters& counters) {
  py::dict d;
  for_each_field<Counters>([&](const auto& field) { d[field.name.data()] = counters.*field.member; });
  return d;
}
inline constexpr const char* kCountersText = "dict of int: the work, in numbers of operations.";

/// Returns a JSON text as dicts and lists.
py::object parsed_json(const std::string& json);

/// Returns an index as Python counts, from the end if negative. Throws IndexError if it is out of range.
std::size_t checked_index(py::ssize_t i, std::size_t n);
std::size_t checked_index(const py::object& i, std::size_t n);

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
template <class Result>
void members(Archive& archive, Sequence<Result>& x) {
  archive(x.all);
}

/// Defines a sequence of answers, with an item or a list of them by slices; rows_of() defines its length.
template <class All>
py::class_<All> bind_sequence(py::module_& m, const char* name, const char* text) {
  py::class_<All> c(m, name, text);
  c.def("__getitem__", [](const All& s, const py::object& which) -> py::object {
    if (!py::isinstance<py::slice>(which)) return py::cast(s.all[checked_index(which, s.all.size())]);
    std::size_t begin, end, step, n;
    if (!which.cast<py::slice>().compute(s.all.size(), &begin, &end, &step, &n))
      throw py::error_already_set();
    py::list out;
    for (; n > 0; --n, begin += step) out.append(s.all[begin]);
    return out;
  });
  bind_iterator(c);
  return c;
}

}  // namespace lrb::python
