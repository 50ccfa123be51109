#include "python/src/answers.hpp"

#include <atomic>
#include <chrono>
#include <future>
#include <thread>

#include <pybind11/pybind11.h>
#include <unistd.h>

#include "python/src/pickle.hpp"
#include <lrbscope/contact_manifold.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/record_fields.hpp>

namespace lrb::python {

static void find_faces(Answer& answer) {
  if (answer.faces.empty())
    for (const SimplexPair& p : answer.result->pairs)
      answer.faces.push_back({answer.a->face_of_simplex(p.a), answer.b->face_of_simplex(p.b)});
}

void members(Archive& archive, Answer& x) {
  if (!archive.reads()) {
    find_faces(x);
    find_depths(x);
  }
  CollideResult read;
  archive(archive.reads() ? read : const_cast<CollideResult&>(*x.result), x.faces, x.depths);
  if (archive.reads()) x.result = std::make_shared<const CollideResult>(std::move(read));
}

namespace {

py::array_t<std::uint32_t> pairs_of(const py::object& self) {
  const auto& pairs = self.cast<const Answer&>().result->pairs;
  static_assert(sizeof(SimplexPair) == 2 * sizeof(std::uint32_t));
  return view({static_cast<py::ssize_t>(pairs.size()), 2},
              reinterpret_cast<const std::uint32_t*>(pairs.data()), self);
}

py::array_t<std::uint32_t> face_pairs_of(Answer& answer) {
  find_faces(answer);
  return column(answer.faces, std::identity());
}

/// Returns the corners of all pairs' intersections, and the number of each corner's pair.
py::tuple points_of(const Answer& answer) {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> of_pair;
  for (std::uint32_t i = 0; i < answer.result->contacts.size(); ++i) {
    const PairContactRecord& contact = answer.result->contacts[i];
    for (int c = 0; c < contact.corner_count; ++c) {
      points.push_back(contact.corners[c].x);
      of_pair.push_back(i);
    }
  }
  return py::make_tuple(to_python(points), to_python(of_pair));
}

py::object separation_of(const Answer& answer) {
  if (!answer.result->separation) return py::none();
  const Separation& s = *answer.result->separation;
  py::dict d;
  d["regions_a"] = to_python(s.refined[0]);
  d["regions_b"] = to_python(s.refined[1]);
  d["faces_a"] = s.face_count[0];
  d["faces_b"] = s.face_count[1];
  return d;
}

std::string fingerprint_of(const Answer& answer) {
  return trace::to_hex(fingerprint(answer.result->pairs));
}

std::string answer_text(const Answer& answer) {
  const CollideResult& r = *answer.result;
  return std::string("<lrbscope.Result ") + to_string(r.relation) + ", " + std::to_string(r.pairs.size()) +
         (r.pairs.size() == 1 ? " pair>" : " pairs>");
}

void bind_result(py::module_& m) {
  py::class_<Answer> c(
      m, "Result", "The answer to one query. Made by collide(). Arrays are read-only and share its memory.");
  const auto of_result = properties_of(
      c, [](const Answer& a) -> const auto& { return *a.result; });
  of_result(
      "relation",
      R"(str: 'separate', 'crossing', 'touching', 'a_inside_b', 'b_inside_a', 'undefined' (the surfaces are
disjoint, the bodies' boxes overlap, and a body is not closed), 'unresolved' (only with limits).)",
      &CollideResult::relation);
  c.def_property_readonly(
      "pairs", &pairs_of,
      "(p, 2) uint32: the intersecting triangles of A and of B, ascending. At most one pair unless mode is 'all'.");
  c.def_property_readonly(
      "face_pairs", &face_pairs_of,
      "(p, 2) uint32: the faces of these triangles; differs from `pairs` for polygons only.");
  of_result("crosses", "(p,) bool: True if the pair crosses; False if it touches.",
            [](const CollideResult& r) {
              return column(r.meets, [](exact::Meet meet) { return meet == exact::Meet::cross; });
            });
  property(c, "fingerprint", "str: 16 hexadecimal digits, a hash of `pairs`.", &fingerprint_of);
  of_result("interiors_overlap",
            "bool or None: True if the bodies share a volume; None if not known or not requested.",
            &CollideResult::interiors_overlap);
  c.def_property_readonly("regions", &regions_of, "list of ContactRegion: if contacts were requested.");
  property(
      c, "points",
      R"(((c, 3) float64, (c,) uint32): corners of the intersections of pairs, world frame, and the pair of each, if
contacts were requested.)",
      &points_of);
  of_result("counters", "dict: the work of the query, in numbers of operations.",
            [](const CollideResult& r) { return dict_of(r.counters); });
  of_result("error_bound",
            "float: 0 if the answer is exact; else the sum of both intersecting wrappers' maximum deviations "
            "from their bodies, world's unit.",
            &CollideResult::error_bound);
  of_result("finished", "bool: False if a limit was reached before the tolerance.", &CollideResult::finished);
  property(c, "separation",
           "dict or None: the regions that prove the bodies separate when refined, if requested.",
           &separation_of);
  of_result("opened", "((i,) uint32, (j,) uint32): regions of A and of B that were refined, in order.",
            &CollideResult::opened);
  c.def(
      "__bool__", [](const Answer& a) { return in_contact(*a.result); },
      R"(True if the bodies are known to have a point in common: surfaces intersect, or one body is inside the other.)");
  c.def("__repr__", &answer_text);
  make_picklable(c);
}

/// Returns all pairs of all poses as rows pose, triangle of A, triangle of B.
py::array_t<std::uint32_t> all_pairs(const Answers& answers) {
  std::vector<std::array<std::uint32_t, 3>> rows;
  for (std::uint32_t i = 0; i < answers.all.size(); ++i)
    for (const SimplexPair& p : answers.all[i].result->pairs) rows.push_back({i, p.a, p.b});
  return column(rows, std::identity());
}

void bind_results(py::module_& m) {
  auto c = bind_sequence<Answers>(m, "Results",
                                  "Answers for k poses: a sequence of Result, in the order of the poses.");
  const auto of_each = rows_of(c, "poses", &Answers::all);
  of_each("relations", "(k,) str: Result.relation of each.",
          [](const Answer& a) { return std::string(name_of(a.result->relation)); });
  of_each("fingerprints", "(k,) str: Result.fingerprint of each.", &fingerprint_of);
  of_each("counts", "(k,) int64: the number of pairs of each.",
          [](const Answer& a) { return static_cast<std::int64_t>(a.result->pairs.size()); });
  of_each("hits", "(k,) bool: bool() of each.", [](const Answer& a) { return in_contact(*a.result); });
  property(c, "all_pairs", "(n, 3) uint32: the pairs of all poses: pose, triangle of A, triangle of B.",
           &all_pairs);
}

py::list curves_of(const ContactRegion& r) {
  py::list out;
  for (const ContactLoop& loop : r.loops) out.append(py::make_tuple(to_python(loop.points), loop.closed));
  return out;
}

py::list half_edges_of(const ContactRegion& r) {
  py::list out;
  for (const ContactLoop& loop : r.loops)
    out.append(column(loop.half_edges, [](const ContactHalfEdge& e) {
      return std::array<std::uint32_t, 5>{e.pair, e.on_a.dim, e.on_a.index, e.on_b.dim, e.on_b.index};
    }));
  return out;
}

void bind_region(py::module_& m) {
  py::class_<ContactRegion> c(
      m, "ContactRegion",
      "A connected part of the intersection of two surfaces; world frame, the meshes' unit.");
  property(c, "pairs", "(i,) uint32: indices into Result.pairs, ascending.", &ContactRegion::pairs);
  property(c, "curves", "list of ((q, 3) float64, bool): the points of each curve, and whether it is closed.",
           &curves_of);
  property(
      c, "half_edges",
      "list of (s, 5) uint32: from each point of a curve to the next, the index into Result.pairs, and where "
      "it starts on A's and B's triangle: the dimension of the corner, edge or inside, and its number.",
      &half_edges_of);
  property(c, "length", "float: of all curves.", &ContactRegion::length);
  property(c, "area", "float: of the coplanar contact or the area spanned by closed curves; unit squared.",
           &ContactRegion::area);
  property(c, "centroid", "(3,) float64", &ContactRegion::centroid);
  property(
      c, "normal",
      "(3,) float64: unit, from A to B, of the contact manifold of the region's pairs that overlaps least; "
      "zero if undefined.",
      &ContactRegion::normal);
  property(c, "depth_estimate",
           "float: the depth of this manifold, along `normal`; 0 if the bodies only touch.",
           &ContactRegion::depth_estimate);
  c.def("__repr__", [](const ContactRegion& r) {
    return "<lrbscope.ContactRegion of " + std::to_string(r.pairs.size()) + " pairs>";
  });
  make_picklable(c);
}

}  // namespace

std::vector<Answer> with_results(std::vector<Answer> answers, std::vector<CollideResult> results) {
  const auto shared = std::make_shared<const std::vector<CollideResult>>(std::move(results));
  for (std::size_t i = 0; i < answers.size(); ++i) answers[i].result = {shared, &(*shared)[i]};
  return answers;
}

bool in_contact(const CollideResult& r) {
  return !r.pairs.empty() || is_inside(r.relation);
}

void find_depths(Answer& answer) {
  const CollideResult& result = *answer.result;
  std::vector<RegionDepth>& depths = answer.depths;
  if (!depths.empty() || result.regions.empty()) return;
  for (const ContactRegion& region : result.regions) depths.push_back({region.normal, region.depth_estimate});
  ManifoldRequest request;
  request.max_pairs = std::max<std::uint64_t>(result.pairs.size(), 1);
  const ManifoldResult found = contact_manifolds(*answer.a, answer.pose_a, *answer.b, answer.pose_b, request);
  // The paper's recursions may miss pairs; the numbers of pairs differ then.
  const auto is_same = [](const NearPair& x, const SimplexPair& y) { return x.a == y.a && x.b == y.b; };
  if (!std::equal(found.pairs.begin(), found.pairs.end(), result.pairs.begin(), result.pairs.end(), is_same))
    return;
  std::vector<const ContactManifold*> manifold_of(found.pairs.size());
  for (const ContactManifold& manifold : found.manifolds)
    for (const std::uint32_t pair : manifold.pairs) manifold_of[pair] = &manifold;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const std::vector<std::uint32_t>& pairs = result.regions[i].pairs;
    // Along any of the normals B leaves a convex A: the least depth is that of the contact. 0: a side that
    // only touches.
    const auto later = [&](std::uint32_t x, std::uint32_t y) {
      const double p = manifold_of[x]->points[0].depth, q = manifold_of[y]->points[0].depth;
      return std::pair(p <= 0, p) < std::pair(q <= 0, q);
    };
    const ContactManifold& least = *manifold_of[*std::min_element(pairs.begin(), pairs.end(), later)];
    depths[i] = {least.normal, std::max(least.points[0].depth, 0.0)};
  }
}

py::list regions_of(Answer& answer) {
  Answer copy = answer;  // another thread may ask meanwhile
  {
    const py::gil_scoped_release unlocked;
    find_depths(copy);
  }
  answer.depths = std::move(copy.depths);
  py::list out;
  for (std::size_t i = 0; i < answer.depths.size(); ++i) {
    ContactRegion region = answer.result->regions[i];
    region.normal = answer.depths[i].normal;
    region.depth_estimate = answer.depths[i].depth;
    out.append(std::move(region));
  }
  return out;
}

void bind_answers(py::module_& m) {
  bind_region(m);
  bind_result(m);
  bind_results(m);
}

static const pid_t loaded_by = getpid();

unsigned threads_of(std::size_t requested) {
  if (getpid() != loaded_by) return 1;
  if (requested > 0) return static_cast<unsigned>(requested);
  const unsigned all = std::thread::hardware_concurrency();
  return all > 0 ? all : 1;
}

Progress::Progress(py::handle progress)
    : callee_(py::reinterpret_borrow<py::object>(progress)), is_bar_(progress.is(py::bool_(true))) {
  if (is_bar_)
    callee_ = py::module_::import("lrbscope._progress").attr("Bar")();
  else if (progress.is(py::bool_(false)))
    callee_ = py::none();
  else if (!progress.is_none() && !PyCallable_Check(progress.ptr()))
    throw py::type_error("progress: expected a callable, True or None, got " + described(progress));
}

Progress::~Progress() {
  if (!is_bar_) return;
  // An exception that is being raised is kept; a fault of the bar itself has no effect on the result.
  const py::error_scope kept;
  try {
    callee_.attr("close")();
  } catch (const py::error_already_set&) {
  }
}

void Progress::operator()(const std::string& what, std::uint64_t done, std::uint64_t total) const {
  const py::gil_scoped_acquire lock;
  check_signals();
  if (!callee_.is_none()) callee_(what, done, total);
}

void check_signals() {
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void run_batch(std::size_t n, unsigned threads, const std::function<void(std::size_t, unsigned)>& work) {
  constexpr std::chrono::milliseconds kMoment{50};
  const py::gil_scoped_release unlocked;
  std::atomic<bool> stop = false;
  // On a separate thread, so that this one, which receives Python's signals, can wait for both.
  std::future<void> all = std::async(std::launch::async, [&] {
    Workers workers(threads);
    workers.for_each(n, [&](std::size_t i, unsigned worker) {
      if (!stop.load(std::memory_order_relaxed)) work(i, worker);
    });
  });
  try {
    while (all.wait_for(kMoment) != std::future_status::ready) check_signals();
  } catch (...) {
    stop = true;  // the end of `all` waits
    throw;
  }
  all.get();
}

}  // namespace lrb::python
