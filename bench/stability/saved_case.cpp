#include "bench/stability/saved_case.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>

#include <sys/utsname.h>

#include "bench/methods/triangles.hpp"
#include "bench/stability/case_picture.hpp"
#include "bench/stability/rational_oracles.hpp"
#include "bench/workers/worker_json.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/io/poses.hpp"
#include <lrbscope/contact.hpp>
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::stability {

namespace {

using Json = nlohmann::ordered_json;

Json point_json(const oracle::RationalPoint& x) {
  return {x[0].str(), x[1].str(), x[2].str()};
}

Json corners_json(const Corners& corners) {
  Json out = Json::array();
  for (const oracle::RationalPoint& x : oracle::rational(corners)) out.push_back(point_json(x));
  return out;
}

/// Returns the pairs as [[a, b], ...].
Json pairs_json(const std::vector<SimplexPair>& pairs) {
  Json out = Json::array();
  for (const SimplexPair& p : pairs) out.push_back({p.a.value(), p.b.value()});
  return out;
}

Json engine_json(const Replay& r) {
  Json out = {{"method", r.record.method}, {"outcome", name_of(r.record.outcome)}};
  if (!r.record.message.empty()) out["message"] = r.record.message;
  if (!r.record.relation.empty()) {
    out["relation"] = r.record.relation;
    out["expected_relation"] = r.record.expected_relation;
  }
  out["missed"] = r.record.missed;
  out["extra"] = r.record.extra;
  if (r.answered) out["pairs"] = pairs_json(*r.answered);
  return out;
}

}  // namespace

Json pair_proof(const cases::Case& c, const SimplexPair& pair) {
  const PosedPair posed(c, pair);
  const oracle::RationalClosest closest = posed.closest();
  Json out = {{"pair", {pair.a.value(), pair.b.value()}},
              {"a", corners_json(posed.x[0])},
              {"b", corners_json(posed.x[1])}};
  out["intersect"] = closest.distance_sq == 0;
  if (closest.distance_sq == 0) {
    out["common_point"] = point_json(closest.on_f);
    return out;
  }
  // The planes through the closest points, across the segment between them, separate convex sets.
  const oracle::RationalPoint direction = oracle::minus(closest.on_g, closest.on_f);
  out["closest_points"] = {point_json(closest.on_f), point_json(closest.on_g)};
  out["direction"] = point_json(direction);
  out["largest_of_a"] = oracle::dot(direction, closest.on_f).str();
  out["least_of_b"] = oracle::dot(direction, closest.on_g).str();
  // The square may be outside the range of doubles, so its root is that of the square times 4^shift.
  oracle::Rational square = closest.distance_sq;
  int shift = 0;
  for (; square < 1; ++shift) square *= 4;
  for (; square > 4; --shift) square /= 4;
  out["distance"] = io::number_text(std::ldexp(std::sqrt(square.convert_to<double>()), -shift), 3);
  return out;
}

namespace {

/// Returns the pair that decides: the worst that an engine missed or added (failing_pair()), else the first
/// of the right answer. Returns nullopt if there is none.
std::optional<SimplexPair> deciding_pair(const cases::Case& c, const std::vector<Replay>& replays) {
  for (const Replay& r : replays)
    if (const auto pair = failing_pair(c, r)) return pair;
  for (const Replay& r : replays)
    if (!r.expected.empty()) return r.expected.front();
  return std::nullopt;
}

}  // namespace

std::vector<std::string> save_case(const cases::Case& c, const std::vector<Replay>& replays,
                                   const std::string& folder, const Json* minimised) {
  std::vector<std::string> files;
  const auto write = [&](const LrbRep& rep, const std::string& name) {
    write_mesh(methods::real_mesh(rep), folder + "/" + name);
    files.push_back(name);
  };
  const Record& r = replays.front().record;
  const RightAnswer right = expected_answer(c);
  Json j = Json::object();
  if (!r.family.empty())
    j = {{"family", r.family}, {"difficulty", r.difficulty}, {"case", r.case_index}, {"seed", r.seed}};
  if (minimised != nullptr) j["minimised"] = *minimised;
  j["what"] =
      "Do the simplices (triangles; segments in the plane) of A and of B intersect, each pair of them? They are numbered from "
      "0 in file order, polygons as fans. A vertex is at the doubles next to pose * vertex, as in a_world.obj and b_world.obj.";
  j["pose_a"] = io::rows_of(c.pose_a);
  j["pose_b"] = io::rows_of(c.pose_b);
  make_folder(folder);
  write(*c.a, "a.obj");
  write(*c.b, "b.obj");
  if (right.rejection.empty()) {
    write(methods::at_pose(*c.a, c.pose_a), "a_world.obj");
    write(methods::at_pose(*c.b, c.pose_b), "b_world.obj");
    j["expected"] = {{"relation", to_string(right.relation)}, {"pairs", pairs_json(right.pairs)}};
    const std::optional<SimplexPair> pair = deciding_pair(c, replays);
    j["proof"] = pair ? pair_proof(c, *pair) : Json(nullptr);
  } else {
    j["expected"] = {{"rejected", right.rejection}};
  }
  j["engines"] = Json::array();
  for (const Replay& replay : replays) j["engines"].push_back(engine_json(replay));
  io::write_text(folder + "/case.json", j.dump(1) + "\n");
  files.emplace_back("case.json");
  return files;
}

SavedCase load_case(const std::string& folder) {
  const std::string file = folder + "/case.json";
  const auto value = nlohmann::json::parse(io::read_text(file), nullptr, false);
  const auto fail = [&](const std::string& found) -> InputError {
    return InputError(printable_name(file) + ": expected a case as `stability --save` writes it, found " +
                      found);
  };
  if (!value.is_object()) throw fail("no JSON object");
  SavedCase out;
  const auto pose = [&](const char* key) {
    try {
      return io::pose_of(value.at(key).get<std::array<double, 12>>());
    } catch (const nlohmann::json::exception&) {
      throw fail(std::string("no 12 numbers under \"") + key + "\"");
    }
  };
  out.meshes.pose_a = pose("pose_a");
  out.meshes.pose_b = pose("pose_b");
  out.meshes.a = read_mesh(folder + "/a.obj");
  out.meshes.b = read_mesh(folder + "/b.obj");
  if (out.meshes.a.dim != out.meshes.b.dim) throw fail("a 2D and a 3D mesh");
  try {
    if (!value.contains("family")) return out;
    out.origin.family = value.at("family");
    out.origin.difficulty = value.at("difficulty");
    out.origin.case_index = value.at("case");
    out.origin.seed = value.at("seed");
  } catch (const nlohmann::json::exception&) {
    throw fail("a family without difficulty, case and seed");
  }
  return out;
}

// Counterexamples.

namespace {

using Eigen::Vector3d;

const CaseMeshes& meshes(const Counterexample& c) {
  return c.found.meshes;
}

bool flat(const Counterexample& c) {
  return meshes(c).a.dim == 2;
}

std::string simplices(const Counterexample& c, std::size_t n) {
  return render::counted(n, flat(c) ? "segment" : "triangle", flat(c) ? "segments" : "triangles");
}

std::string pose_text(const Pose& pose) {
  const std::array<double, 12> rows = io::rows_of(pose);
  std::string out;
  for (std::size_t i = 0; i < rows.size(); ++i) out += io::exact_text(rows[i]) + (i % 4 == 3 ? "\n" : " ");
  return out;
}

bool fits_float(const CaseMeshes& c) {
  const auto fits = [](const Mesh& m) {
    return std::all_of(m.vertices.begin(), m.vertices.end(),
                       [](const Vector3d& v) { return v.cast<float>().cast<double>() == v; });
  };
  return fits(c.a) && fits(c.b);
}

/// Returns how a pair intersects: "cross in a segment".
std::string meet_text(const cases::Case& c, const SimplexPair& pair) {
  const exact::PairContact contact = PosedPair(c, pair).contact();
  static constexpr const char* kShapes[] = {"nowhere", "a point", "a segment", "a polygon"};
  return std::string(contact.meet == exact::Meet::cross ? "cross" : "touch") + " in " +
         kShapes[std::min<std::size_t>(contact.corner_count, 3)] +
         (contact.coplanar ? (c.a->dim() == 3 ? " of their common plane" : " of their common line") : "");
}

/// Returns a point as "(1, -1/3, 0)".
std::string point_text(const nlohmann::ordered_json& point) {
  return "(" + point.at(0).get<std::string>() + ", " + point.at(1).get<std::string>() + ", " +
         point.at(2).get<std::string>() + ")";
}

/// Returns why the expected answer is right.
std::string proof_text(const Counterexample& c) {
  const cases::Case built = case_of(meshes(c));
  const std::optional<SimplexPair> pair = deciding_pair(built, {c.found.answer});
  if (!pair) return "No pair of triangles decides: only the relation of the bodies is wrong.\n";
  const char* what = flat(c) ? "Segment " : "Triangle ";
  const char* other = flat(c) ? " of A and segment " : " of A and triangle ";
  const std::string names =
      what + std::to_string(pair->a) + other + std::to_string(pair->b) + " of B (numbered from 0) ";
  const auto proof = pair_proof(built, *pair);
  if (proof.at("intersect").get<bool>())
    return names + meet_text(built, *pair) + ". Both contain the point " +
           point_text(proof.at("common_point")) + ", exactly.\n";
  return names + "are disjoint. For all points x of the first, n . x <= " +
         proof.at("largest_of_a").get<std::string>() +
         ", and for all points of the second, n . x >= " + proof.at("least_of_b").get<std::string>() +
         ", with n = " + point_text(proof.at("direction")) + ", exactly. Their distance is " +
         proof.at("distance").get<std::string>() + ".\n";
}

std::string answer_of(const Counterexample& c) {
  const Replay& answer = c.found.answer;
  const Record& r = answer.record;
  switch (c.found.kind) {
    case FailureKind::crashes:
      return "The process ended: " + r.message + ".\n";
    case FailureKind::times_out:
      return "There was " + r.message + ".\n";
    case FailureKind::relation:
      return "Relation: " + r.relation + " instead of " + r.expected_relation + ".\n";
    default:
      break;
  }
  if (!answer.answered) return std::string("Contact: ") + (r.extra > 0 ? "yes" : "no") + ".\n";
  if (answer.answered->empty()) return "No pair.\n";
  std::string out = "Pairs (of A, of B):";
  for (const SimplexPair& p : *answer.answered) out += " " + std::to_string(p.a) + "-" + std::to_string(p.b);
  return out + ".\n";
}

/// Returns a remark on failures that the definition of contact decides.
std::string remark_of(const Counterexample& c) {
  if (c.found.kind == FailureKind::misses_touching)
    return "The expected answer counts sets that share a single point as intersecting. If this engine is documented not to "
           "count such contacts, its answer is right.\n\n";
  if (c.found.kind == FailureKind::adds)
    return "The expected answer has no tolerance. If this engine is documented to have one, and the distance above is "
           "within it, its answer is right.\n\n";
  return "";
}

std::string versions(const Counterexample& c) {
  utsname machine{};
  uname(&machine);
  return c.method.info.title + "; called by lrbscope " + trace::lrbscope_version() + ", compiled with " +
#ifdef __clang__
         "clang " __clang_version__
#else
         "gcc " __VERSION__
#endif
         + ", " + machine.sysname + " " + machine.machine + "\n";
}

/// Returns the failure in words: "misses a pair of triangles that cross".
std::string failure_text(const Counterexample& c) {
  const std::string pair = flat(c) ? "a pair of segments" : "a pair of triangles";
  const bool lists = c.found.answer.answered.has_value();
  switch (c.found.kind) {
    case FailureKind::misses_crossing:
      return (lists ? "misses " + pair : "reports no contact of bodies") + " that cross";
    case FailureKind::misses_touching:
      return (lists ? "misses " + pair : "reports no contact of bodies") + " that touch";
    case FailureKind::adds:
      return (lists ? "returns " + pair : "reports a contact of bodies") + " that do not intersect";
    case FailureKind::relation:
      return "reports a wrong relation of two bodies";
    case FailureKind::crashes:
      return "ends the process";
    case FailureKind::times_out:
      return "does not answer";
    case FailureKind::none:
      break;
  }
  return "does not fail";
}

/// Returns a program in C++ that shows the failure with the engine alone, or an empty string for
/// other methods than FCL's.
std::string program_text(const Counterexample& c) {
  const std::string& name = c.method.info.name;
  const bool lists = c.found.kind != FailureKind::crashes && c.found.kind != FailureKind::times_out;
  if ((name != "fcl" && name != "fcl-float") || !lists || !is_identity(meshes(c).pose_a) ||
      !is_identity(meshes(c).pose_b))
    return "";
  const std::string real = name == "fcl" ? "double" : "float";
  const auto model = [&](const char* body, const Mesh& m) {
    std::string points, triangles;
    for (const Vector3d& v : m.vertices)
      points += (points.empty() ? "{" : ", {") + io::exact_text(v.x()) + ", " + io::exact_text(v.y()) + ", " +
                io::exact_text(v.z()) + "}";
    for (FaceId f = 0; f < m.face_count(); ++f)
      triangles += (triangles.empty() ? "{" : ", {") + std::to_string(m.face(f)[0]) + ", " +
                   std::to_string(m.face(f)[1]) + ", " + std::to_string(m.face(f)[2]) + "}";
    return std::string("  fill(") + body + ", {" + points + "},\n       {" + triangles + "});\n";
  };
  return "// g++ -std=c++17 -I/usr/include/eigen3 fcl.cpp -lfcl -lccd && ./a.out\n// Expected: " +
         std::to_string(c.found.answer.expected.size()) + R"( contacts.
#include <cstdio>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>

using Real = )" +
         real + R"(;
using Model = fcl::BVHModel<fcl::OBBRSS<Real>>;

void fill(Model& m, const std::vector<fcl::Vector3<Real>>& x, const std::vector<fcl::Triangle>& t) {
  m.beginModel();
  m.addSubModel(x, t);
  m.endModel();
}

int main() {
  Model a, b;
)" + model("a", meshes(c).a) +
         model("b", meshes(c).b) + R"(  const fcl::CollisionRequest<Real> request(1000000, false);
  fcl::CollisionResult<Real> result;
  const fcl::Transform3<Real> identity = fcl::Transform3<Real>::Identity();
  fcl::collide(&a, identity, &b, identity, request, result);
  std::printf("%zu contacts\n", result.numContacts());
}
)";
}

/// Returns the text for the tracker of a saved case, in Markdown: the function called, the meshes, the right
/// answer with its proof, the engine's answer, and versions.
std::string tracker_text(const Counterexample& c, const std::string& folder) {
  std::ostringstream out;
  out << "# " << c.method.info.title << " " << failure_text(c) << "\n\n";
  out << "A has " << simplices(c, meshes(c).a.face_count()) << ", B "
      << simplices(c, meshes(c).b.face_count());
  out << (fits_float(meshes(c)) ? ". All coordinates are floats.\n\n" : ". Coordinates are doubles.\n\n");
  out << "![The meshes](picture.png)\n\n";
  out << "## Meshes\n\nA:\n\n```\n"
      << io::read_text(folder + "/a.obj") << "```\n\nB:\n\n```\n"
      << io::read_text(folder + "/b.obj") << "```\n\n";
  if (is_identity(meshes(c).pose_a) && is_identity(meshes(c).pose_b))
    out << "Both poses are the identity.\n\n";
  else
    out << "Poses of A and of B (3x4, row by row):\n\n```\n"
        << pose_text(meshes(c).pose_a) << "\n"
        << pose_text(meshes(c).pose_b) << "```\n\n";
  out << "## Called\n\n" << c.method.info.remark << "\n\n";
  const std::string program = program_text(c);
  if (!program.empty()) out << "```cpp\n" << program << "```\n\n";
  out << "## Expected\n\n" << proof_text(c) << "\n";
  out << "## Found\n\n" << answer_of(c) << "\n" << remark_of(c);
  out << "## Versions\n\n" << versions(c);
  return out.str();
}

}  // namespace

std::vector<std::string> save_counterexample(const Counterexample& c, const std::string& folder) {
  const cases::Case built = case_of(meshes(c));
  const Minimised& m = c.found;
  const auto size = [](const CaseSize& s) {
    return nlohmann::ordered_json{{"simplices", s.simplices}, {"vertices", s.vertices}, {"bits", s.bits}};
  };
  const nlohmann::ordered_json facts = {{"failure", name_of(m.kind)},
                                        {"before", size(m.before)},
                                        {"after", size(m.after)},
                                        {"calls", m.calls},
                                        {"complete", m.complete}};
  WorstCaseText text;
  text.title = c.method.info.title;
  text.answer = failure_text(c);
  render::Rasterizer rasterizer;
  const render::Image picture =
      worst_case_picture(built, m.answer.expected, m.answer.answered, text, rasterizer);
  std::vector<std::string> files = save_case(built, {m.answer}, folder, &facts);
  render::PngOptions png;
  png.text = {{"Title", text.title}, {"Description", text.answer}};
  render::write_png(picture, folder + "/picture.png", png);
  files.emplace_back("picture.png");
  const std::string program = program_text(c);
  if (!program.empty()) {
    io::write_text(folder + "/fcl.cpp", program);
    files.emplace_back("fcl.cpp");
  }
  io::write_text(folder + "/report.md", tracker_text(c, folder) + "\nMade by `" + c.command + "`.\n");
  files.emplace_back("report.md");
  return files;
}

}  // namespace lrb::stability
