#include "scenarios/run/explanation_text.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include <lrbscope/core/strings.hpp>

namespace lrb::run {

std::string_view to_text(DecidedBy by, int dim) {
  switch (by) {
    case DecidedBy::node_boxes:
      return "boxes of tree nodes, which are disjoint";
    case DecidedBy::node_edges:
      return "a direction across edges of two nodes' boxes, along which the boxes are disjoint";
    case DecidedBy::face_boxes:
      return "the boxes of the two faces, which are disjoint";
    case DecidedBy::planes:
      return "the plane of one face, which has the other face on one side (floating point with error bounds)";
    case DecidedBy::floats:
      return "floating point with error bounds";
    case DecidedBy::exact:
      // In 2D no test in floating point precedes it.
      return dim == 2 ? "exact predicates of the two segments"
                      : "exact predicates, because the faster test by the tree could not decide";
  }
  return {};
}

namespace {

using Json = nlohmann::ordered_json;

Json xyz_json(const Eigen::Vector3d& x) {
  return {x.x(), x.y(), x.z()};
}

Json box_gap_json(const BoxPair& p) {
  return {{"a", p.node[0]}, {"b", p.node[1]}, {"gap", p.gap}, {"axis", name_of(p.axis)}};
}

template <class T>
Json ordered_pair(const T& of_a, const T& of_b) {
  return {{"A", of_a}, {"B", of_b}};
}

Json hiding_json(const LrbRep& rep, const std::vector<RegionId>& regions) {
  Json out = Json::array();
  for (const RegionId r : regions)
    out.push_back({{"region", r.value()}, {"layer", rep.layer(r)}, {"lids", rep.lids(r).size()}});
  return out;
}

Json plane_sides_json(const PlaneSides& sides, int corners) {
  Json out = Json::array();
  for (int i = 0; i < corners; ++i)
    out.push_back(
        {{"exact", sides.exact[i]}, {"in_double", sides.in_double[i]}, {"distance", sides.distance[i]}});
  return out;
}

Json contact_points_json(const exact::PairContact& contact) {
  Json corners = Json::array();
  for (int i = 0; i < contact.corner_count; ++i) corners.push_back(xyz_json(contact.corners[i].x));
  return {{"coplanar", contact.coplanar}, {"points", corners}};
}

constexpr int kShownDigits = 6;
/// Distances of more units in the last place are printed without them: double arithmetic decides them
/// reliably.
constexpr double kMaxUlps = 1e6;

std::string point_text(const Eigen::Vector3d& x) {
  const auto text = [](double value) { return io::number_text(value, kShownDigits); };
  return "(" + text(x.x()) + ", " + text(x.y()) + ", " + text(x.z()) + ")";
}

/// Returns the corners of a contact as text; equal texts occur once.
std::vector<std::string> contact_points(const exact::PairContact& contact) {
  std::vector<std::string> out;
  for (int i = 0; i < contact.corner_count; ++i) {
    std::string text = point_text(contact.corners[i].x);
    if (std::find(out.begin(), out.end(), text) == out.end()) out.push_back(std::move(text));
  }
  return out;
}

/// Writes one line for each pair of boxes.
void write_way(std::ostream& out, const PairExplanation& e) {
  constexpr int kNodeColumn = 10, kGapColumn = 14;
  out << "path from the roots; gap: widest separating gap of the two boxes, negative if they overlap\n";
  out << std::setw(kNodeColumn) << "A's node" << std::setw(kNodeColumn) << "B's node" << std::setw(kGapColumn)
      << "gap"
      << "  along\n";
  const auto line = [&](const BoxPair& p, const char* what) {
    out << std::setw(kNodeColumn) << p.node[0] << std::setw(kNodeColumn) << p.node[1] << std::setw(kGapColumn)
        << p.gap << "  " << name_of(p.axis) << what << "\n";
  };
  for (const BoxPair& p : e.nodes) line(p, "");
  if (e.reaches_faces) line(e.face_boxes, ", the boxes of the two faces");
}

void write_regions(std::ostream& out, const LrbRep& rep, const std::vector<RegionId>& regions,
                   const char* whose) {
  out << whose << " face is covered by " << regions.size() << (regions.size() == 1 ? " region" : " regions");
  for (std::size_t i = 0; i < regions.size(); ++i)
    out << (i == 0 ? ", from outside to inside: " : ", ") << regions[i].value() << " (layer "
        << rep.layer(regions[i]) << ")";
  out << "\n";
}

void write_sides(std::ostream& out, const PlaneSides& sides, int corners, const char* whose,
                 const char* other) {
  out << whose << " corners relative to the " << (corners == 3 ? "plane" : "line") << " of " << other
      << " face: ";
  for (int i = 0; i < corners; ++i) {
    const int sign = sides.exact[i];
    out << (i == 0 ? "" : ", ")
        << (sign > 0   ? "in front"
            : sign < 0 ? "behind"
                       : "on it")
        << " (" << sides.distance[i] << ")";
    if (sides.in_double[i] != sign) out << " (double precision gives " << sides.in_double[i] << ")";
  }
  out << "\n";
}

}  // namespace

Json explanation_json(const PairExplanation& e, const LrbRep& a, const LrbRep& b) {
  Json j;
  j["pair"] = {e.pair.a.value(), e.pair.b.value()};
  j["faces"] = {a.face_of_simplex(e.pair.a).value(), b.face_of_simplex(e.pair.b).value()};
  j["meet"] = name_of(e.meet);
  j["decided_by"] = name_of(e.decided_by);
  j["nodes"] = Json::array();
  for (const BoxPair& p : e.nodes) j["nodes"].push_back(box_gap_json(p));
  if (e.reaches_faces) j["face_boxes"] = box_gap_json(e.face_boxes);
  j["hidden_by"] = ordered_pair(hiding_json(a, e.hidden_by[0]), hiding_json(b, e.hidden_by[1]));
  const int corners = a.dim();
  j["corners_by_the_other_plane"] =
      ordered_pair(plane_sides_json(e.sides[0], corners), plane_sides_json(e.sides[1], corners));
  if (e.meet != exact::Meet::disjoint) {
    j["contact"] = contact_points_json(e.contact);
  } else {
    j["distance"] = e.distance;
    j["distance_in_ulps"] = e.distance / e.ulp;
    j["nearest"] = {xyz_json(e.nearest[0]), xyz_json(e.nearest[1])};
  }
  return j;
}

Json explanation_json(const WalkExplanation& e) {
  Json j;
  j["relation"] = name_of(e.result.relation);
  j["pairs"] = e.result.pairs.size();
  j["roots"] = box_gap_json(e.roots);
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
    j["nearest_boxes"] = box_gap_json(e.nearest_boxes->pair);
    j["nearest_boxes"]["of_faces"] = e.nearest_boxes->of_faces;
  }
  if (e.plane) j["plane"] = {{"gap", e.plane->gap()}, {"normal", xyz_json(e.plane->normal)}};
  if (e.result.separation) {
    const auto& [refined, faces] = *e.result.separation;
    j["separation"] = {{"refined", {refined[0].size(), refined[1].size()}}, {"faces", {faces[0], faces[1]}}};
  }
  return j;
}

std::string explanation_text(const PairExplanation& e, const LrbRep& a, const LrbRep& b) {
  std::ostringstream out;
  out << std::setprecision(kShownDigits);
  out << "simplex " << e.pair.a << " of A (face " << a.face_of_simplex(e.pair.a) << " of " << a.name()
      << ") and " << e.pair.b << " of B (face " << b.face_of_simplex(e.pair.b) << " of " << b.name()
      << "): " << name_of(e.meet) << "\n";
  out << "decided by " << to_text(e.decided_by, a.dim()) << "\n\n";
  write_way(out, e);
  out << "\n";
  write_regions(out, a, e.hidden_by[0], "A's");
  write_regions(out, b, e.hidden_by[1], "B's");
  const int corners = a.dim();
  write_sides(out, e.sides[0], corners, "A's", "B's");
  write_sides(out, e.sides[1], corners, "B's", "A's");
  if (e.meet == exact::Meet::disjoint) {
    out << "closest points: " << point_text(e.nearest[0]) << " and " << point_text(e.nearest[1])
        << "\ndistance " << e.distance;
    if (const double ulps = e.distance / e.ulp; ulps < kMaxUlps)
      out << ", " << ulps << " units in the last place of the largest coordinate";
    out << "\n";
  } else {
    constexpr const char* kinds[] = {"nothing", "point", "segment"};
    const std::vector<std::string> points = contact_points(e.contact);
    out << "contact: " << (points.size() < 3 ? kinds[points.size()] : "polygon");
    for (std::size_t i = 0; i < points.size(); ++i) out << (i == 0 ? " " : " to ") << points[i];
    out << "\n";
  }
  return out.str();
}

std::string explanation_text(const WalkExplanation& e) {
  constexpr int kColumn = 12;
  std::ostringstream out;
  out << std::setprecision(kShownDigits);
  out << name_of(e.result.relation) << ", " << e.result.pairs.size() << " pairs\n";
  out << "boxes of the bodies: "
      << (e.roots.gap > 0 ? "gap >= " + io::lower_text(e.roots.gap, kShownDigits)
                          : "overlap by " + io::number_text(-e.roots.gap, kShownDigits))
      << " along " << name_of(e.roots.axis) << "\n\n";
  out << std::setw(kColumn) << "depth" << std::setw(kColumn) << "node pairs" << std::setw(kColumn)
      << "disjoint"
      << "\n";
  for (std::size_t i = 0; i < e.depths.size(); ++i)
    out << std::setw(kColumn) << i << std::setw(kColumn) << e.depths[i].node_pairs << std::setw(kColumn)
        << e.depths[i].ended << "\n";
  out << "\npairs of leaves " << e.leaf_pairs << ", pairs of faces with overlapping boxes " << e.face_pairs
      << "; not separated by planes: " << e.left << ", about " << e.certain
      << " of them decided in floating point\n";
  if (!e.near.empty()) {
    out << "closest of these, for --pair:";
    for (const SimplexPair& p : e.near) out << " " << p.a << "," << p.b;
    out << "\n";
  }
  if (e.result.pairs.empty() && e.left == 0) out << "no two faces need an individual test\n";
  if (const auto& boxes = e.nearest_boxes)
    out << "closest disjoint boxes: " << (boxes->of_faces ? "faces in the leaves " : "nodes ")
        << boxes->pair.node[0] << " of A and " << boxes->pair.node[1] << " of B, gap " << boxes->pair.gap
        << " along " << name_of(boxes->pair.axis) << "\n";
  if (e.plane)
    out << "separating plane with normal (" << e.plane->normal.x() << ", " << e.plane->normal.y() << ", "
        << e.plane->normal.z() << "), gap >= " << io::lower_text(e.plane->gap(), kShownDigits) << "\n";
  if (e.result.separation) {
    const auto& [refined, faces] = *e.result.separation;
    out << "wrappers of " << faces[0] << " and " << faces[1] << " faces, with " << refined[0].size()
        << " and " << refined[1].size()
        << " regions refined, also prove it (draw them with `query --draw-separation`)\n";
  }
  return out.str();
}

}  // namespace lrb::run
