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

BodyWrapper made(const Given& given) {
  BodyPtr body = shared_body(given["body"]);
  const WrapperMode how = word(given["mode"], WrapperMode::regularised);
  const LrbRep& rep = body->rep();
  return {std::move(body), Wrapper(rep, how)};
}

BodyWrapper at(const Given& given) {
  BodyPtr body = shared_body(given["body"]);
  const double within = size(given["tolerance"]);
  const unsigned n = threads_of(given);
  const py::gil_scoped_release unlocked;
  const LrbRep& rep = body->rep();
  return {std::move(body), bodies::wrapper_at(rep, within, n)};
}

std::uint32_t checked(const Argument& arg, std::uint32_t n) {
  const std::uint64_t i = count(arg);
  if (i >= n)
    throw InputError(std::string(arg.name) + ": expected a number below " + std::to_string(n) + ", got " +
                     std::to_string(i));
  return static_cast<std::uint32_t>(i);
}
RegionId region(const BodyWrapper& w, const Given& given) {
  return RegionId(checked(given["region"], w.body->rep().region_count()));
}
FaceId face(const BodyWrapper& w, const Given& given) {
  return FaceId(checked(given["face"], w.body->rep().face_count()));
}

py::array_t<std::uint32_t> wrapper_triangles(const BodyWrapper& w) {
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
py::object region_behind(const BodyWrapper& w, const Given& given) {
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
  define_constructor(c, R"(Wrapper(body, mode='regularised')

Makes the outermost wrapper. mode 'unregularised': refining a face discards that face alone.)",
                     &made);
  define_static(c, R"(at(body, tolerance, *, threads=0)

Makes the coarsest wrapper whose maximum deviation from the body is within a tolerance (the mesh's unit).)",
                &at);
  define(c, "refine(region)\n\nExcludes a region. Returns False if it was already excluded.",
         [](BodyWrapper& w, const Given& given) { return w.wrapper.refine(region(w, given)); });
  define(c, R"(refine_face(face)

Refines the region behind a face. Returns False if the face is real or not on the boundary.)",
         [](BodyWrapper& w, const Given& given) { return w.wrapper.refine_face(face(w, given)); });
  define(c, "coarsen(region)\n\nIncludes a region again. Returns False if it is already included.",
         [](BodyWrapper& w, const Given& given) { return w.wrapper.coarsen(region(w, given)); });
  define(c, "refine_all()\n\nExcludes all regions: only the real faces remain.",
         [](BodyWrapper& w) { w.wrapper.refine_all(); });
  define(c, "reset()\n\nResets to the outermost wrapper.", [](BodyWrapper& w) { w.wrapper.reset(); });
  define(c, "includes(region)\n\nReturns True if a region is included in the wrapper.",
         [](const BodyWrapper& w, const Given& given) { return w.wrapper.included(region(w, given)); });
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
           &wrapper_triangles);
  property(c, "excluded", "(r,) uint32: the excluded regions, in order of refinement.",
           [](const BodyWrapper& w) { return w.wrapper.excluded(); });
  c.def("__len__", [](const BodyWrapper& w) { return w.wrapper.boundary_size(); });
  c.def("__repr__", [](const BodyWrapper& w) {
    return printable("<lrbscope.Wrapper of '" + w.body->rep().name() +
                     "': " + std::to_string(w.wrapper.boundary_size()) + " faces>");
  });
}

}  // namespace lrb::python
