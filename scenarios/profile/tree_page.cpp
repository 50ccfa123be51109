#include "scenarios/profile/tree_page.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "render/pictures/panel.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/style.hpp>
#include <lrbscope/render/svg.hpp>

namespace lrb::profile {
namespace {

using Eigen::Vector3d;
using io::number_text;
using render::counted;
using render::group_digits;
using render::short_number;

std::string percent(double share) {
  return short_number(100 * share) + " %";
}

std::string share_of_epo(const TreeFigures& f, double epo) {
  return f.epo && f.epo->value > 0 ? percent(epo / f.epo->value) : "";
}

/// Returns true if a part of the triangle lies in the volume; for spheres and RSS, a corner or the centre.
bool reaches_into(const Volumes& volumes, std::uint32_t node, std::span<const HalfSpace> half,
                  const std::array<Vector3d, 3>& corners) {
  if (half.empty()) {
    const Vector3d centre = (corners[0] + corners[1] + corners[2]) / 3;
    return volumes.outside(node, centre) == 0 ||
           std::any_of(corners.begin(), corners.end(),
                       [&](const Vector3d& p) { return volumes.outside(node, p) == 0; });
  }
  std::vector<Vector3d> polygon(corners.begin(), corners.end());
  for (const HalfSpace& h : half) {
    clip(polygon, h);
    if (polygon.empty()) return false;
  }
  return area_of(polygon) > 0;
}

void add_numbers(report::Document& doc, const TreeReport& report, std::size_t triangles) {
  const TreeFigures& f = report.figures;
  doc.number({"Faults", group_digits(report.faults.total())})
      .number({"Nodes", group_digits(f.nodes),
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

report::Table node_table(const std::string& title, const std::vector<NodeFigures>& nodes,
                         const capture::Tree& tree, const TreeFigures& f) {
  const bool waste = std::any_of(nodes.begin(), nodes.end(), [](const auto& n) { return n.waste > 0; });
  report::Table t{title, {"node", "depth", "triangles below", "area / root's", "EPO", "share of EPO"}};
  if (waste) t.columns.push_back("wasted visits");
  for (const NodeFigures& n : nodes) {
    t.rows.push_back({std::to_string(tree.id_of(n.node)), std::to_string(n.depth), group_digits(n.triangles),
                      short_number(n.area), short_number(n.epo), share_of_epo(f, n.epo)});
    if (waste) t.rows.back().push_back(short_number(n.waste));
  }
  return t;
}

run::Panel node_panel(const Volumes& volumes, const capture::Mesh& mesh, const TreeIndex& index,
                      const Subtrees& subtrees, const NodeFigures& figures) {
  constexpr double kAround = 1.5;  // extent of the picture, relative to the volume
  const std::uint32_t node = figures.node;
  const std::vector<HalfSpace> half = volumes.half_spaces(node);
  const render::Style& style = render::style_of(render::StyleName::screen);
  render::DrawList list;
  render::DrawTriangle like;
  like.edges = 7;
  like.edge_style = list.edge_style({with_alpha(render::palette::kInk, 110), 0.7F});
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) like.x[k] = mesh.vertices[mesh.triangles[t][k]];
    const bool own = index.leaf[t] != kNull && subtrees.contains(node, index.leaf[t]);
    like.colour = own                                         ? style.body(Side::a)
                  : reaches_into(volumes, node, half, like.x) ? style.body(Side::b)
                                                              : render::palette::kPaleFront;
    list.triangles.push_back(like);
  }
  const trace::ShapeBox box = volumes.box(node);
  const auto corner = [&](unsigned i, double scale) {
    Vector3d p = box.centre;
    for (unsigned k = 0; k < 3; ++k) p += (i >> k & 1 ? scale : -scale) * box.half[k];
    return p;
  };
  std::vector<Vector3d> shown;
  for (unsigned i = 0; i < 8; ++i) {
    shown.push_back(corner(i, kAround));
    for (unsigned k = 0; k < 3; ++k) {
      if (i >> k & 1) continue;
      render::DrawLine line;
      line.points = {corner(i, 1), corner(i | 1U << k, 1)};
      line.colour = render::palette::kVermillion;
      line.width = 2;
      line.layer = render::Layer::on_top;
      list.lines.push_back(line);
    }
  }
  return {list, run::fit_points(shown, 3),
          "node " + std::to_string(volumes.tree().id_of(node)) + ", depth " + std::to_string(figures.depth) +
              ": " + counted(figures.triangles, "triangle", "triangles"),
          false};
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

std::string icicle_svg(const capture::Tree& tree, const TreeIndex& index, const TreeFigures& figures) {
  using namespace render::svg_text;
  constexpr double kWidth = 1200, kMargin = 8, kRow = 18, kText = 11, kRule = 0.7, kRuleShare = 0.2;
  constexpr double kRoomForText = 40, kNarrowest = 1;  // pixels
  constexpr std::uint32_t kMaxDepths = 40;
  double largest = 0;
  if (figures.epo)
    for (const double epo : figures.epo->by_node) largest = std::max(largest, epo);
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
    const render::Rgba colour = render::palette::viridis(value);
    const std::string name = std::to_string(tree.id_of(n));
    boxes += "<rect" + attribute("x", number(x)) + attribute("y", number(y)) +
             attribute("width", number(width - rule)) + attribute("height", number(kRow - rule)) +
             paint("fill", colour) + "><title>node " + name + ", depth " + std::to_string(index.depth[n]) +
             ": " + counted(index.triangles_below[n], "triangle", "triangles") +
             (figures.epo ? ", EPO " + short_number(epo) + " " + share_of_epo(figures, epo) : std::string()) +
             "</title></rect>\n";
    if (width > kRoomForText)
      boxes += "<text" + attribute("x", number(x + width / 2)) + attribute("y", number(y + kRow / 2)) +
               font(kText) + attribute("text-anchor", "middle") + attribute("dominant-baseline", "central") +
               paint("fill", value > 0.5 ? render::palette::kInk : render::kWhite) + ">" + name + "</text>\n";
  }
  const double height = 2 * kMargin + kRow * depths;
  return svg_open(kWidth, height) + "<title>The nodes of the tree by depth</title>\n<rect" +
         attribute("width", number(kWidth)) + attribute("height", number(height)) +
         paint("fill", render::kWhite) + "/>\n" + boxes + "</svg>\n";
}

render::Image node_sheet(const capture::Tree& tree, const capture::Mesh& mesh, const TreeIndex& index,
                         std::span<const NodeFigures> nodes) {
  const Volumes volumes(tree);
  const Subtrees subtrees(tree, index, mesh.triangles.size());
  std::vector<run::Panel> panels;
  for (const NodeFigures& n : nodes) panels.push_back(node_panel(volumes, mesh, index, subtrees, n));
  render::Look look;
  constexpr int kWidth = 480, kHeight = 400;  // of a panel
  look.width = kWidth;
  look.height = kHeight;
  render::MontageOptions side_by_side;
  side_by_side.columns = static_cast<int>(panels.size());
  return run::draw_sheet(panels, look, side_by_side);
}

void write_tree_page(const report::Folder& folder, const capture::Tree& tree, const capture::Mesh& mesh,
                     const TreeReport& report, const std::string& engine, const std::string& command) {
  constexpr std::size_t kPictures = 3;
  const TreeFigures& f = report.figures;
  const TreeIndex index(tree, mesh.triangles.size());
  const std::string mesh_name = mesh.name.empty() ? "mesh " + std::to_string(tree.mesh + 1) : mesh.name;
  report::Document doc("Tree of " + mesh_name,
                       "Tree " + std::to_string(tree.id) + " of " + engine +
                           "; bounding volumes: " + std::string(volume_name(tree.volume)) + ".");
  const std::uint64_t faults = report.faults.total();
  doc.verdict(faults == 0 ? "no faults" : counted(faults, "fault", "faults"), faults == 0).command(command);
  add_numbers(doc, report, mesh.triangles.size());
  if (faults > 0) {
    report::Table table{"Faults", {"kind", "number", "found"}};
    for (const FoundFault& fault : report.faults.first)
      table.rows.push_back({io::in_words(name_of(fault.kind)),
                            group_digits(report.faults.totals[static_cast<std::size_t>(fault.kind)]),
                            text_of(fault, tree, mesh)});
    table.note = "The first " + std::to_string(TreeFaults::kShown) + " of each kind.";
    doc.table(table);
  }
  add_charts(doc, f);
  doc.picture(
      "nodes.svg", icicle_svg(tree, index, f), "All nodes",
      "By depth, the root on top. Width: triangles below the node. Colour: its EPO, from dark blue (none) to yellow (the largest).",
      true);
  if (!f.worst.empty()) {
    report::Table table = node_table("Worst nodes by EPO", f.worst, tree, f);
    table.note =
        "EPO (end-point overlap): the surface in the node's volume that does not belong to its subtree, relative to the whole "
        "surface, times the node's cost: 1.2 for an inner node, the number of triangles for a leaf.";
    doc.table(table);
  }
  if (!f.most_waste.empty()) doc.table(node_table("Worst nodes by waste", f.most_waste, tree, f));
  if (!f.worst.empty())
    doc.picture(
        "worst.png",
        node_sheet(tree, mesh, index, std::span(f.worst).first(std::min(kPictures, f.worst.size()))),
        "Worst nodes in the body",
        "Blue: the node's triangles. Orange: triangles of other nodes that reach into its volume. Red lines: the " +
            std::string(tree.volume == capture::VolumeKind::aabb || tree.volume == capture::VolumeKind::obb
                            ? "volume."
                            : "box around the volume."));
  doc.write(folder);
}

}  // namespace lrb::profile
