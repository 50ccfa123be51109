// Bodies from matrices, arrays, meshes, LRB-reps and files. Every path checks its input, creates an LRB-rep,
// and collects notes on changes and on unsupported queries. Errors in arrays name the element.

#include <chrono>
#include <filesystem>
#include <optional>
#include <utility>

#include "engine/scene/build_cache.hpp"
#include <lrbscope/body.hpp>
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_repair.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb {

const BodyOptions& default_body_options() {
  static const BodyOptions options;
  return options;
}

// From a checked mesh to an LRB-rep.
// 1. Reject meshes that cannot be queried at all.
// 2. Orient components outwards, if requested and needed.
// 3. Find the regions in the cache or build them, and prove the cells closed (validate_cells()).
// 4. If the mesh cannot have regions or the proof fails, keep only the real faces and note the reason.

namespace {

/// Returns a mesh's findings on one line, without its name.
std::string joined(const Mesh& mesh, const std::vector<std::string>& lines) {
  const std::string name = mesh.name + ": ";
  std::string out;
  for (const std::string& line : lines)
    out += (out.empty() ? "" : " | ") + (line.starts_with(name) ? line.substr(name.size()) : line);
  return out;
}

void reject_unless_queryable(const CheckedMesh& mesh) {
  if (!mesh.report().queryable())
    throw InputError(mesh.mesh().name +
                     ": cannot be queried: " + joined(mesh.mesh(), mesh.report().lines(mesh.mesh())));
}

std::string note_without_regions(const CheckedMesh& mesh, bool turn) {
  const std::string why =
      turn ? obstacles_to_build(mesh) : joined(mesh.mesh(), mesh.report().obstacles(mesh.mesh()));
  return mesh.mesh().name + ": queries will not use regions, because an LRB-rep cannot be built: " + why;
}

std::vector<std::string> notes_on_polygons(const CheckedMesh& mesh) {
  if (mesh.report()[MeshFault::folded_face].count == 0) return {};
  return {mesh.report().line(MeshFault::folded_face, mesh.mesh())};
}

bool can_be_built(const CheckedMesh& mesh, bool turn) {
  return turn ? mesh.report().when_turned().buildable() : mesh.report().buildable();
}

}  // namespace

bool is_lrb_file(const std::string& path) {
  std::error_code ignored;
  // Only regular files: bytes read from a pipe are lost, and opening a named pipe would block.
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  try {
    return looks_like_lrb(InputFile(path).start());
  } catch (const InputError&) {  // who reads it says why
    return false;
  }
}

std::string join_corners_of_mesh(Mesh& mesh) {
  const JoinedCorners joined = join_corners(mesh);
  if (!joined.any()) return "";
  return mesh.name + ": merged coincident vertices: " + std::to_string(joined.before) + " -> " +
         std::to_string(joined.after) + " vertices, " + std::to_string(joined.open_before) + " -> " +
         std::to_string(joined.open_after) + (mesh.dim == 2 ? " loose ends" : " open edges");
}

std::string obstacles_to_build(const CheckedMesh& mesh) {
  return joined(mesh.mesh(), mesh.report().when_turned().obstacles(mesh.mesh()));
}

std::string note_unproven(const LrbRep& rep) {
  // Without regions there are no cells to prove.
  if (rep.region_count() == 0) return {};
  const ValidateReport report = validate_cells(rep);
  if (report.valid) return {};
  return rep.name() + ": queries will not use regions, because the validation of its LRB-rep failed: " +
         report.violations.front();
}

std::string note_polygons(const LrbRep& rep) {
  if (!rep.folded_faces().empty()) {
    MeshReport report;
    for (const FaceId f : rep.folded_faces()) note(report, MeshFault::folded_face, f);
    Mesh named;
    named.name = rep.name();
    return report.line(MeshFault::folded_face, named);
  }
  if (!rep.dropped_fans()) return {};
  return rep.name() +
         ": the file is of a version that took concave polygons as fans; queries use its faces without "
         "regions; build it again from the mesh";
}

std::uint32_t turn_outward(CheckedMesh& mesh, std::vector<std::string>& notes) {
  const std::uint32_t turned = mesh.turn_outward();
  if (turned > 0)
    notes.push_back(mesh.mesh().name + ": flipped " + std::to_string(turned) +
                    (turned == 1 ? " inside-out component" : " inside-out components"));
  return turned;
}

namespace {

/// Returns the real faces of an LRB-rep if its cells are not proven, else nullopt. Adds notes.
std::optional<LrbRep> faces_if_unproven(const LrbRep& rep, std::vector<std::string>& notes) {
  if (std::string note = note_polygons(rep); !note.empty()) notes.push_back(std::move(note));
  std::string fault = note_unproven(rep);
  if (fault.empty()) return std::nullopt;
  notes.push_back(std::move(fault));
  return LrbRep::without_regions(rep);
}

}  // namespace

MadeBody make_body(LrbRep rep, bool turn, unsigned threads) {
  std::vector<std::string> notes;
  std::uint32_t turned = 0;
  if (std::optional<LrbRep> faces = faces_if_unproven(rep, notes)) rep = std::move(*faces);
  // Without regions no proof needs the solid behind each face, but normals and depths of contacts do.
  if (turn && rep.region_count() == 0 && rep.closed()) {
    CheckedMesh mesh = check(rep.real_mesh());
    turned = turn_outward(mesh, notes);
    if (turned > 0)
      rep = LrbRep::without_regions(
          LrbRep::without_regions(mesh.mesh(), true, rep.self_intersecting(), threads), rep.dropped_fans());
  }
  return {std::move(rep), std::move(notes), 0, turned};
}

MadeBody make_body(CheckedMesh mesh, const BuildOptions& options, bool turn) {
  using Clock = std::chrono::steady_clock;
  reject_unless_queryable(mesh);
  std::vector<std::string> notes = notes_on_polygons(mesh);
  // Steps 2 and 3. The time includes the proof.
  if (can_be_built(mesh, turn)) {
    const std::uint32_t turned = turn ? turn_outward(mesh, notes) : 0;
    if (std::optional<LrbRep> rep = find_built(mesh.mesh(), options, notes))
      return {std::move(*rep), std::move(notes), 0, turned};
    const auto begin = Clock::now();
    LrbRep rep = build_lrb(mesh, options);
    std::string fault = note_unproven(rep);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    if (fault.empty()) {
      keep_built(rep, mesh.mesh(), options, notes);
    } else {
      notes.push_back(std::move(fault));
      rep = LrbRep::without_regions(rep);
    }
    return {std::move(rep), std::move(notes), seconds, turned};
  }
  // Step 4. Without regions, the body still stores whether it intersects itself.
  notes.push_back(note_without_regions(mesh, turn));
  const std::uint32_t turned = turn ? turn_outward(mesh, notes) : 0;
  Workers workers(options.threads);
  const bool self_intersecting = !mesh.self_intersecting_faces(workers).empty();
  return {
      LrbRep::without_regions(mesh.mesh(), mesh.report().bounds_solid, self_intersecting, options.threads),
      std::move(notes), 0, turned};
}

MadeBody make_body_of_faces(CheckedMesh mesh, bool turn, unsigned threads) {
  reject_unless_queryable(mesh);
  std::vector<std::string> notes = notes_on_polygons(mesh);
  if (!can_be_built(mesh, turn)) notes.push_back(note_without_regions(mesh, turn));
  const std::uint32_t turned = turn ? turn_outward(mesh, notes) : 0;
  constexpr bool kSelfIntersecting = false;  // self-intersection matters only for regions
  return {LrbRep::without_regions(mesh.mesh(), mesh.report().bounds_solid, kSelfIntersecting, threads),
          std::move(notes), 0, turned};
}

MadeBody make_body(Mesh mesh, const BodyOptions& options) {
  // Check, then build, with or without regions. Both throw InputError if the mesh cannot be queried at all.
  CheckedMesh checked = check(std::move(mesh));
  return options.regions ? make_body(std::move(checked), options.build, options.turn)
                         : make_body_of_faces(std::move(checked), options.turn, options.build.threads);
}

MadeBody make_body_of_file(const std::string& path, const BodyOptions& options, std::string_view if_joined) {
  // Opened once, and told by its content, not by its name.
  InputFile file(path);
  if (looks_like_lrb(file.start())) return make_body(load_lrb(file), options.turn, options.build.threads);
  Mesh mesh = read_mesh(read_file(file), path);
  std::string note = options.join ? join_corners_of_mesh(mesh) : "";
  MadeBody made = make_body(std::move(mesh), options);
  if (!note.empty()) made.notes.insert(made.notes.begin(), note.append(if_joined));
  return made;
}

namespace {

/// Row-major arrays of a body.
template <class Number>
struct Rows {
  std::span<const Number> numbers;
  std::size_t each;  ///< numbers per row
};

/// Returns the error in the shapes of the two arrays, or an empty string if they are vertices and faces.
template <class Number>
std::string shape_fault(const Rows<double>& vertices, const Rows<Number>& faces) {
  // Two corners per face: segments of a 2D body.
  const bool is_flat = faces.each == 2;
  if (faces.each < 2)
    return "expected 3 or more corners per face (2 for 2D bodies), found " + std::to_string(faces.each);
  if (vertices.each != 3 && !(is_flat && vertices.each == 2))
    return std::string("expected ") + (is_flat ? "2 or 3" : "3") + " coordinates per vertex, found " +
           std::to_string(vertices.each);
  // Incomplete rows.
  if (vertices.numbers.size() % vertices.each != 0)
    return "expected a multiple of " + std::to_string(vertices.each) + " coordinates, found " +
           std::to_string(vertices.numbers.size());
  if (faces.numbers.size() % faces.each != 0)
    return "expected a multiple of " + std::to_string(faces.each) + " corners, found " +
           std::to_string(faces.numbers.size());
  // Indices are 32 bits wide.
  if (vertices.numbers.size() / vertices.each > kMaxId || faces.numbers.size() > kMaxId)
    return "expected at most " + std::to_string(kMaxId) +
           " vertices and corners (32-bit indices), found more";
  return {};
}

template <class Number>
Expected<Mesh> mesh_of(const Rows<double>& vertices, const Rows<Number>& faces, const std::string& name) {
  const std::string who = printable_name(name);
  if (const std::string fault = shape_fault(vertices, faces); !fault.empty())
    return Error{who + ": " + fault};
  Mesh mesh;
  mesh.name = who;
  mesh.dim = faces.each == 2 ? 2 : 3;
  // Pass 1: vertices. Missing z coordinates are 0. The mesh check tests whether numbers are finite.
  const std::size_t count = vertices.numbers.size() / vertices.each;
  mesh.vertices.reserve(count);
  for (std::size_t v = 0; v < count; ++v) {
    const double* const x = vertices.numbers.data() + v * vertices.each;
    mesh.vertices.emplace_back(x[0], x[1], vertices.each == 3 ? x[2] : 0);
    if (mesh.dim == 2 && mesh.vertices.back().z() != 0)
      return Error{who + ": vertex " + std::to_string(v) + ": expected z = 0 in a 2D body, found " +
                   io::number_text(mesh.vertices.back().z())};
  }
  // Pass 2: faces. std::cmp_* compare integers of any signedness and width correctly.
  mesh.face_vertices.reserve(faces.numbers.size());
  mesh.face_offsets.reserve(faces.numbers.size() / faces.each + 1);
  for (std::size_t i = 0; i < faces.numbers.size(); ++i) {
    const Number corner = faces.numbers[i];
    if (std::cmp_less(corner, 0) || std::cmp_greater_equal(corner, count))
      return Error{who + ": face " + std::to_string(i / faces.each) + ": expected a vertex index below " +
                   std::to_string(count) + ", found " + std::to_string(corner)};
    mesh.face_vertices.push_back(VertexId(corner));
    if ((i + 1) % faces.each == 0) mesh.face_offsets.push_back(static_cast<std::uint32_t>(i + 1));
  }
  return mesh;
}

template <class Number>
Expected<Body> body_of(const Rows<double>& vertices, const Rows<Number>& faces, const BodyOptions& options) {
  Expected<Mesh> mesh = mesh_of(vertices, faces, options.name);
  if (!mesh) return mesh.error();
  return Body::from(std::move(*mesh), options);
}

/// Returns the note on a body that bounds no solid: the answers it does not support.
std::string note_no_solid(const LrbRep& rep) {
  return rep.name() +
         ": not a closed solid: pairs, contacts and distances are exact, but inside/outside is undefined; if "
         "the surfaces do not intersect but the boxes overlap, the relation is `undefined`";
}

/// Adds a note on each kind of answer that a body does not support.
void add_notes_on(const LrbRep& rep, std::vector<std::string>& notes) {
  if (!rep.closed())
    notes.push_back(note_no_solid(rep));
  else if (std::string note = note_no_levels(rep); !note.empty())
    notes.push_back(std::move(note));
}

}  // namespace

Body Body::made(MadeBody made) {
  add_notes_on(made.rep, made.notes);
  return Body(std::make_shared<const Impl>(
      Impl{std::make_shared<const LrbRep>(std::move(made.rep)), std::move(made.notes), made.turned}));
}

Expected<Body> Body::from_rows(std::span<const double> coordinates, std::size_t each,
                               std::span<const std::int64_t> corners, std::size_t each_face,
                               const BodyOptions& options) {
  return body_of(Rows<double>{coordinates, each}, Rows<std::int64_t>{corners, each_face}, options);
}

Expected<Body> Body::from(std::span<const double> coordinates, std::span<const std::uint32_t> corners,
                          const BodyOptions& options) {
  return body_of(Rows<double>{coordinates, 3}, Rows<std::uint32_t>{corners, 3}, options);
}

Expected<Body> Body::from(std::span<const double> coordinates, std::span<const std::int32_t> corners,
                          const BodyOptions& options) {
  return body_of(Rows<double>{coordinates, 3}, Rows<std::int32_t>{corners, 3}, options);
}

Expected<Body> Body::from(std::span<const double> coordinates, std::span<const std::int64_t> corners,
                          const BodyOptions& options) {
  return body_of(Rows<double>{coordinates, 3}, Rows<std::int64_t>{corners, 3}, options);
}

Expected<Body> Body::from(Mesh mesh, const BodyOptions& options) try {
  if (mesh.name.empty()) mesh.name = printable_name(options.name);
  return made(make_body(std::move(mesh), options));
} catch (const InputError& e) {
  return Error{e.what()};
}

Body Body::from(LrbRep rep) {
  return made(make_body(std::move(rep)));
}

Body Body::from(std::shared_ptr<const LrbRep> rep) {
  std::vector<std::string> notes;
  if (std::optional<LrbRep> faces = faces_if_unproven(*rep, notes))
    rep = std::make_shared<const LrbRep>(std::move(*faces));
  add_notes_on(*rep, notes);
  return Body(std::make_shared<const Impl>(Impl{std::move(rep), std::move(notes), 0}));
}

Expected<Body> Body::load(const std::string& path, const BodyOptions& options) try {
  return made(make_body_of_file(path, options));
} catch (const InputError& e) {
  return Error{e.what()};
}

}  // namespace lrb
