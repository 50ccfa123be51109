#include <algorithm>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "python/src/answers.hpp"
#include "python/src/objects.hpp"
#include "python/src/pickle.hpp"
#include "python/src/properties.hpp"
#include "scenarios/bodies/body_figures.hpp"
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::python {

namespace {

/// Returns the number of vertices up to the last one used by a real face.
std::size_t used_vertices(const LrbRep& rep) {
  std::size_t n = 0;
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) n = std::max<std::size_t>(n, v + 1u);
  return n;
}

/// `progress` must outlive the options.
BuildOptions build_options(const Given& given, const Progress& progress) {
  BuildOptions options;
  if (const Argument cache = given["cache"]; !cache.is_none()) options.cache = path(cache);
  options.lean = flag(given["lean"]);
  options.merge_planes = flag(given["merge_planes"]);
  const std::uint64_t lids = count(given["max_lids"]);
  if (lids > 1000) throw InputError("max_lids: expected at most 1000, got " + std::to_string(lids));
  options.max_lids = static_cast<std::uint32_t>(lids);
  options.seed = count(given["seed"], options.seed);
  options.threads = threads_of(given);
  options.progress = [&progress](std::uint32_t pass, std::uint32_t front_faces) {
    progress("building regions, front of " + std::to_string(front_faces) + " faces", pass, 0);
  };
  return options;
}

BodyPtr body_of_arrays(const Given& given) {
  Mesh mesh = mesh_of_arrays(given["vertices"].given, given["faces"].given, text(given["name"], "body"));
  const Progress report(given["progress"].given);
  const BuildOptions options = build_options(given, report);
  const bool with_regions = flag(given["regions"], true);
  const std::size_t n = mesh.vertices.size();
  const py::gil_scoped_release unlocked;
  return std::make_shared<Body>(with_regions ? bodies::body_of_mesh(std::move(mesh), options)
                                             : bodies::faces_of_mesh(std::move(mesh), options.threads),
                                n);
}

BodyPtr load(const Given& given) {
  const std::string name = path(given["path"]);
  const Progress report(given["progress"].given);
  const BuildOptions options = build_options(given, report);
  const bool with_regions = flag(given["regions"], true);
  const py::gil_scoped_release unlocked;
  return std::make_shared<Body>(with_regions
                                    ? bodies::load_body(name, options)
                                    : bodies::load_faces(name, bodies::Corners::joined, options.threads));
}

void save_body(const Body& body, const Given& given) {
  const std::string name = path(given["path"]);
  const py::gil_scoped_release unlocked;
  if (std::filesystem::path(name).extension() == ".lrb")
    save_lrb(body.rep(), name);
  else
    write_mesh(body.rep().real_mesh(), name);
}

/// Views the first n vertices, with as many coordinates as the constructor takes: (n, 3), or (n, 2) for a 2D
/// body.
py::array_t<double> vertices_of(const py::object& self, std::size_t n) {
  const LrbRep& rep = self.cast<const Body&>().rep();
  return view({static_cast<py::ssize_t>(n), rep.dim()},
              reinterpret_cast<const double*>(rep.vertices().data()), self,
              {sizeof(Eigen::Vector3d), sizeof(double)});
}

/// Returns faces [begin, end) of a body: an array of ids if all have the same number of corners, else a list
/// of arrays.
py::object faces_of(const py::object& self, FaceId begin, FaceId end) {
  const LrbRep& rep = self.cast<const Body&>().rep();
  const LrbData& d = rep.data();
  const std::size_t width = begin == end ? 3 : rep.face(begin).size();
  bool equal = true;
  for (FaceId f = begin; f < end && equal; ++f) equal = rep.face(f).size() == width;
  const std::span<const VertexId> all(d.face_vertices.data() + d.face_offsets[begin],
                                      d.face_offsets[end] - d.face_offsets[begin]);
  if (equal) return view_of_ids(all, static_cast<py::ssize_t>(width), self);
  py::list out;
  for (FaceId f = begin; f < end; ++f) out.append(view_of_ids(rep.face(f), 1, self));
  return out;
}

/// Returns the corners of simplices [0, n).
py::object triangles_of(const py::object& self) {
  const LrbRep& rep = self.cast<const Body&>().rep();
  if (rep.real_simplex_count() == rep.real_face_count())
    return faces_of(self, FaceId{0}, FaceId(rep.real_face_count()));
  const py::ssize_t n = rep.real_simplex_count(), size = rep.simplex_size();
  py::array_t<std::uint32_t> out({n, size});
  std::uint32_t* to = out.mutable_data();
  for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
    VertexId corners[3];
    rep.simplex(s, corners);
    to = std::copy(corners, corners + size, to);
  }
  return out;
}

py::array_t<std::uint32_t> face_of_triangle(const Body& body) {
  const LrbRep& rep = body.rep();
  std::vector<FaceId> faces;
  for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) faces.push_back(rep.face_of_simplex(s));
  return column(faces, std::identity());
}

py::object figures(const Body& body) {
  nlohmann::ordered_json j;
  {
    const py::gil_scoped_release unlocked;
    j = bodies::body_figures(body.rep());
    j["build_seconds"] = body.build_seconds();
  }
  return parsed_json(j.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

py::object levels(const Body& body, const Given& given) {
  const unsigned n = threads_of(given);
  std::string text;
  {
    const py::gil_scoped_release unlocked;
    nlohmann::ordered_json j = nlohmann::ordered_json::array();
    for (const WrapperLevel& level : body.rep().levels(n).all())
      j.push_back(
          {{"bound", level.bound}, {"faces", level.face_count}, {"pseudo_faces", level.pseudo_count}});
    text = j.dump();
  }
  return parsed_json(text);
}

py::array_t<double> box(const Body& body, const Given& given) {
  const Eigen::AlignedBox3d found = body.extent().in_world(pose(given["pose"]));
  return column(std::array<Eigen::Vector3d, 2>{found.min(), found.max()}, std::identity());
}

py::tuple pickled(const Body& body) {
  Archive archive;
  LrbData d = body.rep().data();
  std::vector<std::string> notes = body.notes();
  double seconds = body.build_seconds();
  std::size_t vertices = body.vertex_count();
  archive(d, notes, seconds, vertices);
  return archive.state();
}

BodyPtr unpickled(const py::tuple& state) {
  Archive archive(state);
  LrbData d;
  std::vector<std::string> notes;
  double seconds = 0;
  std::size_t vertices = 0;
  archive(d, notes, seconds, vertices);
  archive.check_end();
  if (vertices > d.vertices.size()) throw InputError("the pickle is damaged");
  return std::make_shared<Body>(bodies::LoadedBody{LrbRep(std::move(d)), std::move(notes), seconds},
                                vertices);
}

py::str body_text(const Body& body) {
  const LrbRep& rep = body.rep();
  return printable("<lrbscope.Body '" + rep.name() + "': " + std::to_string(rep.real_face_count()) +
                   (rep.dim() == 2 ? " segments, " : " faces, ") + std::to_string(rep.region_count()) +
                   " regions, " + (rep.closed() ? "solid>" : "not closed>"));
}

using BodyClass = py::class_<Body, BodyPtr>;

void bind_making(BodyClass& c) {
  define_constructor(
      c,
      R"(Body(vertices, faces, *, regions=True, lean=False, max_lids=0, merge_planes=False, seed=1, threads=0, name='body', progress=None, cache=None)

Makes a body from arrays.

vertices: (n, 3) float, any unit; (n, 2) for a 2D body.
faces: (m, 3) int, corners counter-clockwise seen from outside; (m, k) or a list of lists for convex
    polygons; (m, 2) segments in 2D. Inward-oriented surfaces are flipped, and `notes` lists this.
regions: build an LRB-rep with wrappers. Without regions, answers are the same and the body is made faster.
lean: build a smaller LRB-rep whose wrappers fit less tightly.
max_lids: at most so many lids a region, 0: any number; 12 for queries with recursion='paper_boxes'.
merge_planes: first make faces in exactly the same plane regions without volume, in 3D; not with lean.
seed, threads: of the build. The result depends only on the seed. threads 0: all cores.
progress: called with (what, done, total) after each pass of the build, total 0 for an unknown one; True: a
    bar, where tqdm is installed.
cache: a folder that keeps LRB-reps, so that each mesh is built once; by default that of the environment
    variable LRBSCOPE_CACHE, or none.

Raises InputError, which names the element, for a mesh that cannot be queried at all. A surface that cannot
have regions (open, not manifold) gives a body without them.)",
      &body_of_arrays);
  define_static(
      c,
      R"(load(path, *, regions=True, lean=False, max_lids=0, merge_planes=False, seed=1, threads=0, progress=None, cache=None)

Reads a body from a mesh (OBJ, STL, PLY, OFF) or an .lrb file. See Body for the options.)",
      &load);
  define(c,
         "save(path)\n\n"
         "Writes the body: with its regions as .lrb, its faces alone as .ply or .obj.",
         &save_body);
  c.def(py::pickle(&pickled, &unpickled));
  make_copyable(c);
  c.def("__repr__", &body_text);
}

void bind_geometry(BodyClass& c) {
  c.def_property_readonly(
      "vertices",
      [](const py::object& self) { return vertices_of(self, self.cast<const Body&>().vertex_count()); },
      R"((n, 3) float64, in 2D (n, 2): the mesh's vertices in its unit. Read-only; shares the body's memory.)");
  c.def_property_readonly(
      "all_vertices",
      [](const py::object& self) {
        return vertices_of(self, self.cast<const Body&>().rep().vertices().size());
      },
      R"((v, 3) float64, in 2D (v, 2): `vertices`, followed by the vertices that only pseudo faces use.)");
  c.def_property_readonly(
      "faces",
      [](const py::object& self) {
        return faces_of(self, FaceId{0}, FaceId(self.cast<const Body&>().rep().real_face_count()));
      },
      "(m, 3) uint32 or list of (k,) uint32: the corners of each face, in 2D (m, 2); a list if faces differ in "
      "their number of corners.");
  c.def_property_readonly(
      "triangles", &triangles_of,
      "(t, 3) uint32, in 2D (t, 2): the corners of each triangle; pairs index this array. A "
      "convex polygon is the fan of triangles from its first corner (docs/meshes.md).");
  c.def_property_readonly("face_of_triangle", &face_of_triangle, "(t,) uint32: the face of each triangle.");
  define(c,
         "box(pose=None)\n\n"
         "Returns the exact bounding box of the body at a pose, (2, 3) float64: minimum and "
         "maximum coordinates.",
         &box);
}

void bind_numbers(BodyClass& c) {
  const auto of_rep = properties_of(c, &Body::rep);
  of_rep("name", "str: for messages.", [](const LrbRep& rep) { return printable(rep.name()); });
  of_rep("dim", "int: 3, or 2 for a 2D body.", &LrbRep::dim);
  of_rep("is_solid", "bool: the faces bound a solid, so that 'inside' is defined.", &LrbRep::closed);
  of_rep("real_face_count", "int: faces of the mesh.", &LrbRep::real_face_count);
  of_rep("face_count", "int: faces of the LRB-rep, including pseudo faces.", &LrbRep::face_count);
  of_rep("region_count", "int: number of regions of the LRB-rep.", &LrbRep::region_count);
  of_rep("layer_count", "int: passes of the build that made regions.", &LrbRep::layer_count);
  of_rep("hash", "str: 16 hexadecimal digits, equal for equal LRB-reps.",
         [](const LrbRep& rep) { return trace::to_hex(rep.hash()); });
  of_rep("memory_bytes", "int", &LrbRep::memory_bytes);
  property(c, "notes", "list of str: changes made to the mesh and features not available, as text.",
           [](const Body& b) { return printable(b.notes()); });
  property(c, "build_seconds", "float: duration of the build; 0 if the body was not built.",
           &Body::build_seconds);
  define(c,
         "figures()\n\n"
         "Returns statistics of the LRB-rep, a dict with the keys of `lrbscope build --json`: "
         "faces, regions, layers,\n"
         "volumes (unit cubed) of solid, outermost wrapper and hull, bytes, build_seconds.",
         &figures);
  define(c, R"(levels(*, threads=0)

Returns the levels of detail used by queries with a tolerance, coarsest first: a list of dicts with `bound`
(maximum distance of the wrapper's points from the body, in the mesh's unit), `faces`, `pseudo_faces`.
The first call makes them.)",
         &levels);
}

}  // namespace

Body::Body(bodies::LoadedBody loaded, std::size_t vertex_count)
    : rep_(std::make_shared<const LrbRep>(std::move(loaded.rep))),
      notes_(std::move(loaded.notes)),
      build_seconds_(loaded.build_seconds),
      vertex_count_(vertex_count) {}

Body::Body(bodies::LoadedBody loaded) : Body(std::move(loaded), 0) {
  vertex_count_ = used_vertices(*rep_);
}

const BodyExtent& Body::extent() const {
  std::call_once(once_, [this] { extent_.emplace(*rep_); });
  return *extent_;
}

namespace {

/// Returns a Body, or that of a mesh of another library.
py::object body_object(const Argument& arg, const char* expected) {
  const py::handle given = arg.given;
  if (py::isinstance<Body>(given)) {
    given.cast<const Body&>();  // raises TypeError for an object without a value
    return py::reinterpret_borrow<py::object>(given);
  }
  if (!py::hasattr(given, "vertices") || !(py::hasattr(given, "faces") || py::hasattr(given, "triangles")))
    throw py::type_error(std::string(arg.name) + ": expected " + expected + ", got " + described(given));
  return py::module_::import("lrbscope.collision").attr("body_of")(given);
}

}  // namespace

const Body& body(const Argument& arg) {
  // Cached: the look-up in isinstance() and cast() gives the same result in each call and takes as long as a
  // query.
  static PyTypeObject* const type = reinterpret_cast<PyTypeObject*>(py::type::of<Body>().ptr());
  if (Py_TYPE(arg.given.ptr()) == type) {
    auto* object = reinterpret_cast<py::detail::instance*>(arg.given.ptr());
    if (const auto* found = object->get_value_and_holder().value_ptr<Body>()) return *found;
  }
  const py::object found = body_object(arg, "a Body");
  py::detail::loader_life_support::add_patient(found);  // a mesh's body is kept until the call ends
  return found.cast<const Body&>();
}

BodyPtr shared_body(const Argument& arg, const char* expected) {
  return body_object(arg, expected).cast<BodyPtr>();
}

TwoBodies::TwoBodies(const Given& given) : a(body(given["a"])), b(body(given["b"])) {
  const Argument one = given.optional("pose_b");
  if (one.name == nullptr)
    poses_b = poses(given["poses_b"]);
  else
    poses_b.first = pose(one);
  pose_a = pose(given["pose_a"]);
}

void bind_body(py::module_& m) {
  BodyClass c(m, "Body",
              R"(A body: a surface with its LRB-rep, ready for queries. Immutable; can be shared by threads.

>>> import numpy as np
>>> v = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
>>> f = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
>>> Body(v, f).is_solid
True)");
  bind_making(c);
  bind_geometry(c);
  bind_numbers(c);
}

}  // namespace lrb::python
