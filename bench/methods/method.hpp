#pragma once
/// One interface for every method that finds the intersecting triangle pairs of two bodies, or a number or
/// another list of pairs: lrbscope, brute force, and other engines.

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lrbscope/collide.hpp>
#include <lrbscope/enum_names.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>

namespace lrb::methods {

/// What methods are compared on.
enum class Quantity : std::uint8_t {
  pairs,               ///< intersecting pairs, and the relation of the bodies
  distance,            ///< of the surfaces
  first_contact,       ///< the time of first contact of B, which moves on a straight line, with A
  depth,               ///< length of the shortest translation that separates the bodies
  near_pairs,          ///< pairs of triangles within a distance
  self_intersections,  ///< pairs of triangles of one mesh, made of both bodies
};
constexpr auto enum_names(Quantity) {
  return std::to_array<EnumName<Quantity>>({{Quantity::pairs, "pairs"},
                                            {Quantity::distance, "distance"},
                                            {Quantity::first_contact, "first_contact"},
                                            {Quantity::depth, "depth"},
                                            {Quantity::near_pairs, "near_pairs"},
                                            {Quantity::self_intersections, "self_intersections"}});
}

/// Returns true if the answer is a list of pairs, not a number.
constexpr bool is_list(Quantity q) {
  return q == Quantity::pairs || q == Quantity::near_pairs || q == Quantity::self_intersections;
}

/// Value of a first contact that does not exist: motions end at 1.
inline constexpr double kNever = 2;

/// The answer of a method about two bodies whose surfaces do not intersect.
enum class Says : std::uint8_t {
  nothing,   ///< only whether and where surfaces intersect
  inside,    ///< whether one body is inside the other
  relation,  ///< all of Relation
};
constexpr auto enum_names(Says) {
  return std::to_array<EnumName<Says>>(
      {{Says::nothing, "nothing"}, {Says::inside, "inside"}, {Says::relation, "relation"}});
}

/// Differences from a method that answers exactly for two bodies at two poses.
enum class Trait : std::uint8_t {
  /// Its pairs include close ones or ones behind each other, because of its definition of contact. Extra
  /// pairs are counted, but are wrong only if the bodies do not intersect at all.
  loose,
  takes_2d,  ///< accepts 2D bodies
  /// Transforms vertices exactly as Pose::apply does. Other methods get the same query only if the bodies are
  /// in world coordinates and the poses are the identity.
  moves_exactly,
  hard_cases,  ///< takes part in `stability`; otherwise only in `bench` and `chart`
  /// Returns pairs or contact points up to an error that a parameter trades for time.
  approximate,
  convex,                  ///< answers for the bodies' convex hulls
  knows_poses_in_advance,  ///< answers a different query
  own_rep,                 ///< uses the given LRB-rep directly: building a body means building the LRB-rep
  proves,                  ///< its interval must contain the number
};
/// Names are JSON keys in lists of methods.
constexpr auto enum_names(Trait) {
  return std::to_array<EnumName<Trait>>({{Trait::loose, "loose"},
                                         {Trait::takes_2d, "plane"},
                                         {Trait::moves_exactly, "moves_exactly"},
                                         {Trait::hard_cases, "hard_cases"},
                                         {Trait::approximate, "approximate"},
                                         {Trait::convex, "convex"},
                                         {Trait::knows_poses_in_advance, "told_more"},
                                         {Trait::own_rep, "own_rep"},
                                         {Trait::proves, "proves"}});
}

class Traits {
 public:
  constexpr Traits() = default;
  constexpr Traits(std::initializer_list<Trait> traits) {
    for (const Trait t : traits) set(t);
  }
  constexpr bool has(Trait t) const { return (bits_ & bit(t)) != 0; }
  constexpr void set(Trait t, bool on = true) {
    bits_ = static_cast<std::uint16_t>(on ? bits_ | bit(t) : bits_ & ~bit(t));
  }

 private:
  static constexpr unsigned bit(Trait t) { return 1U << static_cast<unsigned>(t); }
  std::uint16_t bits_ = 0;
};

/// Role of a method in comparisons.
enum class Role : std::uint8_t {
  peer,        ///< answers the same query as `ours`
  ours,        ///< the baseline of all comparisons, which must not fail
  ours_other,  ///< lrbscope with another query, or without the exact fallback
  aim,         ///< the engine that the performance targets refer to
  no_peer,     ///< answers another query or takes minutes: in no table of engines
};
constexpr auto enum_names(Role) {
  return std::to_array<EnumName<Role>>({{Role::peer, "peer"},
                                        {Role::ours, "ours"},
                                        {Role::ours_other, "ours_other"},
                                        {Role::aim, "aim"},
                                        {Role::no_peer, "no_peer"}});
}

/// Style of a method on charts. Methods with the same title form one series, in the style of the first.
struct MethodStyle {
  std::string title;   ///< in the key: "FCL"; empty: a style is chosen, under the method's name
  std::string colour;  ///< #rrggbb
  std::string shape;   ///< Chart.js's name of the point shape
  friend bool operator==(const MethodStyle&, const MethodStyle&) = default;
};

struct MethodInfo {
  std::string name = {};    ///< for the command line: "fcl"
  std::string title = {};   ///< display name with the version: "FCL 0.7.0, OBBRSS, double"
  std::string remark = {};  ///< meaning of the answer, and the options of the query
  bool present = true;
  bool pairs = true;          ///< lists the pairs; false: only reports whether the surfaces intersect
  Says says = Says::nothing;  ///< what else it reports
  Traits traits = {Trait::hard_cases};
  std::string parameter = {};         ///< the parameter that `settings` sets: "level"; empty: none
  std::vector<double> settings = {};  ///< values for a sweep, from coarse to fine
  MethodStyle style = {};
  Role role = Role::peer;
  int rank = 1000;  ///< the methods' order in tables and charts: by rank, then by file
  Quantity quantity = Quantity::pairs;

  bool has(Trait t) const { return traits.has(t); }
};

/// A body in a method's own form.
class MethodBody {
 public:
  virtual ~MethodBody() = default;
};

/// What came of a question.
enum class Outcome : std::uint8_t {
  answered,   ///< and not judged
  right,      ///< all that the method answers is right
  wrong,      ///< missed or extra pairs, a wrong relation, or a wrong number
  rejected,   ///< the method reported that it cannot answer
  crashed,    ///< its process died
  timed_out,  ///< it did not answer in time
};
constexpr auto enum_names(Outcome) {
  return std::to_array<EnumName<Outcome>>({{Outcome::answered, "answered"},
                                           {Outcome::right, "right"},
                                           {Outcome::wrong, "wrong"},
                                           {Outcome::rejected, "refused"},
                                           {Outcome::crashed, "crashed"},
                                           {Outcome::timed_out, "timed_out"}});
}

/// Number of tests of a query for all pairs.
struct TestCounts {
  std::uint64_t boxes = 0;  ///< of two bounding volumes
  std::uint64_t faces = 0;  ///< of two faces
  friend bool operator==(const TestCounts&, const TestCounts&) = default;
};

struct Answer {
  bool contact = false;              ///< the surfaces intersect
  std::vector<SimplexPair> pairs;    ///< ascending, each once; in Mode::first_pair at most one
  std::uint64_t count = 0;           ///< number of pairs, if only that was requested
  std::vector<double> distances;     ///< of near pairs, if reported; of an interval the upper end
  std::optional<bool> inside;        ///< no contact, and one body is inside the other; nullopt: not reported
  std::optional<Relation> relation;  ///< nullopt: not reported
  double lower = 0, upper = 0;       ///< the number, if that is the quantity; equal, unless it is an interval
  double microseconds = 0;           ///< time of the query alone, without sorting the result
  std::optional<std::uint64_t> tests;  ///< of bounding volumes and of faces, if requested and counted
  std::optional<TestCounts> kinds;     ///< the same by kind; nullopt: not known
  std::uint64_t face_tests = 0;        ///< number of comparisons of two faces (or spheres), if it counts them
  /// Proven bound: for any point of the answer, the sum of the distances to both bodies; world units.
  /// nullopt: not proven.
  std::optional<double> error_bound;
  /// World frame; if it reports the location of the contact but not the intersecting faces.
  std::vector<Eigen::Vector3d> points;
  std::map<std::string, std::uint64_t> phases;  ///< tests by the engine's own phases, if it reports them
  /// Visits of nodes that perfect volumes or another order of descent would save (profile::Prices::wasted()),
  /// and tests of triangles that do not intersect; nullopt: not known.
  std::optional<std::uint64_t> wasted;
  Outcome outcome = Outcome::answered;  ///< or why there is no answer: rejected, crashed, timed_out
  std::string message;                  ///< the reason if there is none
  std::vector<Answer>
      exchanged;  ///< if requested, one: the answer to the same question with A and B exchanged

  bool answered() const { return outcome == Outcome::answered; }
};

/// Returns the pairs of an ascending list that another one does not have.
inline std::vector<SimplexPair> without(const std::vector<SimplexPair>& list,
                                        const std::vector<SimplexPair>& other) {
  std::vector<SimplexPair> out;
  std::set_difference(list.begin(), list.end(), other.begin(), other.end(), std::back_inserter(out));
  return out;
}

/// A method for pairs. Bodies are built once and queried at many poses; other data that a query needs are
/// kept between queries. Not thread-safe.
class Method {
 public:
  virtual ~Method() = default;
  /// Sets the parameter for the following queries.
  virtual void set(double) {}
  /// Makes a body from the real simplices of an LRB-rep. Throws InputError if the method does not support it,
  /// which counts as a rejection.
  virtual std::unique_ptr<MethodBody> build(const LrbRep& rep) = 0;
  /// Answers for two bodies, different objects, built by this method. Most methods reject poses that are not
  /// rigid (InputError).
  virtual Answer query(const MethodBody& a, const Pose& pose_a, const MethodBody& b, const Pose& pose_b,
                       Mode mode) = 0;
  /// Runs the query for all pairs again, untimed, and counts its tests. Returns nullopt if the method does
  /// not count them.
  virtual std::optional<TestCounts> count_tests(const MethodBody& a, const Pose& pose_a, const MethodBody& b,
                                                const Pose& pose_b) {
    static_cast<void>(a), static_cast<void>(pose_a), static_cast<void>(b), static_cast<void>(pose_b);
    return std::nullopt;
  }
};

/// A question about another quantity. Both bodies are in world coordinates, so that all methods get the same
/// doubles.
struct Question {
  LrbRep a, b;
  /// Translation of B at t = 0 and t = 1.
  Eigen::Vector3d from{0, 0, 0}, to{0, 0, 0};
  double size = 0;    ///< diagonal of the larger body's box
  double within = 0;  ///< for near pairs: the distance
};

/// The value of a method's parameter. nullopt: the setting for tests of correctness.
using Setting = std::optional<double>;

/// A method for another quantity. Throws InputError if it has no answer, which counts as a rejection.
using Ask = std::function<Answer(const Question&, Setting)>;

/// A method that may or may not be available in this program.
struct MethodEntry {
  MethodInfo info;
  std::unique_ptr<Method> (*make)() = nullptr;  ///< for pairs; null if not available
  Ask ask = {};                                 ///< for other quantities
};
inline int rank_of(const MethodEntry& e) {
  return e.info.rank;
}

/// Returns the entry of a method of class T; the arguments of its constructor are template arguments. T is
/// only declared if the build did not find the engine, which `package` of Debian contains.
template <class T, auto... kArguments>
MethodEntry entry_of(MethodInfo info, const char* package = "") {
  if constexpr (requires { sizeof(T); }) {
    return {std::move(info), []() -> std::unique_ptr<Method> { return std::make_unique<T>(kArguments...); }};
  } else {
    info.remark = std::string("Not found when this was built; install Debian's ") + package;
    info.present = false;
    return {std::move(info)};
  }
}

/// Returns the methods linked into this program, in their order. A file of this folder defines
/// `std::vector<MethodEntry> NAME_methods()` and is listed in the .cmake file next to it.
std::vector<MethodEntry> registered_methods();

/// Returns the method of that name. Throws InputError if it is unknown or absent.
inline const MethodEntry& find_method(const std::vector<MethodEntry>& methods, const std::string& name,
                                      Quantity quantity = Quantity::pairs) {
  for (const MethodEntry& e : methods)
    if (e.info.name == name && e.info.quantity == quantity && e.info.present) return e;
  throw InputError("unknown method '" + name + "', or not installed here");
}

}  // namespace lrb::methods
