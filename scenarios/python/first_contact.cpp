#include "scenarios/python/first_contact.hpp"

#include "engine/query/motion/first_contact.hpp"
#include "scenarios/python/answers.hpp"
#include "scenarios/python/batch.hpp"

namespace lrb::python {
namespace {

struct FirstContact {
  std::shared_ptr<const FirstContactResult> result;
};
struct FirstContacts {
  std::shared_ptr<const std::vector<FirstContactResult>> all;
  FirstContact at(std::size_t i) const { return {{all, &(*all)[i]}}; }
};

/// Returns the motion through some poses, at equal times from 0 to 1; through one: at rest.
Motion motion_through(std::span<const Pose> poses) {
  if (poses.size() == 1) return Motion::still(poses[0]);
  std::vector<Motion::KeyFrame> frames;
  const auto last = static_cast<double>(poses.size() - 1);
  for (std::size_t i = 0; i < poses.size(); ++i) frames.push_back({static_cast<double>(i) / last, poses[i]});
  return Motion::key_frames(frames);
}

/// Motions of a body, and whether one was given.
struct Motions {
  std::vector<Motion> all;
  bool one = true;
};

/// Reads (4, 4), at rest, or (m, 4, 4), through m poses, as one motion; (k, m, 4, 4) as many.
Motions motions(py::handle given, const char* what) {
  const bool many = py::isinstance<py::array>(given) && py::reinterpret_borrow<py::array>(given).ndim() == 4;
  Motions out;
  out.one = !many;
  const py::list each = many ? py::list(py::reinterpret_borrow<py::object>(given)) : py::list();
  const auto add = [&](py::handle one) {
    const std::vector<Pose> through = poses(one, what).to_vector();
    if (through.empty()) throw InputError(std::string(what) + ": expected a pose or more, got none");
    out.all.push_back(motion_through(through));
  };
  if (!many) add(given);
  for (const py::handle one : each) add(one);
  return out;
}

py::object first_contact(py::handle a, py::handle b, py::handle motion_b, py::handle motion_a,
                         py::handle tolerance, py::handle max_steps, py::handle relation,
                         py::handle threads) {
  const Body &body_a = body(a, "a"), &body_b = body(b, "b");
  const Motions of_b = motions(motion_b, "motion_b"), of_a = motions(motion_a, "motion_a");
  if (!of_a.one) throw InputError("motion_a: expected one motion, (m, 4, 4)");
  FirstContactRequest request;
  request.tolerance = size(tolerance, "tolerance", request.tolerance);
  request.max_steps = count(max_steps, "max_steps", request.max_steps);
  request.relation = flag(relation, "relation", true);
  auto results = std::make_shared<std::vector<FirstContactResult>>(of_b.all.size());
  const unsigned n = of_b.one ? 1 : threads_of(count(threads, "threads"));
  // Alone, too, because it can take a while: Ctrl-C ends the wait for those that have not begun.
  run_batch(of_b.all.size(), n, [&](std::size_t i, unsigned) {
    (*results)[i] = lrb::first_contact(body_a.rep(), of_a.all[0], body_b.rep(), of_b.all[i], request);
  });
  const FirstContacts found{std::move(results)};
  return of_b.one ? py::cast(found.at(0)) : py::cast(found);
}

py::array_t<double> contact_points_of(const FirstContact& f) {
  const std::array<Eigen::Vector3d, 2> points{f.result->witness[0].point, f.result->witness[1].point};
  return array_of(points);
}

py::object pair_of(const FirstContact& f) {
  if (f.result->pair.a == kNull) return py::none();
  return py::make_tuple(f.result->pair.a.value(), f.result->pair.b.value());
}

py::array_t<double> doubtful_of(const FirstContact& f) {
  const std::vector<TimeSpan>& spans = f.result->doubtful;
  static_assert(sizeof(TimeSpan) == 2 * sizeof(double));
  return py::array_t<double>({static_cast<py::ssize_t>(spans.size()), py::ssize_t{2}},
                             reinterpret_cast<const double*>(spans.data()));
}

py::dict counters_of(const FirstContactCounters& c) {
  py::dict d;
  d["spans"] = c.spans;
  d["pairs"] = c.pairs;
  d["steps"] = c.steps;
  d["exact_queries"] = c.exact_queries;
  return d;
}

template <class Value>
py::str word_of(Value value) {
  return py::str(std::string(name_of(value)));
}

void bind_single_contact(py::module_& m) {
  py::class_<FirstContact> c(
      m, "FirstContact",
      "When two moving bodies first meet, as a proved interval of the time t from 0 to 1. "
      "Made by\nfirst_contact().");
  const auto get = [&c](const char* name, auto member, const char* text) {
    c.def_property_readonly(
        name, [member](const FirstContact& f) { return (*f.result).*member; }, text);
  };
  c.def_property_readonly(
      "outcome", [](const FirstContact& f) { return word_of(f.result->outcome); },
      "str: 'contact'; 'never', which is proved; 'undecided': too near each other for doubles to tell.");
  get("t0", &FirstContactResult::t0, "float: they do not meet before; 1 if never.");
  get("t1", &FirstContactResult::t1, "float: they meet here; undecided: after it they do not; 1 if never.");
  get("at_start", &FirstContactResult::at_start, "bool: they meet at t = 0.");
  get("grazing", &FirstContactResult::grazing,
      "bool: the interval is wider than asked, because the bodies graze before.");
  get("passed", &FirstContactResult::passed, "bool: they have met by t1, though not at t1 itself.");
  get("finished", &FirstContactResult::finished, "bool: no limit on steps was reached.");
  c.def_property_readonly(
      "unresolved",
      [](const FirstContact& f) -> py::object {
        if (f.result->unresolved == Unresolved::nothing) return py::none();
        return word_of(f.result->unresolved);
      },
      "str or None: why the interval is wider than asked, or nobody knows whether they meet in it: "
      "'rounding':\nas near each other as rounding; 'steps': a limit on steps was reached.");
  get("speed", &FirstContactResult::speed,
      "float: at which the points come nearer to each other along the normal; world's unit per unit of t.");
  c.def_property_readonly(
      "at_begin", [](const FirstContact& f) { return word_of(f.result->at_begin); },
      "str: how the bodies lie at the start, as Result.relation.");
  c.def_property_readonly("doubtful", &doubtful_of, "(d, 2) float64: spans of t in which nothing is known.");
  c.def_property_readonly("pair", &pair_of, "(int, int) or None: triangles of A and of B that meet at t1.");
  c.def_property_readonly("points", &contact_points_of,
                          "(2, 3) float64: the nearest points of A and of B at t0, world frame.");
  c.def_property_readonly(
      "normal", [](const FirstContact& f) { return array_of(f.result->normal); },
      "(3,) float64: unit, from A to B, at t0; 0 at the start, and where rounding hides it.");
  c.def_property_readonly(
      "counters", [](const FirstContact& f) { return counters_of(f.result->counters); },
      "dict: the work, in numbers of operations.");
  c.def(
      "__bool__", [](const FirstContact& f) { return f.result->is_contact(); },
      "True if the outcome is 'contact'.");
  c.def("__repr__", [](const FirstContact& f) {
    const std::string t0 = py::str(py::float_(f.result->t0)), t1 = py::str(py::float_(f.result->t1));
    return "<lrbscope.FirstContact " + std::string(name_of(f.result->outcome)) + ", t in [" + t0 + ", " + t1 +
           "]>";
  });
}

void bind_first_contacts(py::module_& m) {
  py::class_<FirstContacts> c(m, "FirstContacts",
                              "First contacts for k motions: a sequence of FirstContact, in their order.");
  c.def("__len__", [](const FirstContacts& f) { return f.all->size(); });
  c.def("__getitem__",
        [](const FirstContacts& f, py::ssize_t i) { return f.at(checked_index(i, f.all->size())); });
  const auto ends = [&c](const char* name, double FirstContactResult::*end, const char* text) {
    c.def_property_readonly(
        name,
        [end](const FirstContacts& f) {
          py::array_t<double> out(static_cast<py::ssize_t>(f.all->size()));
          for (std::size_t i = 0; i < f.all->size(); ++i) out.mutable_data()[i] = (*f.all)[i].*end;
          return out;
        },
        text);
  };
  ends("t0", &FirstContactResult::t0, "(k,) float64: FirstContact.t0 of each.");
  ends("t1", &FirstContactResult::t1, "(k,) float64: FirstContact.t1 of each.");
}

}  // namespace

void bind_first_contact(py::module_& m) {
  bind_single_contact(m);
  bind_first_contacts(m);
  const py::none no;
  m.def("first_contact", &first_contact, py::arg("a"), py::arg("b"), py::arg("motion_b"),
        py::arg("motion_a") = no, py::kw_only(), py::arg("tolerance") = no, py::arg("max_steps") = no,
        py::arg("relation") = no, py::arg("threads") = no,
        R"(first_contact(a, b, motion_b, motion_a=None, *, tolerance=1e-9, max_steps=10000000, relation=True,
              threads=0)

Finds when the surfaces of two moving bodies first meet, as an interval of t that is proved to hold it.

motion_b: (m, 4, 4) float, m >= 2: poses at equal times from t = 0 to t = 1, rotations; between two of them B
    turns by the shortest arc and its origin moves straight. (4, 4): at rest. (k, m, 4, 4): k motions, on all
    cores.
motion_a: (m, 4, 4) or (4, 4); None: at rest at the identity.
tolerance: the widest interval, in t. max_steps: of the search, which has a limit of its own, too; 0: that
    alone.
relation: find out how bodies lie at the start that do not meet there.

Returns a FirstContact, or for (k, m, 4, 4) a FirstContacts.

>>> f = first_contact(cube, cube, [shifted(3, 0.1, 0.2), shifted(0, 0.1, 0.2)])
>>> f.outcome, round(f.t0, 6)
('contact', 0.666667))");
}

}  // namespace lrb::python
