#pragma once
/// Converts Python arguments to the engine's types. All functions throw InputError with a one-line message
/// that names the argument, or TypeError if an argument is of an unrelated type. The GIL must be held.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <lrbscope/enum_names.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/pose.hpp>

namespace lrb::python {

namespace py = pybind11;

/// Returns the description for an error message: an object's type or, for an array, its shape and dtype.
std::string described(py::handle given);

/// Returns a text for display, with \xff for each byte that is not UTF-8; file names may have such bytes.
py::str printable(std::string_view text);
py::list printable(const std::vector<std::string>& texts);

/// An argument of a function, and its name for messages.
struct Argument {
  py::handle given;
  const char* name;

  bool is_none() const { return given.is_none(); }
};

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Integers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
/// Return an argument as an array, of this shape (-1: any length). Masked values are rejected.
Doubles numbers(const Argument& arg);
Doubles numbers(const Argument& arg, const std::vector<py::ssize_t>& shape);
Integers integers(const Argument& arg, const std::vector<py::ssize_t>& shape);

/// Return an argument as a number or a flag; `fallback` for None.
bool flag(const Argument& arg, bool fallback = false);
double number(const Argument& arg, double fallback = 0);
double size(const Argument& arg, double fallback = 0);  ///< finite, at least 0
std::uint64_t count(const Argument& arg, std::uint64_t fallback = 0);
std::string text(const Argument& arg, const std::string& fallback = {});
/// Returns a path, given as str, bytes or os.PathLike.
std::string path(const Argument& arg);
/// Returns a path as a Python str that open() accepts.
py::str path_of(std::string_view path);
/// Returns three numbers as a vector.
Eigen::Vector3d vector(const Argument& arg);

/// Returns the enumerator of a word; `fallback` for None.
template <class Enum>
Enum word(const Argument& arg, Enum fallback) {
  if (arg.is_none()) return fallback;
  const std::string name = text(arg);
  if (const auto value = from_name<Enum>(name)) return *value;
  throw InputError(std::string(arg.name) + ": \"" + name + "\" is not one of " + all_names<Enum>());
}

/// Poses of a body: one, or many.
struct Poses {
  bool one = true;
  Pose first;              ///< if `one`
  std::vector<Pose> many;  ///< if not `one`: a single query does not allocate

  std::vector<Pose> to_vector() const { return one ? std::vector<Pose>{first} : many; }
};
/// Reads (4, 4) or (3, 4) as one pose, (k, 4, 4) or (k, 3, 4) as many; None is the identity.
Poses poses(const Argument& arg);
/// Reads one pose; throws for many.
Pose pose(const Argument& arg);

/// Reads points (n, 3); for a body in 2D also (n, 2).
std::vector<Eigen::Vector3d> points(const Argument& arg, int dim);

/// Makes a mesh from arrays: vertices (n, 3) and faces (m, k) with k >= 3, or a sequence of sequences; in 2D
/// vertices (n, 2) and segments (m, 2).
Mesh mesh_of_arrays(py::handle vertices, py::handle faces, const std::string& name);

/// Returns a read-only array that views memory of `owner` and keeps it alive. T: element type as in numpy.
/// strides: in bytes; empty for contiguous numbers.
template <class T>
py::array_t<T> view(std::vector<py::ssize_t> shape, const T* data, py::handle owner,
                    std::vector<py::ssize_t> strides = {}) {
  py::array_t<T> out(std::move(shape), std::move(strides), data, owner);
  py::detail::array_proxy(out.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return out;
}
/// Views ids as an array (n / columns, columns), or (n) for one column.
template <class Id>
py::array_t<std::uint32_t> view_of_ids(std::span<const Id> ids, py::ssize_t columns, py::handle owner) {
  static_assert(sizeof(Id) == sizeof(std::uint32_t));
  const auto n = static_cast<py::ssize_t>(ids.size());
  std::vector<py::ssize_t> shape{columns > 1 ? n / columns : n};
  if (columns > 1) shape.push_back(columns);
  return view(std::move(shape), reinterpret_cast<const std::uint32_t*>(ids.data()), owner);
}

}  // namespace lrb::python
