#include "python/src/arguments.hpp"

#include <cmath>
#include <limits>

namespace lrb::python {
namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Integers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

std::string shape_text(const py::array& a) {
  std::string out = "(";
  for (py::ssize_t i = 0; i < a.ndim(); ++i) out += (i > 0 ? ", " : "") + std::to_string(a.shape(i));
  return out + (a.ndim() == 1 ? ",)" : ")");
}

/// Returns an argument as an array of any type, or an empty handle if it cannot be converted.
py::array any_array(py::handle given) {
  return py::array::ensure(given);
}

/// Returns an array of doubles; copies only if the argument is not one already.
Numbers numbers(py::handle given, const char* what, const char* expected) {
  if (py::isinstance<py::array_t<double, py::array::c_style>>(given))
    return py::reinterpret_borrow<Numbers>(given);
  const py::array found = any_array(given);
  const bool fits = found && std::string_view("fiu").find(found.dtype().kind()) != std::string_view::npos;
  if (!fits) throw InputError(std::string(what) + ": expected " + expected + ", got " + described(given));
  return Numbers::ensure(found);
}

[[noreturn]] void reject_shape(const char* what, const char* expected, const py::array& found) {
  throw InputError(std::string(what) + ": expected " + expected + ", got shape " + shape_text(found));
}

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

/// Reads points of shape (n, 3), or (n, 2) in 2D. Returns their number of coordinates.
int read_points(py::handle given, const char* what, std::vector<Eigen::Vector3d>& points) {
  const Numbers v = numbers(given, what, "numbers of shape (n, 3)");
  const bool empty = v.ndim() == 1 && v.size() == 0;  // an empty list
  if (!empty && (v.ndim() != 2 || (v.shape(1) != 3 && v.shape(1) != 2)))
    reject_shape(what, "shape (n, 3), or (n, 2) in 2D", v);
  const py::ssize_t n = empty ? 0 : v.shape(0), width = empty ? 3 : v.shape(1);
  points.resize(static_cast<std::size_t>(n));
  const double* x = v.data();
  for (Eigen::Vector3d& p : points) {
    p = {x[0], x[1], width == 3 ? x[2] : 0};
    x += width;
  }
  return static_cast<int>(width);
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
      throw InputError(face + ": expected a vertex index below " + std::to_string(mesh.vertices.size()) +
                       ", got " + std::to_string(c));
    memory.push_back(VertexId(c));
  }
  mesh.add_face(memory);
}

Integers integers(const py::array& found, const char* what) {
  if (found.size() > 0 && std::string_view("iu").find(found.dtype().kind()) == std::string_view::npos)
    throw InputError(std::string(what) + ": expected integers, got " + described(found));
  return Integers::ensure(found);
}

void add_equal_faces(const py::array& found, Mesh& mesh) {
  const Integers f = integers(found, "faces");
  if (f.size() == 0) return;
  if (f.ndim() != 2) reject_shape("faces", mesh.dim == 2 ? "shape (m, 2)" : "shape (m, 3)", f);
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
    const py::array found = any_array(face);
    if (!found || found.ndim() != 1)
      throw InputError("faces: face " + std::to_string(mesh.face_count()) +
                       ": expected vertex indices, got " + described(face));
    const Integers f = integers(found, "faces");
    add_face({f.data(), static_cast<std::size_t>(f.size())}, mesh, memory);
  }
}

}  // namespace

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

bool flag(py::handle given, const char* what, bool fallback) {
  if (given.is_none()) return fallback;
  if (given.ptr() == Py_True) return true;
  if (given.ptr() == Py_False) return false;
  const int truth = py::hasattr(given, "dtype") ? PyObject_IsTrue(given.ptr()) : -1;  // numpy.bool_
  if (truth >= 0) return truth == 1;
  PyErr_Clear();
  throw py::type_error(std::string(what) + ": expected True or False, got " + described(given));
}

double number(py::handle given, const char* what, double fallback) {
  if (given.is_none()) return fallback;
  const double x = PyFloat_AsDouble(given.ptr());
  if (x == -1 && PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    throw py::type_error(std::string(what) + ": expected a number, got " + described(given));
  }
  return x;
}

double size(py::handle given, const char* what, double fallback) {
  const double x = number(given, what, fallback);
  if (!(x >= 0 && x <= std::numeric_limits<double>::max()))
    throw InputError(std::string(what) + ": expected a finite number of at least 0, got " +
                     std::string(py::str(given)));
  return x;
}

std::uint64_t count(py::handle given, const char* what, std::uint64_t fallback) {
  if (given.is_none()) return fallback;
  const auto index = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
  const std::uint64_t n = index ? PyLong_AsUnsignedLongLong(index.ptr()) : 0;
  if (PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    if (!index) throw py::type_error(std::string(what) + ": expected an integer, got " + described(given));
    throw InputError(std::string(what) + ": expected an integer of at least 0, got " +
                     std::string(py::str(index)));
  }
  return n;
}

std::string text(py::handle given, const char* what, const std::string& fallback) {
  if (given.is_none()) return fallback;
  if (!py::isinstance<py::str>(given))
    throw py::type_error(std::string(what) + ": expected a str, got " + described(given));
  py::ssize_t size = 0;
  const char* const utf8 = PyUnicode_AsUTF8AndSize(given.ptr(), &size);
  if (utf8 == nullptr) {
    PyErr_Clear();
    throw InputError(std::string(what) + ": expected a valid Unicode string, got a lone surrogate");
  }
  return {utf8, static_cast<std::size_t>(size)};
}

std::string path(py::handle given, const char* what) {
  const auto found = py::reinterpret_steal<py::object>(PyOS_FSPath(given.ptr()));
  if (!found) {
    PyErr_Clear();
    throw py::type_error(std::string(what) + ": expected a path, got " + described(given));
  }
  PyObject* bytes = nullptr;
  if (PyUnicode_FSConverter(found.ptr(), &bytes) == 0) throw py::error_already_set();
  return std::string(py::reinterpret_steal<py::bytes>(bytes));
}

py::str path_of(std::string_view path) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeFSDefaultAndSize(path.data(), static_cast<py::ssize_t>(path.size())));
}

Eigen::Vector3d vector(py::handle given, const char* what) {
  const Numbers v = numbers(given, what, "three numbers");
  if (v.size() != 3 || v.ndim() != 1) reject_shape(what, "three numbers", v);
  return {v.data()[0], v.data()[1], v.data()[2]};
}

Poses poses(py::handle given, const char* what) {
  Poses out;
  if (given.is_none()) return out;
  const Numbers m = numbers(given, what, kPoses);
  out.one = m.ndim() == 2;
  if (m.ndim() == 1 && m.size() == 0) return out;  // an empty list: no poses
  const py::ssize_t rows = m.ndim() >= 2 ? m.shape(m.ndim() - 2) : 0;
  if ((m.ndim() != 2 && m.ndim() != 3) || m.shape(m.ndim() - 1) != 4 || (rows != 3 && rows != 4))
    reject_shape(what, kPoses, m);
  if (out.one) {
    out.first = read_pose(m.data(), rows, what);
    return out;
  }
  out.many.reserve(static_cast<std::size_t>(m.shape(0)));
  for (py::ssize_t i = 0; i < m.shape(0); ++i)
    out.many.push_back(read_pose(m.data() + 4 * rows * i, rows, what));
  return out;
}

Pose pose(py::handle given, const char* what) {
  if (given.is_none()) return {};
  const Numbers m = numbers(given, what, "numbers of shape (4, 4)");
  if (m.ndim() != 2 || m.shape(1) != 4 || (m.shape(0) != 3 && m.shape(0) != 4))
    reject_shape(what, "shape (4, 4)", m);
  return read_pose(m.data(), m.shape(0), what);
}

Mesh mesh_of_arrays(py::handle vertices, py::handle faces, const std::string& name) {
  Mesh mesh;
  mesh.name = name;
  mesh.dim = read_points(vertices, "vertices", mesh.vertices);
  if (const py::array found = any_array(faces); found && found.dtype().kind() != 'O')
    add_equal_faces(found, mesh);
  else if (py::isinstance<py::sequence>(faces) && !py::isinstance<py::str>(faces))
    add_any_faces(py::reinterpret_borrow<py::sequence>(faces), mesh);
  else
    throw InputError("faces: expected integers of shape (m, 3), got " + described(faces));
  return mesh;
}

std::vector<Eigen::Vector3d> points(py::handle given, const char* what, int dim) {
  std::vector<Eigen::Vector3d> out;
  const int width = read_points(given, what, out);
  if (!out.empty() && width < dim)
    throw InputError(std::string(what) + ": expected 3 coordinates of each point, found " +
                     std::to_string(width));
  return out;
}

}  // namespace lrb::python
