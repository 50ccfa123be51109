#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/compare/side_by_side.hpp"
#include "scenarios/profile/captured_run.hpp"
#include "scenarios/profile/tree_page.hpp"
#include "scenarios/profile/tree_report.hpp"
#include "scenarios/report/document.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/capture.hpp>

namespace lrb::tools {
namespace {

using io::number_text;
using Json = nlohmann::ordered_json;

struct TreeCommandOptions {
  bodies::Corners corners = bodies::Corners::joined;
  std::string file, folder, up;
  std::optional<std::uint32_t> tree;
  profile::TreeOptions report;
  bool json = false;
};

/// The trees of a file.
struct Trees {
  std::string kind, engine;
  std::vector<capture::Mesh> meshes;
  std::vector<capture::Tree> trees;
};

bool is_capture_file(const std::string& path) {
  constexpr std::size_t kHead = 16;
  std::array<char, kHead> head{};
  std::ifstream in(path, std::ios::binary);
  in.read(head.data(), kHead);
  return capture::is_capture(std::as_bytes(std::span(head.data(), static_cast<std::size_t>(in.gcount()))));
}

Trees read_trees(const TreeCommandOptions& o, std::vector<std::string>& notes) {
  const std::string name = printable_name(o.file);
  Trees out;
  if (o.file.ends_with(".lrbcap") || is_capture_file(o.file)) {
    capture::Capture c = capture::read_capture(o.file, kNull, kNull);  // no queries
    if (c.cut_off)
      notes.push_back(name + ": the capture ends within a chunk or without its end; the rest was read");
    out = {"capture", c.engine.empty() ? "another engine" : c.engine, std::move(c.meshes),
           std::move(c.trees)};
    if (out.trees.empty())
      throw InputError(name + ": expected trees, found none; report them with LRBCAP_TREE");
  } else {
    out.kind = bodies::is_lrb_file(o.file) ? "LRB-rep" : "mesh";
    out.engine = "lrbscope";
    const bodies::LoadedBody body = bodies::load_faces(o.file, o.corners);
    notes.insert(notes.end(), body.notes.begin(), body.notes.end());
    profile::OwnTree own = profile::own_tree(body.rep, trace::TreeShape(body.rep.tree()));
    out.meshes.push_back(std::move(own.mesh));
    out.trees.push_back(std::move(own.tree));
  }
  if (!o.tree) return out;
  std::string known;
  for (const capture::Tree& t : out.trees) known += (known.empty() ? "" : ", ") + std::to_string(t.id);
  std::erase_if(out.trees, [&](const capture::Tree& t) { return t.id != *o.tree; });
  if (out.trees.empty())
    throw InputError("--tree: expected a tree of " + name + " (" + known + "), found " +
                     std::to_string(*o.tree));
  return out;
}

std::string mesh_name(const Trees& all, const capture::Tree& tree) {
  const std::string& name = all.meshes[tree.mesh].name;
  return name.empty() ? "mesh " + std::to_string(tree.mesh + 1) : printable_name(name);
}

// Text.

/// Returns a number with its noun, in plain digits: the text may be searched.
std::string counted(std::uint64_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

std::string percent(double share) {
  return number_text(100 * share, 3) + " %";
}

std::string faults_text(const profile::TreeFaults& faults, const capture::Tree& tree,
                        const capture::Mesh& mesh) {
  constexpr std::size_t kShown = 5;  // maximum number listed for each kind
  if (faults.total() == 0) return "  faults: none\n";
  std::string out = "  faults: " + std::to_string(faults.total()) + "\n";
  for (std::size_t kind = 0; kind < profile::kTreeFaults; ++kind) {
    const std::uint64_t total = faults.totals[kind];
    std::size_t shown = 0;
    for (const profile::FoundFault& f : faults.first) {
      if (static_cast<std::size_t>(f.kind) != kind || shown == kShown) continue;
      ++shown;
      out += "    " + text_of(f, tree, mesh) + "\n";
    }
    if (total > shown)
      out += "    " + io::in_words(name_of(static_cast<profile::TreeFault>(kind))) + ": " +
             std::to_string(total - shown) + " more" +
             (total > profile::TreeFaults::kShown ? "" : "; --json lists all") + "\n";
  }
  return out;
}

std::string worst_text(const std::vector<profile::NodeFigures>& worst, const capture::Tree& tree,
                       double epo) {
  constexpr std::size_t kShown = 3;
  std::string out;
  for (std::size_t i = 0; i < std::min(kShown, worst.size()); ++i)
    out += (i == 0 ? "" : "; ") + std::string("node ") + tree.name_of_node(worst[i].node) + ", depth " +
           std::to_string(worst[i].depth) + ", " + counted(worst[i].triangles, "triangle", "triangles") +
           ": " + percent(worst[i].epo / epo);
  return out;
}

std::string text_of_tree(const Trees& all, const capture::Tree& tree, const profile::TreeReport& report) {
  const profile::TreeFigures& f = report.figures;
  const capture::Mesh& mesh = all.meshes[tree.mesh];
  const auto number = [](double x) { return number_text(x, 4); };
  std::string out = "tree " + std::to_string(tree.id) + " of " + mesh_name(all, tree) + " (" +
                    counted(mesh.triangles.size(), "triangle", "triangles") + "), " + all.engine + ": " +
                    std::string(profile::volume_name(tree.volume)) + "\n";
  const auto line = [&](const std::string& words) { out += "  " + words + "\n"; };
  line("nodes: " + std::to_string(f.nodes) + ", of which leaves " + std::to_string(f.leaves) +
       (f.unreached > 0 ? ", not below the root " + std::to_string(f.unreached) : "") + "; depth " +
       std::to_string(f.depth) + ", of leaves on average " + number(f.mean_depth));
  std::string sizes;
  constexpr std::size_t kMaxSizes = 16;
  std::size_t i = 0;
  for (const auto& [size, count] : f.leaf_sizes)
    if (i++ < kMaxSizes)
      sizes += (i == 1 ? "" : ", ") + std::to_string(count) + " with " + std::to_string(size);
  if (f.leaf_sizes.size() > kMaxSizes) sizes += " ... up to " + std::to_string(f.leaf_sizes.rbegin()->first);
  line("triangles in leaves: " + sizes);
  if (const auto sah = f.sah())
    line("SAH: " + number(*sah) + " (1.2 x " + number(*f.sah_inner) + " for inner nodes + " +
         number(*f.sah_leaves) + " for triangles)");
  if (f.epo)
    line("EPO: " + number(f.epo->value) +
         (f.epo->samples == 0 ? " (exact)"
                              : " +- " + number_text(f.epo->error, 1) + " (" +
                                    std::to_string(f.epo->samples) + " points of the surface)"));
  if (f.siblings.pairs > 0)
    line("siblings: " +
         percent(static_cast<double>(f.siblings.overlapping) / static_cast<double>(f.siblings.pairs)) +
         " of " + counted(f.siblings.pairs, "pair", "pairs") + " overlap" +
         (f.siblings.shared ? ", on average by " + percent(*f.siblings.shared) + " of the smaller volume"
                            : "") +
         (f.siblings.nodes_left_out > 0
              ? "; " + counted(f.siblings.nodes_left_out, "node", "nodes") + " with more than " +
                    std::to_string(profile::SiblingFigures::kMaxChildren) + " children left out"
              : ""));
  if (f.looseness)
    line("volume / tightest box of its triangles: median " + number(f.looseness->median) +
         ", 90th percentile " + number(f.looseness->p90) + ", largest " + number(f.looseness->largest) +
         " (node " + tree.name_of_node(f.looseness->node) + ")");
  line("volumes: " + std::to_string(f.volume_bytes) + " bytes as captured, in doubles" +
       (mesh.triangles.empty()
            ? ""
            : ", " +
                  number_text(
                      static_cast<double>(f.volume_bytes) / static_cast<double>(mesh.triangles.size()), 4) +
                  " per triangle"));
  if (f.beyond.of > 0)
    line("children beyond their parent's volume (not a fault): " + std::to_string(f.beyond.count) + " of " +
         std::to_string(f.beyond.of) +
         (f.beyond.node != kNull ? ", the farthest node " + tree.name_of_node(f.beyond.node) + ", by " +
                                       percent(f.beyond.share) + " of the diagonal"
                                 : ""));
  if (!f.worst.empty()) line("worst by EPO: " + worst_text(f.worst, tree, f.epo->value));
  return out + faults_text(report.faults, tree, mesh);
}

// JSON. Nodes have the engine's numbers.

Json node_json(const capture::Tree& tree, std::uint32_t node) {
  return tree.instances.empty() ? Json(tree.id_of(node)) : Json(tree.name_of_node(node));
}

Json fault_json(const profile::FoundFault& f, const capture::Tree& tree, const capture::Mesh& mesh) {
  Json j{{"kind", name_of(f.kind)}};
  if (f.node != kNull) j["node"] = node_json(tree, f.node);
  if (!f.nodes.empty()) {
    const char* key = f.kind == profile::TreeFault::two_parents              ? "parents"
                      : f.kind == profile::TreeFault::triangle_in_two_leaves ? "leaves"
                                                                             : "nodes";
    for (const std::uint32_t n : f.nodes) j[key].push_back(node_json(tree, n));
  }
  if (f.triangle != kNull) j["triangle"] = f.triangle;
  if (f.kind == profile::TreeFault::no_parent) j["nodes_below"] = f.count;
  if (f.kind == profile::TreeFault::inner_node_with_triangles) j["triangles"] = f.count;
  if (f.kind == profile::TreeFault::corner_outside) {
    j["corner"] = f.corner;
    j["point"] = {f.point.x(), f.point.y(), f.point.z()};
    j["depth"] = f.depth;
    j["by"] = f.by;
    j["by_share_of_diagonal"] = f.by_share;
    j["corners_outside"] = f.count;
  }
  if (f.kind == profile::TreeFault::part_outside) {
    j["point"] = {f.point.x(), f.point.y(), f.point.z()};
    j["area"] = f.by;
    j["share_of_triangle"] = f.by_share;
  }
  j["text"] = text_of(f, tree, mesh);
  return j;
}

Json nodes_json(const std::vector<profile::NodeFigures>& nodes, const capture::Tree& tree) {
  Json out = Json::array();
  for (const profile::NodeFigures& n : nodes)
    out.push_back({{"node", node_json(tree, n.node)},
                   {"depth", n.depth},
                   {"triangles", n.triangles},
                   {"area", n.area},
                   {"epo", n.epo}});
  return out;
}

Json tree_json(const Trees& all, const capture::Tree& tree, const profile::TreeReport& report) {
  const profile::TreeFigures& f = report.figures;
  const capture::Mesh& mesh = all.meshes[tree.mesh];
  Json j{{"tree", tree.id},
         {"mesh", mesh.name},
         {"triangles", mesh.triangles.size()},
         {"volume", profile::volume_name(tree.volume)},
         {"nodes", f.nodes},
         {"leaves", f.leaves},
         {"unreached", f.unreached},
         {"depth", f.depth},
         {"mean_leaf_depth", f.mean_depth}};
  j["leaf_sizes"] = Json::array();
  for (const auto& [size, count] : f.leaf_sizes)
    j["leaf_sizes"].push_back({{"triangles", size}, {"leaves", count}});
  j["sah"] = nullptr;
  if (const auto sah = f.sah())
    j["sah"] = {{"cost", *sah},
                {"inner", *f.sah_inner},
                {"leaves", *f.sah_leaves},
                {"inner_cost", profile::kInnerCost},
                {"triangle_cost", profile::kTriangleCost}};
  j["epo"] = nullptr;
  if (f.epo)
    j["epo"] = {{"value", f.epo->value},
                {"standard_error", f.epo->error},
                {"points", f.epo->samples},
                {"exact", f.epo->samples == 0}};
  j["siblings"] = {{"pairs", f.siblings.pairs},
                   {"overlapping", f.siblings.overlapping},
                   {"shared_volume", f.siblings.shared ? Json(*f.siblings.shared) : Json(nullptr)},
                   {"nodes_left_out", f.siblings.nodes_left_out}};
  j["volume_over_tightest_box"] = nullptr;
  if (f.looseness)
    j["volume_over_tightest_box"] = {{"median", f.looseness->median},
                                     {"p90", f.looseness->p90},
                                     {"largest", f.looseness->largest},
                                     {"node", node_json(tree, f.looseness->node)}};
  j["volume_bytes"] = f.volume_bytes;
  j["beyond_parent"] = {{"nodes", f.beyond.count},
                        {"of", f.beyond.of},
                        {"largest_share_of_diagonal", f.beyond.share},
                        {"node", f.beyond.node == kNull ? Json(nullptr) : node_json(tree, f.beyond.node)}};
  j["worst_by_epo"] = nodes_json(f.worst, tree);
  Json by_kind = Json::object(), list = Json::array();
  for (std::size_t kind = 0; kind < profile::kTreeFaults; ++kind)
    by_kind[std::string(name_of(static_cast<profile::TreeFault>(kind)))] = report.faults.totals[kind];
  for (const profile::FoundFault& fault : report.faults.first) list.push_back(fault_json(fault, tree, mesh));
  j["faults"] = {{"total", report.faults.total()}, {"by_kind", by_kind}, {"list", list}};
  return j;
}

// Pages.

/// Writes a page for each tree: of the one with most faults to the folder itself, of others to tree_N in it.
void write_pages(const Trees& all, const std::vector<profile::TreeReport>& reports,
                 const TreeCommandOptions& o, const Globals& globals) {
  const std::string& folder = o.folder;
  compare::reject_folder_of_run(folder);
  const std::size_t count = all.trees.size();
  std::size_t first = 0;
  for (std::size_t i = 1; i < count; ++i)
    if (reports[i].faults.total() > reports[first].faults.total()) first = i;
  const auto below = [&](std::size_t i) {
    return i == first ? std::string() : "/tree_" + std::to_string(all.trees[i].id);
  };
  report::Table trees{"Trees", {"tree", "mesh", "volume", "nodes", "depth", "SAH", "EPO", "faults"}};
  for (std::size_t i = 0; i < count && count > 1; ++i) {
    const capture::Tree& tree = all.trees[i];
    const profile::TreeFigures& f = reports[i].figures;
    const auto sah = f.sah();
    trees.rows.push_back(
        {std::to_string(tree.id), mesh_name(all, tree), std::string(profile::volume_name(tree.volume)),
         render::group_digits(f.nodes), std::to_string(f.depth), sah ? render::short_number(*sah) : "",
         f.epo ? render::short_number(f.epo->value) : "", render::group_digits(reports[i].faults.total())});
  }
  for (std::size_t page = 0; page < count; ++page) {
    // The row of this page is marked; the others lead to theirs.
    report::Table table = trees;
    for (std::size_t i = 0; i < table.rows.size(); ++i)
      table.targets.push_back((page == first ? "." : "..") + below(i) + "/index.html");
    if (!table.rows.empty()) {
      table.rows[page][0] += ", above";
      table.targets[page].clear();
    }
    const capture::Tree& tree = all.trees[page];
    std::string up = o.up;
    if (!up.empty()) resolve_up(up, profile::captured_body(all.meshes[tree.mesh]).rep, globals);
    profile::write_tree_page(folder + below(page), tree, all.meshes[tree.mesh], reports[page], all.engine,
                             globals.command_line, table, view_with(up));
  }
}

int run_tree(const TreeCommandOptions& o, const Globals& globals) {
  constexpr std::size_t kMaxPages = 24;
  std::vector<std::string> notes;
  const Trees all = read_trees(o, notes);
  if (!o.folder.empty() && all.trees.size() > kMaxPages)
    throw InputError("-o: expected " + std::to_string(kMaxPages) + " trees at most, found " +
                     std::to_string(all.trees.size()) + "; choose one with --tree");
  note(globals, notes);
  std::vector<profile::TreeReport> reports;
  std::uint64_t faults = 0;
  Json j{
      {"file", o.file}, {"kind", all.kind}, {"engine", all.engine}, {"faults", 0}, {"trees", Json::array()}};
  std::string text;
  for (const capture::Tree& tree : all.trees) {
    profile::TreeReport report = profile::report_tree(tree, all.meshes[tree.mesh], o.report);
    faults += report.faults.total();
    if (o.json)
      j["trees"].push_back(tree_json(all, tree, report));
    else
      text += text_of_tree(all, tree, report);
    if (!o.folder.empty()) reports.push_back(std::move(report));
  }
  j["faults"] = faults;
  if (!o.folder.empty()) {
    write_pages(all, reports, o, globals);
    j["page"] = o.folder + "/index.html";
    text += o.folder + "/index.html\n";
  }
  print(o.json ? one_line(j) : text);
  return faults == 0 ? kOk : kMismatch;
}

}  // namespace

Command add_tree(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "tree", "Measure a bounding volume hierarchy and list its faults; exit code 1 if there are any");
  const auto o = std::make_shared<TreeCommandOptions>();
  app->add_option(
         "FILE", o->file,
         "Capture, as written by a program with lrbscope_capture.h; or a mesh or .lrb file: lrbscope's own tree")
      ->required();
  app->add_option("--tree", o->tree, "N", "Only this tree, by the engine's number");
  app->add_flag("--exact", o->report.exact,
                "Compute EPO by clipping triangles to volumes instead of sampling; not for spheres and RSS");
  app->add_option("--tolerance", o->report.tolerance, "T",
                  "Maximum distance of a corner outside a volume, relative to the mesh's diagonal [1e-7]")
      ->in_range(0.0, 1.0);
  app->add_option("--seed", o->report.seed, "S", "Random seed for the points of the surface [1]")
      ->not_negative();
  app->add_flag("--json", o->json, "Print one JSON object");
  app->add_option("-o,--output", o->folder, "DIR",
                  "Also write a page, with charts and a 3D view of the nodes");
  add_up_option(*app, o->up);
  add_join_option(*app, o->corners);
  return {app, [o, &globals] { return run_tree(*o, globals); }};
}

}  // namespace lrb::tools
