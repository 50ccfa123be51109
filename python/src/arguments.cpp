#include "python/src/arguments.hpp"

#include <cmath>
#include <limits>

namespace lrb::python {
namespace {

/// -1 in a shape: any length.
std::string shape_text(std::span<const py::ssize_t> shape) {
  std::string out;
  for (const py::ssize_t n : shape) out += (out.empty() ? "" : ", ") + (n < 0 ? "n" : std::to_string(n));
  return "(" + out + (shape.size() == 1 ? ",)" : ")");
}
std::string shape_text(const py::array& a) {
  return shape_text(std::span(a.shape(), static_cast<std::size_t>(a.ndim())));
}

[[noreturn]] void reject(std::string_view what, std::string_view expected, const std::string& got) {
  throw InputError(std::string(what) + ": expected " + std::string(expected) + ", got " + got);
}

/// Rejects an array with masked values, and a list with such arrays.
void reject_masked(py::handle given, const std::string& what) {
  if (Py_TYPE(given.ptr()) == py::detail::npy_api::get().PyArray_Type_) return;
  if (PyList_Check(given.ptr()) != 0 || PyTuple_Check(given.ptr()) != 0) {
    std::size_t i = 0;
    for (const py::handle one : py::reinterpret_borrow<py::sequence>(given)) {
      if (py::isinstance<py::array>(one)) reject_masked(one, what + "[" + std::to_string(i) + "]");
      ++i;
    }
  } else if (py::isinstance<py::array>(given) && py::hasattr(given, "mask")) {
    const py::module_ numpy = py::module_::import("numpy");
    const py::list masked =
        numpy.attr("argwhere")(numpy.attr("ma").attr("getmaskarray")(given)).attr("tolist")();
    if (!masked.empty()) reject(what + std::string(py::str(masked[0])), "a value", "a masked one");
  }
}

/// Returns an argument as an array of any type; all arrays that functions take are read here. Rejects what is
/// no array, or of other kinds of elements (numpy.dtype.kind). An empty array may be of any type.
py::array any_array(py::handle given, std::string_view what, std::string_view expected,
                    std::string_view kinds) {
  reject_masked(given, std::string(what));
  const py::array found = py::array::ensure(given);
  if (!found || (found.size() > 0 && kinds.find(found.dtype().kind()) == std::string_view::npos))
    reject(what, expected, described(given));
  return found;
}

/// Returns an array of doubles; copies only if the argument is not one already.
Doubles any_numbers(py::handle given, std::string_view what, std::string_view expected) {
  constexpr double kExact = 9007199254740992;  // 2^53: doubles are exact for smaller integers
  if (Py_TYPE(given.ptr()) == py::detail::npy_api::get().PyArray_Type_ &&
      py::isinstance<py::array_t<double, py::array::c_style>>(given))
    return py::reinterpret_borrow<Doubles>(given);
  const py::array found = any_array(given, what, expected, "fiu");
  Doubles out = Doubles::ensure(found);
  if (found.itemsize() == sizeof(std::int64_t) && found.dtype().kind() != 'f')
    for (const double x : std::span(out.data(), static_cast<std::size_t>(out.size())))
      if (std::abs(x) >= kExact) reject(what, "integers below 2^53, which doubles represent", "larger ones");
  return out;
}

[[noreturn]] void reject_shape(std::string_view what, std::string_view expected, const py::array& found) {
  reject(what, expected, "shape " + shape_text(found));
}

constexpr const char* kPose = "numbers of shape (4, 4)";
constexpr const char* kPoses = "numbers of shape (4, 4) or (k, 4, 4)";

/// Reads a row-major matrix of 3 or 4 rows of 4.
Pose read_pose(const double* m, py::ssize_t rows, const char* what) {
  constexpr double kRounding = 1e-9;  // of the last row, after products and inverses
  for (int c = 0; rows == 4 && c < 4; ++c)
    if (!(std::abs(m[12 + c] - (c == 3 ? 1 : 0)) <= kRounding))
      throw InputError(std::string(what) + ": the last row of a pose must be 0 0 0 1");
  Pose out;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) out.r(r, c) = m[4 * r + c];
    out.t[r] = m[4 * r + 3];
  }
  return out;
}

Poses read_poses(py::handle given, const char* what, const char* expected) {
  Poses out;
  if (given.is_none()) return out;
  const Doubles m = any_numbers(given, what, expected);
  out.one = m.ndim() == 2;
  if (m.ndim() == 1 && m.size() == 0) return out;  // an empty list: no poses
  const py::ssize_t rows = m.ndim() >= 2 ? m.shape(m.ndim() - 2) : 0;
  if ((m.ndim() != 2 && m.ndim() != 3) || m.shape(m.ndim() - 1) != 4 || (rows != 3 && rows != 4))
    reject_shape(what, expected, m);
  if (out.one) {
    out.first = read_pose(m.data(), rows, what);
    return out;
  }
  out.many.reserve(static_cast<std::size_t>(m.shape(0)));
  for (py::ssize_t i = 0; i < m.shape(0); ++i)
    out.many.push_back(read_pose(m.data() + 4 * rows * i, rows, what));
  return out;
}

/// Reads points of shape (n, 3), or (n, 2) in 2D. Returns their number of coordinates.
int read_points(py::handle given, const char* what, std::vector<Eigen::Vector3d>& points) {
  constexpr const char* kPoints = "numbers of shape (n, 3), or (n, 2) in 2D";
  const Doubles v = any_numbers(given, what, kPoints);
  const bool empty = v.ndim() == 1 && v.size() == 0;  // an empty list
  if (!empty && (v.ndim() != 2 || (v.shape(1) != 3 && v.shape(1) != 2))) reject_shape(what, kPoints, v);
  const py::ssize_t n = empty ? 0 : v.shape(0), width = empty ? 3 : v.shape(1);
  points.resize(static_cast<std::size_t>(n));
  const double* x = v.data();
  for (Eigen::Vector3d& p : points) {
    p = {x[0], x[1], width == 3 ? x[2] : 0};
    x += width;
  }
  return static_cast<int>(width);
}

/// Checks the shape of an array. -1 in `shape`: any length.
template <class Array>
Array of_shape(Array found, const char* what, const std::vector<py::ssize_t>& shape,
               const std::string& expected) {
  bool fits = static_cast<std::size_t>(found.ndim()) == shape.size();
  for (std::size_t i = 0; fits && i < shape.size(); ++i)
    fits = shape[i] < 0 || shape[i] == found.shape(static_cast<py::ssize_t>(i));
  if (!fits) reject_shape(what, expected, found);
  return found;
}

/// Appends a face. Checks corners here, because ids are narrower than numpy's integers.
void add_face(std::span<const std::int64_t> corners, Mesh& mesh, std::vector<VertexId>& memory) {
  const bool fits = mesh.dim == 2 ? corners.size() == 2 : corners.size() >= 3;
  const std::string face = "faces: face " + std::to_string(mesh.face_count());
  if (!fits)
    throw InputError(face + " has " + std::to_string(corners.size()) + " corners, expected " +
                     (mesh.dim == 2 ? "2" : "3 or more"));
  memory.clear();
  for (const std::int64_t c : corners) {
    if (c < 0 || c >= static_cast<std::int64_t>(mesh.vertices.size()))
      reject(face, "a vertex index below " + std::to_string(mesh.vertices.size()), std::to_string(c));
    memory.push_back(VertexId(c));
  }
  mesh.add_face(memory);
}

Integers any_integers(py::handle given, std::string_view what, std::string_view expected) {
  const py::array found = any_array(given, what, expected, "iu");
  if (found.dtype().kind() == 'u' && found.itemsize() == sizeof(std::uint64_t)) {
    const auto all = py::array_t<std::uint64_t, py::array::c_style | py::array::forcecast>::ensure(found);
    for (const std::uint64_t n : std::span(all.data(), static_cast<std::size_t>(all.size())))
      if (n >> 63 != 0) reject(what, "integers below 2^63", std::to_string(n));
  }
  return Integers::ensure(found);
}

constexpr const char* kFaces = "integers of shape (m, 3); in 2D (m, 2)";

void add_equal_faces(const py::array& found, Mesh& mesh) {
  const Integers f = any_integers(found, "faces", kFaces);
  if (f.size() == 0) return;
  if (f.ndim() != 2) reject_shape("faces", kFaces, f);
  const auto width = static_cast<std::size_t>(f.shape(1));
  std::vector<VertexId> memory;
  mesh.face_vertices.reserve(static_cast<std::size_t>(f.size()));
  mesh.face_offsets.reserve(static_cast<std::size_t>(f.shape(0)) + 1);
  for (py::ssize_t i = 0; i < f.shape(0); ++i) add_face({f.data(i, 0), width}, mesh, memory);
}

/// Adds polygons with any numbers of corners.
void add_any_faces(const py::sequence& faces, Mesh& mesh) {
  std::vector<VertexId> memory;
  for (const py::handle face : faces) {
    const std::string what = "faces: face " + std::to_string(mesh.face_count());
    const Integers f = any_integers(face, what, "integers");
    if (f.ndim() != 1) reject_shape(what, "vertex indices", f);
    add_face({f.data(), static_cast<std::size_t>(f.size())}, mesh, memory);
  }
}

}  // namespace

Doubles numbers(const Argument& arg) {
  return any_numbers(arg.given, arg.name, "numbers");
}

Doubles numbers(const Argument& arg, const std::vector<py::ssize_t>& shape) {
  const std::string expected = "numbers of shape " + shape_text(shape);
  return of_shape(any_numbers(arg.given, arg.name, expected), arg.name, shape, expected);
}

Integers integers(const Argument& arg, const std::vector<py::ssize_t>& shape) {
  const std::string expected = "integers of shape " + shape_text(shape);
  return of_shape(any_integers(arg.given, arg.name, expected), arg.name, shape, expected);
}

std::string described(py::handle given) {
  if (py::isinstance<py::array>(given)) {
    const auto a = py::reinterpret_borrow<py::array>(given);
    return "an array of " + std::string(py::str(a.dtype())) + " of shape " + shape_text(a);
  }
  const std::string name = Py_TYPE(given.ptr())->tp_name;
  return given.is_none() ? "None" : name.substr(name.rfind('.') + 1);
}

py::str printable(std::string_view text) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "backslashreplace"));
}

py::list printable(const std::vector<std::string>& texts) {
  py::list out;
  for (const std::string& text : texts) out.append(printable(text));
  return out;
}

bool flag(const Argument& arg, bool fallback) {
  if (arg.is_none()) return fallback;
  if (arg.given.ptr() == Py_True) return true;
  if (arg.given.ptr() == Py_False) return false;
  const int truth = py::hasattr(arg.given, "dtype") ? PyObject_IsTrue(arg.given.ptr()) : -1;  // numpy.bool_
  if (truth >= 0) return truth == 1;
  PyErr_Clear();
  throw py::type_error(std::string(arg.name) + ": expected True or False, got " + described(arg.given));
}

double number(const Argument& arg, double fallback) {
  if (arg.is_none()) return fallback;
  const double x = PyFloat_AsDouble(arg.given.ptr());
  if (x == -1 && PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    throw py::type_error(std::string(arg.name) + ": expected a number, got " + described(arg.given));
  }
  return x;
}

double size(const Argument& arg, double fallback) {
  const double x = number(arg, fallback);
  if (!(x >= 0 && x <= std::numeric_limits<double>::max()))
    throw InputError(std::string(arg.name) + ": expected a finite number of at least 0, got " +
                     std::string(py::str(arg.given)));
  return x;
}

std::uint64_t count(const Argument& arg, std::uint64_t fallback) {
  if (arg.is_none()) return fallback;
  const auto index = py::reinterpret_steal<py::object>(PyNumber_Index(arg.given.ptr()));
  const std::uint64_t n = index ? PyLong_AsUnsignedLongLong(index.ptr()) : 0;
  if (PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    if (!index)
      throw py::type_error(std::string(arg.name) + ": expected an integer, got " + described(arg.given));
    throw InputError(std::string(arg.name) + ": expected an integer of at least 0, got " +
                     std::string(py::str(index)));
  }
  return n;
}

std::string text(const Argument& arg, const std::string& fallback) {
  if (arg.is_none()) return fallback;
  if (!py::isinstance<py::str>(arg.given))
    throw py::type_error(std::string(arg.name) + ": expected a str, got " + described(arg.given));
  py::ssize_t size = 0;
  const char* const utf8 = PyUnicode_AsUTF8AndSize(arg.given.ptr(), &size);
  if (utf8 == nullptr) {
    PyErr_Clear();
    throw InputError(std::string(arg.name) + ": expected a valid Unicode string, got a lone surrogate");
  }
  return {utf8, static_cast<std::size_t>(size)};
}

std::string path(const Argument& arg) {
  const auto found = py::reinterpret_steal<py::object>(PyOS_FSPath(arg.given.ptr()));
  if (!found) {
    PyErr_Clear();
    throw py::type_error(std::string(arg.name) + ": expected a path, got " + described(arg.given));
  }
  PyObject* bytes = nullptr;
  if (PyUnicode_FSConverter(found.ptr(), &bytes) == 0) throw py::error_already_set();
  return std::string(py::reinterpret_steal<py::bytes>(bytes));
}

py::str path_of(std::string_view path) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeFSDefaultAndSize(path.data(), static_cast<py::ssize_t>(path.size())));
}

Eigen::Vector3d vector(const Argument& arg) {
  const Doubles v = numbers(arg, {3});
  return {v.data()[0], v.data()[1], v.data()[2]};
}

Poses poses(const Argument& arg) {
  return read_poses(arg.given, arg.name, kPoses);
}

Pose pose(const Argument& arg) {
  const Poses found = read_poses(arg.given, arg.name, kPose);
  if (!found.one) reject(arg.name, kPose, std::to_string(found.many.size()) + " poses");
  return found.first;
}

Mesh mesh_of_arrays(py::handle vertices, py::handle faces, const std::string& name) {
  Mesh mesh;
  mesh.name = name;
  mesh.dim = read_points(vertices, "vertices", mesh.vertices);
  reject_masked(faces, "faces");
  const py::array found = py::array::ensure(faces);  // none if faces differ in their number of corners
  if (found && (found.dtype().kind() != 'O' || found.ndim() == 0))
    add_equal_faces(found, mesh);
  else if (py::isinstance<py::sequence>(faces) && !py::isinstance<py::str>(faces))
    add_any_faces(py::reinterpret_borrow<py::sequence>(faces), mesh);
  else
    reject("faces", kFaces, described(faces));
  return mesh;
}

std::vector<Eigen::Vector3d> points(const Argument& arg, int dim) {
  std::vector<Eigen::Vector3d> out;
  const int width = read_points(arg.given, arg.name, out);
  if (!out.empty() && width < dim)
    throw InputError(std::string(arg.name) + ": expected 3 coordinates of each point, found " +
                     std::to_string(width));
  return out;
}

}  // namespace lrb::python
