#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <memory>
#include <optional>
#include <sstream>

#include <nlohmann/json.hpp>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "engine/query/explain.hpp"
#include "scenarios/bodies/body.hpp"
#include "scenarios/cli/command.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/io/json/pose_list.hpp"
#include "scenarios/run/explanation_words.hpp"
#include "scenarios/run/open_run.hpp"
#include "scenarios/run/pair_picture.hpp"
#include "scenarios/run/parting_picture.hpp"

namespace lrb::cli {
namespace {

using Json = nlohmann::ordered_json;

struct WhyOptions {
  bodies::Corners corners = bodies::Corners::joined;
  std::string a, b, poses, run, picture;
  std::size_t pose = 0;
  std::optional<std::uint32_t> step;
  std::vector<std::uint32_t> pair;
  bool json = false;
};

/// Two bodies, and where they stand.
struct Scene {
  const LrbRep& a;
  const LrbRep& b;
  Pose pose_a, pose_b;
};

Json point_json(const Eigen::Vector3d& x) {
  return {x.x(), x.y(), x.z()};
}

Json boxes_json(const BoxPair& p) {
  return {{"a", p.node[0]}, {"b", p.node[1]}, {"gap", p.gap}, {"axis", name_of(p.axis)}};
}

template <class T>
Json ordered_pair(const T& of_a, const T& of_b) {
  return {{"A", of_a}, {"B", of_b}};
}

Json regions_json(const LrbRep& rep, const std::vector<RegionId>& regions) {
  Json out = Json::array();
  for (const RegionId r : regions)
    out.push_back({{"region", r.value()}, {"layer", rep.layer(r)}, {"lids", rep.lids(r).size()}});
  return out;
}

Json sides_json(const PlaneSides& sides, int corners) {
  Json out = Json::array();
  for (int i = 0; i < corners; ++i)
    out.push_back(
        {{"exact", sides.exact[i]}, {"in_double", sides.in_double[i]}, {"distance", sides.distance[i]}});
  return out;
}

Json contact_json(const exact::PairContact& contact) {
  Json corners = Json::array();
  for (int i = 0; i < contact.corner_count; ++i) corners.push_back(point_json(contact.corners[i].x));
  return {{"coplanar", contact.coplanar}, {"points", corners}};
}

Json as_json(const PairExplanation& e, const Scene& scene) {
  Json j;
  j["pair"] = {e.pair.a.value(), e.pair.b.value()};
  j["faces"] = {scene.a.face_of_simplex(e.pair.a).value(), scene.b.face_of_simplex(e.pair.b).value()};
  j["meet"] = name_of(e.meet);
  j["decided_by"] = name_of(e.decided_by);
  j["nodes"] = Json::array();
  for (const BoxPair& p : e.nodes) j["nodes"].push_back(boxes_json(p));
  if (e.reaches_faces) j["face_boxes"] = boxes_json(e.face_boxes);
  j["hidden_by"] = ordered_pair(regions_json(scene.a, e.hidden_by[0]), regions_json(scene.b, e.hidden_by[1]));
  const int corners = scene.a.dim();
  j["corners_by_the_other_plane"] =
      ordered_pair(sides_json(e.sides[0], corners), sides_json(e.sides[1], corners));
  if (e.meet != exact::Meet::disjoint) {
    j["contact"] = contact_json(e.contact);
  } else {
    j["distance"] = e.distance;
    j["distance_in_ulps"] = e.distance / e.ulp;
    j["nearest"] = {point_json(e.nearest[0]), point_json(e.nearest[1])};
  }
  return j;
}

Json as_json(const WalkExplanation& e) {
  Json j;
  j["relation"] = name_of(e.result.relation);
  j["pairs"] = e.result.pairs.size();
  j["roots"] = boxes_json(e.roots);
  j["depths"] = Json::array();
  for (const WalkDepth& d : e.depths)
    j["depths"].push_back({{"node_pairs", d.node_pairs}, {"ended", d.ended}});
  j["leaf_pairs"] = e.leaf_pairs;
  j["face_pairs"] = e.face_pairs;
  j["left_by_planes"] = e.left;
  j["certain"] = e.certain;
  j["nearest_pairs"] = Json::array();
  for (const SimplexPair& p : e.near) j["nearest_pairs"].push_back({p.a.value(), p.b.value()});
  if (e.nearest_boxes) {
    j["nearest_boxes"] = boxes_json(e.nearest_boxes->pair);
    j["nearest_boxes"]["of_faces"] = e.nearest_boxes->of_faces;
  }
  if (e.plane) j["plane"] = {{"gap", e.plane->gap()}, {"normal", point_json(e.plane->normal)}};
  if (e.result.separation) {
    const auto& [refined, faces] = *e.result.separation;
    j["separation"] = {{"refined", {refined[0].size(), refined[1].size()}}, {"faces", {faces[0], faces[1]}}};
  }
  return j;
}

constexpr int kDigits = 6;

/// Writes one line for each pair of boxes.
void write_way(std::ostream& out, const PairExplanation& e) {
  constexpr int kNode = 10, kGap = 14;
  out << "the way from the roots, largest gap of the boxes first, negative: they overlap\n";
  out << std::setw(kNode) << "A's node" << std::setw(kNode) << "B's node" << std::setw(kGap) << "gap"
      << "  along\n";
  const auto line = [&](const BoxPair& p, const char* what) {
    out << std::setw(kNode) << p.node[0] << std::setw(kNode) << p.node[1] << std::setw(kGap) << p.gap << "  "
        << name_of(p.axis) << what << "\n";
  };
  for (const BoxPair& p : e.nodes) line(p, "");
  if (e.reaches_faces) line(e.face_boxes, ", the faces' own boxes");
}

void write_regions(std::ostream& out, const LrbRep& rep, const std::vector<RegionId>& regions,
                   const char* whose) {
  out << whose << " face is hidden by " << regions.size() << (regions.size() == 1 ? " region" : " regions");
  for (std::size_t i = 0; i < regions.size(); ++i)
    out << (i == 0 ? ", from the outside inward: " : ", ") << regions[i].value() << " (layer "
        << rep.layer(regions[i]) << ")";
  out << "\n";
}

void write_sides(std::ostream& out, const PlaneSides& sides, int corners, const char* whose,
                 const char* other) {
  out << whose << " corners by the " << (corners == 3 ? "plane" : "line") << " of " << other << " face: ";
  for (int i = 0; i < corners; ++i) {
    const int sign = sides.exact[i];
    out << (i == 0 ? "" : ", ")
        << (sign > 0   ? "in front"
            : sign < 0 ? "behind"
                       : "in it")
        << " (" << sides.distance[i] << ")";
    if (sides.in_double[i] != sign) out << " where double arithmetic has " << sides.in_double[i];
  }
  out << "\n";
}

std::string as_text(const PairExplanation& e, const Scene& scene) {
  std::ostringstream out;
  out << std::setprecision(kDigits);
  out << "simplex " << e.pair.a << " of A (face " << scene.a.face_of_simplex(e.pair.a) << " of "
      << scene.a.name() << ") and " << e.pair.b << " of B (face " << scene.b.face_of_simplex(e.pair.b)
      << " of " << scene.b.name() << "): " << name_of(e.meet) << "\n";
  out << "decided by " << run::words(e.decided_by) << "\n\n";
  write_way(out, e);
  out << "\n";
  write_regions(out, scene.a, e.hidden_by[0], "A's");
  write_regions(out, scene.b, e.hidden_by[1], "B's");
  const int corners = scene.a.dim();
  write_sides(out, e.sides[0], corners, "A's", "B's");
  write_sides(out, e.sides[1], corners, "B's", "A's");
  const auto point = [&](const Eigen::Vector3d& x) {
    out << "(" << x.x() << ", " << x.y() << ", " << x.z() << ")";
  };
  if (e.meet == exact::Meet::disjoint) {
    out << "nearest points: ";
    point(e.nearest[0]);
    out << " and ";
    point(e.nearest[1]);
    out << "\ndistance " << e.distance << ", " << e.distance / e.ulp
        << " units in the last place of the largest coordinate\n";
  } else {
    constexpr const char* kinds[] = {"nothing", "point", "segment"};
    out << "contact: " << (e.contact.corner_count < 3 ? kinds[e.contact.corner_count] : "polygon");
    for (int i = 0; i < e.contact.corner_count; ++i) {
      out << (i == 0 ? " " : " to ");
      point(e.contact.corners[i].x);
    }
    out << "\n";
  }
  return out.str();
}

std::string as_text(const WalkExplanation& e) {
  constexpr int kWidth = 12;
  std::ostringstream out;
  out << std::setprecision(kDigits);
  out << name_of(e.result.relation) << ", " << e.result.pairs.size() << " pairs\n";
  out << "boxes round the bodies: gap " << e.roots.gap << " along " << name_of(e.roots.axis) << "\n\n";
  out << std::setw(kWidth) << "depth" << std::setw(kWidth) << "node pairs" << std::setw(kWidth) << "apart"
      << "\n";
  for (std::size_t i = 0; i < e.depths.size(); ++i)
    out << std::setw(kWidth) << i << std::setw(kWidth) << e.depths[i].node_pairs << std::setw(kWidth)
        << e.depths[i].ended << "\n";
  out << "\npairs of leaves " << e.leaf_pairs << ", pairs of faces whose boxes meet " << e.face_pairs
      << "; planes left " << e.left << " of them, about " << e.certain << " of which floats are certain\n";
  if (!e.near.empty()) {
    out << "nearest of those left, for --pair:";
    for (const SimplexPair& p : e.near) out << " " << p.a << "," << p.b;
    out << "\n";
  }
  if (e.result.pairs.empty() && e.left == 0) out << "no two faces come as far as a comparison of their own\n";
  if (const auto& boxes = e.nearest_boxes)
    out << "the nearest of the boxes found apart, of "
        << (boxes->of_faces ? "faces in the leaves " : "nodes ") << boxes->pair.node[0] << " of A and "
        << boxes->pair.node[1] << " of B: gap " << boxes->pair.gap << " along " << name_of(boxes->pair.axis)
        << "\n";
  if (e.plane)
    out << "a plane across (" << e.plane->normal.x() << ", " << e.plane->normal.y() << ", "
        << e.plane->normal.z() << ") has all of A on one side and all of B on the other, " << e.plane->gap()
        << " apart\n";
  if (e.result.separation) {
    const auto& [refined, faces] = *e.result.separation;
    out << "wrappers of " << faces[0] << " and " << faces[1] << " faces, with " << refined[0].size()
        << " and " << refined[1].size()
        << " regions refined, prove it too (`query --draw-separation` draws them)\n";
  }
  return out.str();
}

Pose pose_of(const WhyOptions& o) {
  if (o.poses.empty()) return {};
  const std::vector<Pose> poses = io::open_poses(o.poses).poses;
  if (o.pose >= poses.size())
    throw InputError(printable_name(o.poses) + ": has " + std::to_string(poses.size()) +
                     " poses, numbered from 0; there is no pose " + std::to_string(o.pose));
  return poses[o.pose];
}

int explain(const WhyOptions& o, const Scene& scene) {
  const auto make_folder = [&] { io::make_folder(std::filesystem::path(o.picture).parent_path().string()); };
  if (o.pair.empty()) {
    const WalkExplanation e = explain_walk(scene.a, scene.pose_a, scene.b, scene.pose_b);
    if (!o.picture.empty() && !e.result.pairs.empty())
      throw InputError(
          "-o: the bodies meet, so that nothing parts them; draw two of their faces with --pair");
    if (!o.picture.empty()) make_folder();
    if (!o.picture.empty()) run::draw_parting(scene.a, scene.pose_a, scene.b, scene.pose_b, e, o.picture);
    print(o.json ? one_line(as_json(e)) : as_text(e));
    return kOk;
  }
  const PairExplanation e = explain_pair(scene.a, scene.pose_a, scene.b, scene.pose_b,
                                         {SimplexId(o.pair[0]), SimplexId(o.pair[1])});
  if (!o.picture.empty()) {
    make_folder();
    run::draw_pair(scene.a, scene.pose_a, scene.b, scene.pose_b, e, o.picture);
  }
  print(o.json ? one_line(as_json(e, scene)) : as_text(e, scene));
  return kOk;
}

int run_why(const WhyOptions& o, const Globals& globals) {
  if (!o.run.empty()) {
    const run::OpenStep open = run::open_step(o.run, o.step);
    return explain(o, {open.bodies[0].rep, open.bodies[1].rep, open.step.pose_a, open.step.pose_b});
  }
  if (o.b.empty()) throw InputError("why: expected two bodies, A and B, or --run with a step of a run");
  const Pose pose = pose_of(o);
  const bodies::LoadedBody a = bodies::load_body(o.a, {}, o.corners),
                           b = bodies::load_body(o.b, {}, o.corners);
  note(globals, a.notes);
  note(globals, b.notes);
  return explain(o, {a.rep, b.rep, {}, pose});
}

Command add_why(CLI::App& root, const Globals& globals) {
  CLI::App* app =
      root.add_subcommand("why", "Tell why two faces are in an answer, or are not, or why bodies are apart");
  const auto o = std::make_shared<WhyOptions>();
  auto* a = app->add_option("A", o->a, "Mesh or .lrb file; does not move");
  app->add_option("B", o->b, "Mesh or .lrb file; the pose is applied to it");
  auto* poses = app->add_option("--poses", o->poses, "File with poses, as for `query` [B stays in place]");
  app->add_option("--pose", o->pose, "Number of the pose in the file, from 0")
      ->needs(poses)
      ->capture_default_str();
  auto* run = app->add_option("--run", o->run, "A run's folder or trace, in the place of A and B")
                  ->excludes(a)
                  ->excludes(poses)
                  ->type_name("DIR");
  app->add_option("--step", o->step, "Number of the run's time step [the last]")->needs(run)->type_name("N");
  app->add_option("--pair", o->pair, "A simplex of A and one of B, as `query --pairs` numbers them")
      ->delimiter(',')
      ->expected(2)
      ->type_name("I,J");
  app->add_option("-o,--output", o->picture,
                  "Draw the two faces with what is about them, or without --pair what parts the bodies")
      ->type_name("FILE.png");
  app->add_flag("--json", o->json, "Print one JSON object");
  add_join_option(*app, o->corners);
  return {app, [o, &globals] { return run_why(*o, globals); }};
}

}  // namespace

std::vector<CommandEntry> why_commands() {
  return {{add_why, 45}};
}

}  // namespace lrb::cli
