#pragma once
/// One interface for everything that finds the pairs of triangles in which two bodies meet: ours, brute
/// force, and engines of others. Bodies are built once and queried at many poses; whatever else a query needs
/// is kept from one to the next.

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lrbscope/collide.hpp>
#include <lrbscope/enum_words.hpp>

namespace lrb::methods {

/// What a method says about two bodies whose surfaces do not meet.
enum class Says : std::uint8_t {
  nothing,   ///< only whether and where surfaces meet
  inside,    ///< whether one body lies in the other
  relation,  ///< all of Relation
};
constexpr auto words_of(Says) {
  return std::to_array<EnumWord<Says>>(
      {{Says::nothing, "nothing"}, {Says::inside, "inside"}, {Says::relation, "relation"}});
}

/// What sets a method apart from one that answers exactly for two bodies at two poses.
enum class Trait : std::uint8_t {
  /// Its list includes pairs that are near or behind each other, because that is what contact means to it:
  /// extra pairs are counted, but are wrong only where the bodies do not meet at all.
  loose,
  takes_2d,  ///< takes 2D bodies
  /// Moves vertices exactly as Pose::apply does. Other methods can be given the same question only with world
  /// coordinates in the body and poses that move nothing.
  moves_exactly,
  hard_cases,  ///< takes part in `stability`; else only in `bench` and `chart`
  /// Gives pairs, or points of contact, up to an error that a knob trades for time.
  approximate,
  convex,                  ///< answers for the bodies' convex hulls
  knows_poses_in_advance,  ///< not an answer to the same question
  own_rep,                 ///< works on the LRB-rep as it comes: building a body means building that
};
/// The words are JSON keys of lists of methods.
constexpr auto words_of(Trait) {
  return std::to_array<EnumWord<Trait>>({{Trait::loose, "loose"},
                                         {Trait::takes_2d, "plane"},
                                         {Trait::moves_exactly, "moves_exactly"},
                                         {Trait::hard_cases, "hard_cases"},
                                         {Trait::approximate, "approximate"},
                                         {Trait::convex, "convex"},
                                         {Trait::knows_poses_in_advance, "told_more"},
                                         {Trait::own_rep, "own_rep"}});
}

class Traits {
 public:
  constexpr Traits() = default;
  constexpr Traits(std::initializer_list<Trait> traits) {
    for (const Trait t : traits) set(t);
  }
  constexpr bool has(Trait t) const { return (bits_ & bit(t)) != 0; }
  constexpr void set(Trait t, bool on = true) {
    bits_ = static_cast<std::uint8_t>(on ? bits_ | bit(t) : bits_ & ~bit(t));
  }

 private:
  static constexpr unsigned bit(Trait t) { return 1U << static_cast<unsigned>(t); }
  std::uint8_t bits_ = 0;
};

/// The part that a method plays where methods are compared.
enum class Role : std::uint8_t {
  peer,         ///< answers the question that `ours` does
  ours,         ///< the one that all others are compared with, and that must not fail
  ours_double,  ///< ours without the exact fallback: what exactness costs
  ours_other,   ///< ours, asked otherwise
  aim,          ///< the peer that our aims are set against
  no_peer,      ///< answers another question, or takes minutes: in no table of peers
};
constexpr auto words_of(Role) {
  return std::to_array<EnumWord<Role>>({{Role::peer, "peer"},
                                        {Role::ours, "ours"},
                                        {Role::ours_double, "ours_double"},
                                        {Role::ours_other, "ours_other"},
                                        {Role::aim, "aim"},
                                        {Role::no_peer, "no_peer"}});
}

/// How a method is drawn on charts. Methods of one title are one series, which looks as the first of them
/// does.
struct MethodStyle {
  std::string title;   ///< for the key: "FCL"; empty: a style is chosen, under the method's name
  std::string colour;  ///< #rrggbb
  std::string shape;   ///< Chart.js's name of the point's shape
  friend bool operator==(const MethodStyle&, const MethodStyle&) = default;
};

struct MethodInfo {
  std::string name;    ///< for the command line: "fcl"
  std::string title;   ///< for people, with the version: "FCL 0.7.0, OBBRSS, double"
  std::string remark;  ///< what it answers, and how it was asked
  bool present = true;
  bool pairs = true;          ///< lists the pairs; else it only says whether the surfaces meet
  Says says = Says::nothing;  ///< what it says besides
  Traits traits = {Trait::hard_cases};
  std::string knob;              ///< what `settings` set: "level"; empty: there is nothing to set
  std::vector<double> settings;  ///< settings worth a sweep, from coarse to fine
  MethodStyle style = {};
  Role role = Role::peer;
  int rank = 1000;  ///< the methods' order in tables and charts: by rank, then by file

  bool has(Trait t) const { return traits.has(t); }
};

/// A body in a method's own form.
class MethodBody {
 public:
  virtual ~MethodBody() = default;
};

struct MethodAnswer {
  bool contact = false;            ///< the surfaces meet
  std::vector<SimplexPair> pairs;  ///< ascending, each once; in Mode::first_pair at most one
  std::optional<bool> inside;  ///< no contact, and one body lies in the other; nothing if the method does not
                               ///< say
  std::optional<Relation> relation;  ///< nothing if the method does not say
  double microseconds = 0;           ///< the time of the query alone, without sorting what the method found
  std::uint64_t face_tests = 0;      ///< number of comparisons of two faces (or spheres), if it counts them
  /// Proved: for any point of the answer, the distances to the two bodies add up to no more; world. Nothing
  /// if that is not proved.
  std::optional<double> error_bound;
  std::vector<Eigen::Vector3d> points;  ///< in the world, if it says where the contact is but not which faces
                                        ///< meet
};

/// A method. Not for two threads at once.
class Method {
 public:
  virtual ~Method() = default;
  /// Sets the knob for the queries that follow.
  virtual void set(double) {}
  /// Makes a body from the real simplices of an LRB-rep. Throws InputError if the method cannot take it,
  /// which counts as a refusal.
  virtual std::unique_ptr<MethodBody> build(const LrbRep& rep) = 0;
  /// Answers for two bodies, different objects, that this very method has built. Most methods refuse poses
  /// that are not rotations (InputError).
  virtual MethodAnswer query(const MethodBody& a, const Pose& pose_a, const MethodBody& b, const Pose& pose_b,
                             Mode mode) = 0;
};

/// A method that this program may have or not.
struct MethodEntry {
  MethodInfo info;
  std::unique_ptr<Method> (*make)() = nullptr;  ///< of those that are present
};
inline int rank_of(const MethodEntry& e) {
  return e.info.rank;
}

/// Returns the entry of a method whose Debian package was not found when the program was built.
inline MethodEntry absent(const char* name, const char* title, const char* package, int rank = 1000,
                          MethodStyle style = {}) {
  MethodInfo info;
  info.rank = rank;
  info.style = std::move(style);
  info.name = name;
  info.title = title;
  info.remark = std::string("Not there when this was built: install Debian's ") + package;
  info.present = false;
  return {info};
}

/// Returns the methods of the program that this is linked to, in their order. A file of this folder defines
/// `std::vector<MethodEntry> NAME_methods()`, and rivals.cmake names it.
std::vector<MethodEntry> registered_methods();

/// Returns the method of that name. Throws InputError if there is none, or it is absent.
const MethodEntry& find_method(const std::vector<MethodEntry>& methods, const std::string& name);

// What methods are asked for where they are compared: pairs that meet, or a number.

enum class Quantity : std::uint8_t {
  pairs,          ///< which pairs meet, and how the bodies lie
  distance,       ///< of the surfaces
  first_contact,  ///< the time at which B, which moves straight, first meets A
  depth,          ///< the length of the shortest translation that parts the bodies
};
constexpr auto words_of(Quantity) {
  return std::to_array<EnumWord<Quantity>>({{Quantity::pairs, "pairs"},
                                            {Quantity::distance, "distance"},
                                            {Quantity::first_contact, "first_contact"},
                                            {Quantity::depth, "depth"}});
}

/// What is said of a first contact if there is none: motions end at 1.
inline constexpr double kNever = 2;

}  // namespace lrb::methods
