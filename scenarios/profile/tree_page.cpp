#include "scenarios/profile/tree_page.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "scenarios/run/scene_json.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/render/style.hpp>
#include <lrbscope/render/svg.hpp>

namespace lrb::profile {
namespace {

using Eigen::Vector3d;
using io::number_text;
using render::counted;
using render::group_digits;
using render::percent;
using render::short_number;

std::string share_of_epo(const TreeFigures& f, double epo) {
  return f.epo && f.epo->value > 0 ? percent(epo / f.epo->value) : "";
}

void add_numbers(report::Document& doc, const TreeReport& report, std::size_t triangles) {
  const TreeFigures& f = report.figures;
  doc.number({"Nodes", group_digits(f.nodes),
              counted(f.leaves, "leaf", "leaves") + ", " + counted(triangles, "triangle", "triangles")})
      .number({"Depth", std::to_string(f.depth), "mean of leaves: " + short_number(f.mean_depth)});
  if (const auto sah = f.sah())
    doc.number({"SAH", short_number(*sah),
                "inner nodes " + short_number(*f.sah_inner) + ", leaves " + short_number(*f.sah_leaves)});
  if (f.epo)
    doc.number({"EPO", short_number(f.epo->value),
                f.epo->samples == 0 ? "exact"
                                    : "± " + number_text(f.epo->error, 1) + ", from " +
                                          group_digits(f.epo->samples) + " points"});
  if (f.siblings.pairs > 0)
    doc.number({"Siblings that overlap",
                percent(static_cast<double>(f.siblings.overlapping) / static_cast<double>(f.siblings.pairs)),
                f.siblings.shared ? "mean share of the smaller volume: " + percent(*f.siblings.shared) : ""});
  if (f.looseness)
    doc.number({"Volume / tightest box", short_number(f.looseness->median),
                "median; 90th percentile " + short_number(f.looseness->p90)});
}

void add_charts(report::Document& doc, const TreeFigures& f) {
  report::Series nodes{"nodes", {}, {}}, leaves{"leaves", {}, {}}, area{"area", {}, {}}, epo{"EPO", {}, {}},
      sizes{"leaves", {}, {}};
  for (std::size_t d = 0; d < f.by_depth.size(); ++d) {
    const DepthFigures& at = f.by_depth[d];
    for (report::Series* s : {&nodes, &leaves, &area, &epo}) s->x.push_back(static_cast<double>(d));
    nodes.y.push_back(static_cast<double>(at.nodes));
    leaves.y.push_back(static_cast<double>(at.leaves));
    area.y.push_back(at.area);
    epo.y.push_back(at.epo);
  }
  for (const auto& [size, count] : f.leaf_sizes) {
    sizes.x.push_back(static_cast<double>(size));
    sizes.y.push_back(static_cast<double>(count));
  }
  doc.chart({"Nodes by depth", {"depth"}, {"nodes"}, {nodes, leaves}});
  if (f.sah_inner)
    doc.chart(
        {"Surface and EPO by depth",
         {"depth"},
         {"sum over nodes"},
         {area, epo},
         "Area: relative to the root's; its sum over a depth is the expected number of nodes that a random line "
         "through the root visits."});
  if (f.leaf_sizes.size() > 1) doc.chart({"Leaf sizes", {"triangles in a leaf"}, {"leaves"}, {sizes}});
}

/// Returns a link of a table's row to a node of the view.
std::string target_of(const capture::Tree& tree, std::uint32_t node) {
  return node == kNull ? std::string() : "node " + tree.name_of_node(node);
}

report::Table node_table(const std::string& title, const std::vector<NodeFigures>& nodes,
                         const capture::Tree& tree, const TreeFigures& f) {
  report::Table t{title, {"node", "depth", "triangles below", "area / root's", "EPO", "share of EPO"}};
  for (const NodeFigures& n : nodes) {
    t.rows.push_back({tree.name_of_node(n.node), std::to_string(n.depth), group_digits(n.triangles),
                      short_number(n.area), short_number(n.epo), share_of_epo(f, n.epo)});
    t.targets.push_back(target_of(tree, n.node));
  }
  return t;
}

/// Returns the body and its tree for the page's view (report/web/tree.js), with coordinates relative to the
/// body's centre and in units of its size. Faces are in the order of the tree's leaves, so that the faces
/// below a node are consecutive.
std::string view_json(const capture::Tree& tree, const capture::Mesh& mesh, const TreeIndex& index,
                      const TreeFigures& figures, const render::ViewDirection& view) {
  using Numbers = std::vector<std::uint32_t>;
  using report::packed;
  const Subtrees subtrees(tree, index, mesh.triangles.size());
  const Volumes volumes(tree);
  Eigen::AlignedBox3d around;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) around.extend(mesh.vertices[v]);
  run::SceneFrame frame{around.center(), std::max(around.diagonal().norm() / 2, 1e-300)};

  // Faces in no leaf come last. A body in the plane has segments, whose second corner is repeated.
  Numbers faces = subtrees.triangles;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    if (index.leaf[t] == kNull) faces.push_back(t);
  const bool flat =
      std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [](const auto& t) { return t[1] == t[2]; });
  const std::uint32_t corners_of_face = flat ? 2 : 3;
  Numbers corners;
  for (const std::uint32_t face : faces)
    corners.insert(corners.end(), mesh.triangles[face].begin(),
                   mesh.triangles[face].begin() + corners_of_face);
  std::vector<float> vertices;
  for (const Vector3d& v : mesh.vertices) frame.add_point(vertices, v);

  // The nodes nearest to the root, breadth first, and the worst ones.
  constexpr std::size_t kMaxNodes = 60'000;
  constexpr double kThinnest = 1e-7;  // half the thickness of a flat box, relative to the unit
  Numbers nodes(index.from_root.begin(), index.from_root.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                       kMaxNodes, index.from_root.size())));
  Numbers place(tree.size(), kNull);
  for (std::uint32_t i = 0; i < nodes.size(); ++i) place[nodes[i]] = i;
  for (const NodeFigures& n : figures.worst)
    if (place[n.node] == kNull) {
      place[n.node] = static_cast<std::uint32_t>(nodes.size());
      nodes.push_back(n.node);
    }
  Numbers parents, depths, first, last;
  std::vector<float> boxes, areas, epos;
  const double root_area = figures.area[index.from_root.front()];
  nlohmann::json ids = nlohmann::json::array();
  for (const std::uint32_t n : nodes) {
    ids.push_back(tree.instances.empty() ? nlohmann::json(tree.id_of(n))
                                         : nlohmann::json(tree.name_of_node(n)));
    parents.push_back(index.parent[n] == kNull ? kNull : place[index.parent[n]]);
    depths.push_back(index.depth[n]);
    first.push_back(subtrees.first_triangle[n]);
    last.push_back(subtrees.last_triangle[n]);
    areas.push_back(root_area > 0 ? static_cast<float>(figures.area[n] / root_area) : 0);
    epos.push_back(figures.epo ? static_cast<float>(figures.epo->by_node[n]) : 0);
    const trace::ShapeBox box = volumes.box(n);
    frame.add_point(boxes, box.centre);
    for (const Vector3d& half : box.half)
      frame.add_vector(boxes, half.norm() > kThinnest * frame.unit
                                  ? half
                                  : half.stableNormalized() * (kThinnest * frame.unit));
  }
  const Numbers none, no_region(faces.size(), kNull), sizes(faces.size(), corners_of_face);
  const nlohmann::json out = {{"dim", flat ? 2 : 3},
                              {"origin", {frame.origin.x(), frame.origin.y(), frame.origin.z()}},
                              {"unit", frame.unit},
                              {"view", run::view_json(view, false)},
                              {"colours", run::scene_colours()},
                              {"volume", volume_name(tree.volume)},
                              {"epo", figures.epo ? figures.epo->value : 0},
                              {"body",
                               {{"name", mesh.name},
                                {"faces", faces.size()},
                                {"realFaces", faces.size()},
                                {"regions", 0},
                                {"geometry",
                                 {{"vertices", packed(vertices)},
                                  {"sizes", packed(sizes)},
                                  {"corners", packed(corners)},
                                  {"inner", packed(no_region)},
                                  {"outer", packed(no_region)},
                                  {"parent", packed(none)},
                                  {"layer", packed(none)}}},
                                {"boxes",
                                 {{"node", packed(none)},
                                  {"depth", packed(none)},
                                  {"places", packed(boxes)},
                                  {"whole", 0},
                                  {"atDepth", packed(none)}}},
                                {"counts", {{"tests", packed(none)}, {"hits", packed(none)}}}}},
                              {"faces", packed(faces)},
                              {"nodes",
                               {{"id", std::move(ids)},
                                {"parent", packed(parents)},
                                {"depth", packed(depths)},
                                {"first", packed(first)},
                                {"last", packed(last)},
                                {"area", packed(areas)},
                                {"epo", packed(epos)},
                                {"all", nodes.size() == index.from_root.size()}}}};
  return out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

std::string_view volume_name(capture::VolumeKind kind) {
  switch (kind) {
    case capture::VolumeKind::aabb:
      return "AABB";
    case capture::VolumeKind::sphere:
      return "sphere";
    case capture::VolumeKind::obb:
      return "OBB";
    case capture::VolumeKind::rss:
      return "RSS";
    case capture::VolumeKind::kdop:
      return "k-DOP";
  }
  return "?";
}

/// `largest`: of the nodes' EPO.
std::string icicle_svg(const capture::Tree& tree, const TreeIndex& index, const TreeFigures& figures,
                       double largest) {
  using namespace render::svg_text;
  constexpr double kWidth = 1200, kMargin = 8, kRow = 18, kText = 11, kRule = 0.7, kRuleShare = 0.2;
  constexpr double kRoomForText = 40, kNarrowest = 1;  // pixels
  constexpr double kDark = 0.588;  // share of the colour scale from which white is better legible than black
  constexpr std::uint32_t kMaxDepths = 40;
  // Parents come before children: each node stores its left end and the left end of its next child.
  std::vector<double> left(tree.size(), kMargin);
  const double unit = (kWidth - 2 * kMargin) / std::max(1U, index.triangles_below[0]);
  std::uint32_t depths = 0;
  std::string boxes;
  for (const std::uint32_t n : index.from_root) {
    const double x = left[n], width = unit * index.triangles_below[n];
    double next = x;
    for (const std::uint32_t child : tree.children(n)) {
      if (index.parent[child] != n) continue;
      left[child] = next;
      next += unit * index.triangles_below[child];
    }
    if (width < kNarrowest || index.depth[n] >= kMaxDepths) continue;
    depths = std::max(depths, index.depth[n] + 1);
    const double y = kMargin + kRow * index.depth[n], rule = std::min(kRule, kRuleShare * width);
    // The square root spreads the small values.
    const double epo = figures.epo ? figures.epo->by_node[n] : 0;
    const double value = largest > 0 ? std::sqrt(epo / largest) : 0;
    const render::Rgba colour = render::palette::heat(value);
    const std::string name = tree.name_of_node(n);
    boxes += "<rect" + attribute("data-node", name) + attribute("x", number(x)) + attribute("y", number(y)) +
             attribute("width", number(width - rule)) + attribute("height", number(kRow - rule)) +
             paint("fill", colour) + "><title>node " + name + ", depth " + std::to_string(index.depth[n]) +
             ": " + counted(index.triangles_below[n], "triangle", "triangles") +
             (figures.epo ? ", EPO " + short_number(epo) + " " + share_of_epo(figures, epo) : std::string()) +
             "</title></rect>\n";
    if (width > kRoomForText)
      boxes += "<text" + attribute("x", number(x + width / 2)) + attribute("y", number(y + kRow / 2)) +
               font(kText) + attribute("text-anchor", "middle") + attribute("dominant-baseline", "central") +
               paint("fill", value >= kDark ? render::kWhite : render::kBlack) + ">" + name + "</text>\n";
  }
  const double height = 2 * kMargin + kRow * depths;
  return svg_open(kWidth, height) + "<title>The nodes of the tree by depth</title>\n<rect" +
         attribute("width", number(kWidth)) + attribute("height", number(height)) +
         paint("fill", render::kWhite) + "/>\n" + boxes + "</svg>\n";
}

void write_tree_page(const report::Folder& folder, const capture::Tree& tree, const capture::Mesh& mesh,
                     const TreeReport& report, const std::string& engine, const std::string& command,
                     const report::Table& trees, const render::ViewDirection& view) {
  constexpr std::size_t kMaxFaces = 500'000;  // of a view
  const TreeFigures& f = report.figures;
  const TreeIndex index(tree, mesh.triangles.size());
  const std::string mesh_name = mesh.name.empty() ? "mesh " + std::to_string(tree.mesh + 1) : mesh.name;
  report::Document doc("Tree of " + mesh_name,
                       "Tree " + std::to_string(tree.id) + " of " + engine +
                           "; bounding volumes: " + std::string(volume_name(tree.volume)) + ".");
  const std::uint64_t faults = report.faults.total();
  doc.verdict(faults == 0 ? "no faults" : counted(faults, "fault", "faults"), faults == 0).command(command);
  add_numbers(doc, report, mesh.triangles.size());
  if (mesh.triangles.size() <= kMaxFaces)
    doc.tree_view(view_json(tree, mesh, index, f, view));
  else
    doc.purpose("No view: it is limited to " + group_digits(kMaxFaces) + " triangles.");
  const double largest = f.epo ? std::ranges::max(f.epo->by_node) : 0;
  doc.picture(
      "nodes.svg", icicle_svg(tree, index, f, largest), "All nodes",
      "By depth, the root on top. Width: triangles below the node. Colour: its EPO, from pale (0) to dark (" +
          render::short_number(largest) + ", the largest).",
      true);
  doc.key_figures();
  if (faults > 0) {
    report::Table table{"Faults", {"kind", "number", "found"}};
    for (const FoundFault& fault : report.faults.first) {
      table.rows.push_back({io::in_words(name_of(fault.kind)),
                            group_digits(report.faults.totals[static_cast<std::size_t>(fault.kind)]),
                            text_of(fault, tree, mesh)});
      table.targets.push_back(target_of(tree, fault.node));
    }
    if (faults > table.rows.size())
      table.note = "The first " + std::to_string(TreeFaults::kShown) + " of each kind.";
    doc.table(table);
  }
  if (!trees.rows.empty()) doc.table(trees);
  if (!f.worst.empty()) {
    report::Table table = node_table("Worst nodes by EPO", f.worst, tree, f);
    table.note =
        "EPO (end-point overlap): the surface in the node's volume that does not belong to its subtree, relative to the whole "
        "surface, times the node's cost: 1.2 for an inner node, the number of triangles for a leaf.";
    doc.table(table);
  }
  add_charts(doc, f);
  doc.write(folder);
}

}  // namespace lrb::profile
