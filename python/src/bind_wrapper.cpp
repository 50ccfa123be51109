#include "python/src/answers.hpp"
#include "python/src/objects.hpp"
#include "python/src/properties.hpp"
#include "scenarios/bodies/body_figures.hpp"

namespace lrb::python {
namespace {

/// A wrapper and its body.
struct BodyWrapper {
  BodyPtr body;
  Wrapper wrapper;
};

BodyWrapper made(py::handle given, py::handle mode) {
  BodyPtr body = shared_body(given, "body");
  const WrapperMode how = word(mode, "mode", WrapperMode::regularised);
  const LrbRep& rep = body->rep();
  return {std::move(body), Wrapper(rep, how)};
}

BodyWrapper at(py::handle given, py::handle tolerance, py::handle threads) {
  BodyPtr body = shared_body(given, "body");
  const double within = size(tolerance, "tolerance");
  const unsigned n = threads_of(count(threads, "threads"));
  const py::gil_scoped_release unlocked;
  const LrbRep& rep = body->rep();
  return {std::move(body), bodies::wrapper_at(rep, within, n)};
}

std::uint32_t checked(py::handle given, const char* what, std::uint32_t n) {
  const std::uint64_t i = count(given, what);
  if (i >= n)
    throw InputError(std::string(what) + ": expected a number below " + std::to_string(n) + ", got " +
                     std::to_string(i));
  return static_cast<std::uint32_t>(i);
}
RegionId region(const BodyWrapper& w, py::handle given) {
  return RegionId(checked(given, "region", w.body->rep().region_count()));
}
FaceId face(const BodyWrapper& w, py::handle given) {
  return FaceId(checked(given, "face", w.body->rep().face_count()));
}

py::array_t<std::uint32_t> triangles_of(const BodyWrapper& w) {
  const LrbRep& rep = w.body->rep();
  std::vector<VertexId> corners;
  for (const FaceId f : w.wrapper.boundary()) {
    const auto n = static_cast<std::uint32_t>(Mesh::simplices_of(rep.face(f).size(), rep.dim()));
    for (std::uint32_t i = 0; i < n; ++i) {
      VertexId v[3];
      rep.simplex(SimplexId(rep.first_simplex(f) + i), v);
      corners.insert(corners.end(), v, v + rep.simplex_size());
    }
  }
  return column(corners, std::identity()).reshape({py::ssize_t{-1}, py::ssize_t{rep.simplex_size()}});
}

/// Returns the wrapper's region behind a face of its boundary, on either side, or None.
py::object region_behind(const BodyWrapper& w, py::handle given) {
  const FaceId f = face(w, given);
  const LrbRep& rep = w.body->rep();
  if (w.wrapper.on_boundary(f))
    for (const CellId cell : {rep.inner_cell(f), rep.outer_cell(f)})
      if (is_region(cell) && w.wrapper.included(cell)) return py::int_(cell.value());
  return py::none();
}

}  // namespace

void bind_wrapper(py::module_& m) {
  py::class_<BodyWrapper> c(
      m, "Wrapper",
      R"(The set of regions of a body's LRB-rep that are included. Their union with the body is the wrapper.

>>> w = Wrapper(cube)
>>> w.refine_all()
>>> len(w) == cube.real_face_count
True)");
  c.def(py::init(&made), Signature(R"(Wrapper(body, mode='regularised')

Makes the outermost wrapper. mode 'unregularised': refining a face discards that face alone.)"));
  c.def_static("at", &at, Signature(R"(at(body, tolerance, *, threads=0)

Makes the coarsest wrapper whose maximum deviation from the body is within a tolerance (the mesh's unit).)"));
  define(c, "refine(region)\n\nExcludes a region. Returns False if it was already excluded.",
         [](BodyWrapper& w, py::handle r) { return w.wrapper.refine(region(w, r)); });
  define(c, R"(refine_face(face)

Refines the region behind a face. Returns False if the face is real or not on the boundary.)",
         [](BodyWrapper& w, py::handle f) { return w.wrapper.refine_face(face(w, f)); });
  define(c, "coarsen(region)\n\nIncludes a region again. Returns False if it is already included.",
         [](BodyWrapper& w, py::handle r) { return w.wrapper.coarsen(region(w, r)); });
  define(c, "refine_all()\n\nExcludes all regions: only the real faces remain.",
         [](BodyWrapper& w) { w.wrapper.refine_all(); });
  define(c, "reset()\n\nResets to the outermost wrapper.", [](BodyWrapper& w) { w.wrapper.reset(); });
  define(c, "includes(region)\n\nReturns True if a region is included in the wrapper.",
         [](const BodyWrapper& w, py::handle r) { return w.wrapper.included(region(w, r)); });
  define(c, R"(region_behind(face)

Returns the region behind a face of the boundary, or None if the face is real or not on the boundary.)",
         &region_behind);
  property(c, "body", "Body", &BodyWrapper::body);
  property(
      c, "faces",
      "(f,) uint32: the faces of the boundary, ascending; real faces are less than body.real_face_count.",
      [](const BodyWrapper& w) { return column(w.wrapper.boundary(), std::identity()); });
  property(c, "is_real", "(f,) bool: for each of these, True if it is a face of the mesh.",
           [](const BodyWrapper& w) {
             return column(w.wrapper.boundary(), [&](FaceId f) { return w.body->rep().is_real(f); });
           });
  property(c, "triangles", "(t, 3) uint32: the boundary's triangles, as indices into body.all_vertices.",
           &triangles_of);
  property(c, "excluded", "(r,) uint32: the excluded regions, in order of refinement.",
           [](const BodyWrapper& w) { return w.wrapper.excluded(); });
  c.def("__len__", [](const BodyWrapper& w) { return w.wrapper.boundary_size(); });
  c.def("__repr__", [](const BodyWrapper& w) {
    return printable("<lrbscope.Wrapper of '" + w.body->rep().name() +
                     "': " + std::to_string(w.wrapper.boundary_size()) + " faces>");
  });
}

}  // namespace lrb::python
