#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "render/pictures/answer_picture.hpp"
#include "render/pictures/body_picture.hpp"
#include "render/pictures/panel.hpp"
#include "scenarios/bodies/body_figures.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/frames/frames.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/report/document.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/mesh_repair.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/self_intersections.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::tools {

namespace {

using Json = nlohmann::ordered_json;

// Regions and trial settings as printed by `--regions` and `--try`.

constexpr int kRegionDigits = 3;

/// Returns all regions, in the given order, with the keys of `--json`.
Json regions_json(std::span<const bodies::RegionFigures> regions) {
  Json out = Json::array();
  for (const bodies::RegionFigures& r : regions)
    out.push_back({{"region", r.region.value()},
                   {"layer", r.layer},
                   {"lids", r.lids},
                   {"floor", r.floor},
                   {"volume", r.volume},
                   {"distance", std::isfinite(r.thickness) ? Json(r.thickness) : Json(nullptr)},
                   {"parent", is_region(r.parent) ? Json(r.parent.value()) : Json("outside")},
                   {"waste", r.waste}});
  return out;
}

std::vector<std::string> cells_of(const Json& row) {
  std::vector<std::string> out;
  for (const Json& value : row) out.push_back(value.is_null() ? "-" : for_people(value, kRegionDigits));
  return out;
}

/// Returns the first regions as a text table.
std::string regions_text(const Json& regions) {
  constexpr std::size_t kMaxRows = 25;
  std::vector<std::vector<std::string>> rows = {
      {"region", "layer", "lids", "floor", "volume", "distance", "parent", "waste"}};
  for (std::size_t i = 0; i < std::min(regions.size(), kMaxRows); ++i) rows.push_back(cells_of(regions[i]));
  return "regions:\n" + report::in_columns(rows, 0) +
         (regions.size() > kMaxRows
              ? "  and " + std::to_string(regions.size() - kMaxRows) + " more: --json lists all\n"
              : "") +
         "(distance: maximum distance from a point of the lids to the body. waste: expected number of faces "
         "exposed needlessly by a random point in the outermost wrapper, that is the region's share of the "
         "wrapper's volume times its floor faces; total over all regions, " +
         bodies::kUsualWaste + ".)\n";
}

Json trials_json(std::span<const bodies::Trial> trials) {
  Json out = Json::array();
  for (const bodies::Trial& t : trials)
    out.push_back({{"setting", t.setting.empty() ? "as it is" : t.setting},
                   {"total_per_real", t.figures.total_per_real},
                   {"outer_faces", t.figures.outer_faces},
                   {"outer_per_hull", t.figures.outer_per_hull},
                   {"waste", t.figures.waste},
                   {"seconds", t.setting.empty() ? Json(nullptr) : Json(t.figures.seconds)}});
  return out;
}

std::string trials_text(const Json& trials) {
  std::vector<std::vector<std::string>> rows = {
      {"setting", "faces per real face", "outermost faces", "wrapper/convex hull", "waste", "seconds"}};
  for (const Json& t : trials) rows.push_back(cells_of(t));
  return "tried:\n" + report::in_columns(rows);
}

/// Returns the caption of a region's picture.
std::string region_caption(const bodies::RegionFigures& r) {
  return "region " + std::to_string(r.region) + ", layer " + std::to_string(r.layer) + ": " +
         render::counted(r.lids, "lid", "lids") + " over " + render::counted(r.floor, "face", "faces") +
         ", deviation " +
         (std::isfinite(r.thickness) ? for_people(r.thickness, kRegionDigits) : "unbounded") + "; parent " +
         (is_region(r.parent) ? std::to_string(r.parent) : "outside") + ", waste " +
         for_people(r.waste, kRegionDigits);
}

// The command.

struct InspectOptions {
  bodies::Corners corners = bodies::Corners::joined;
  std::string file, picture, drawing;
  PictureOptions pictures;
  bool validate = false, render = false, json = false;
  bool regions = false, tried = false, self_intersections = false, levels = false;
  std::vector<double> shares{std::begin(bodies::kLevelShares), std::end(bodies::kLevelShares)};
  bodies::RegionOrder sort = bodies::RegionOrder::waste;
  std::vector<std::string> fail_on;  ///< names of MeshFault
  unsigned threads = 0;
};

/// Returns the drawing options, with this size unless one is given. Height 0: to be computed.
pictures::Look sheet_look(const InspectOptions& o, int width, int height) {
  if (!o.render && o.drawing.empty()) {
    const CameraOptions& camera = o.pictures.camera;
    const std::pair<bool, const char*> of_pictures[] = {{!o.pictures.size.empty(), "--size"},
                                                        {o.pictures.dpi.has_value(), "--dpi"},
                                                        {o.pictures.style.has_value(), "--style"},
                                                        {!camera.from.empty(), "--from"},
                                                        {!camera.look_at.empty(), "--look-at"},
                                                        {camera.zoom.has_value(), "--zoom"},
                                                        {camera.orthographic.has_value(), "--projection"},
                                                        {!camera.up.empty(), "--up"}};
    for (const auto& [given, name] : of_pictures)
      if (given)
        throw InputError(std::string(name) + ": needs --render or --draw; add one, or leave " + name +
                         " out");
  }
  pictures::FrameSpec frames;
  frames.width = width;
  frames.height = height;
  apply(o.pictures, frames);
  pictures::to_pixels(frames);
  return frames;
}

/// Prints a JSON line for each pair of faces that intersect.
int list_self_intersections(InspectOptions o, const Globals& globals) {
  sheet_look(o, pictures::kAnswerWidth, pictures::kAnswerHeight);  // throws before the body is loaded
  std::vector<std::string> notes;
  SelfIntersections found;
  std::optional<LrbRep> body;  // to be drawn
  if (bodies::is_lrb_file(o.file)) {
    body.emplace(load_lrb(o.file));
    found = self_intersections(*body);
  } else {
    const CheckedMesh mesh = check(bodies::read_body(o.file, o.corners, notes), MeshFinding::kShown);
    found = self_intersections(mesh);
    if (!o.drawing.empty()) body.emplace(bodies::faces_of_mesh(mesh.mesh()).rep);
  }
  if (body) resolve_up(o.pictures.camera.up, *body, globals);
  const pictures::Look look = sheet_look(o, pictures::kAnswerWidth, pictures::kAnswerHeight);
  if (!o.drawing.empty()) frames::check_views(look.views, body->dim());
  note(globals, notes);
  std::string lines;
  for (const SelfIntersection& pair : found.pairs) {
    lines += trace::json_text(trace::JsonWriter::kCompact, [&](trace::JsonWriter& w) {
      w.begin_object().member("faces", std::array{pair.a, pair.b});
      w.member("kind", name_of(pair.kind)).member("shared", std::uint64_t{pair.shared});
      w.member("curve", std::uint64_t{pair.curve});
      w.member("segments", std::span(found.segments).subspan(pair.first_segment, pair.segments));
      w.end_object();
    });
    constexpr std::size_t kAtOnce = 1 << 20;
    if (lines.size() > kAtOnce) print(std::exchange(lines, {}));
  }
  print(lines);
  note(globals, {render::counted(found.pairs.size(), "pair", "pairs") + " of faces, " +
                 render::counted(found.curves, "curve", "curves")});
  if (!o.drawing.empty())
    pictures::write_picture(pictures::picture_of(found, *body, look), o.drawing, look.dpi);
  return found.pairs.empty() ? kOk : kMismatch;
}

/// Prints the levels of detail: how many faces the body needs at each tolerance.
int list_levels(const InspectOptions& o, const Globals& globals) {
  constexpr int kDigits = 4;
  const bodies::LoadedBody body = bodies::load_body(o.file, with_progress({}, globals.quiet), o.corners);
  const LrbRep& rep = body.rep;
  note(globals, body.notes);
  const std::string why_none = why_no_levels(rep);
  if (!why_none.empty()) note(globals, {note_no_levels(rep)});
  std::vector<bodies::LevelFigures> levels;
  if (why_none.empty()) levels = bodies::level_figures(rep, o.shares, o.threads);
  if (o.json) {
    Json j = {
        {"name", rep.name()}, {"real_faces", rep.real_face_count()}, {"levels", bodies::level_json(levels)}};
    if (!why_none.empty()) j["no_levels"] = why_none;
    print(one_line(j));
    return kOk;
  }
  const std::string head = rep.name() + ": " + std::to_string(rep.real_face_count()) + " faces\n";
  std::vector<std::vector<std::string>> rows = {{"share", "tolerance", "faces", "deviation"}};
  for (const bodies::LevelFigures& l : levels)
    rows.push_back({io::number_text(l.share, kDigits), io::number_text(l.tolerance, kDigits),
                    std::to_string(l.faces), io::number_text(l.bound, kDigits)});
  print(head +
        (why_none.empty() ? report::in_columns(rows, 0) : "no levels of detail, because " + why_none + "\n"));
  return kOk;
}

Json box_json(const std::vector<Eigen::Vector3d>& vertices) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : vertices) box.extend(v);
  if (box.isEmpty()) return nullptr;
  return {{"low", {box.min().x(), box.min().y(), box.min().z()}},
          {"high", {box.max().x(), box.max().y(), box.max().z()}}};
}

Json loops_json(const std::vector<BoundaryLoop>& loops) {
  Json out = Json::array();
  for (const BoundaryLoop& l : loops) {
    const Eigen::Vector3d &low = l.box.min(), &high = l.box.max();
    Json vertices = Json::array();
    for (const VertexId v : l.vertices) vertices.push_back(v.value());
    out.push_back({{"edges", l.edges()},
                   {"length", l.length},
                   {"low", {low.x(), low.y(), low.z()}},
                   {"high", {high.x(), high.y(), high.z()}},
                   {"planar", l.planar},
                   {"is_loop", l.is_loop},
                   {"vertices", std::move(vertices)}});
  }
  return out;
}

/// Returns boundary loops as text: the longest, one per line.
std::string loops_text(const Json& loops) {
  constexpr std::size_t kMaxLines = 20;
  constexpr int kDigits = 4;
  std::size_t edges = 0;
  for (const Json& l : loops) edges += l["edges"].get<std::size_t>();
  std::ostringstream out;
  out << "boundary: " << edges << " open edges in " << loops.size()
      << (loops.size() == 1 ? " loop" : " loops") << (loops.empty() ? "\n" : ", longest first:\n");
  for (std::size_t i = 0; i < std::min(loops.size(), kMaxLines); ++i) {
    const Json& l = loops[i];
    out << "  " << i << ": " << l["edges"] << " edges, length " << for_people(l["length"], kDigits) << ", "
        << (l["planar"] ? "flat" : "not flat") << (l["is_loop"] ? "" : ", not a simple loop") << ", from "
        << for_people(l["low"], kDigits) << " to " << for_people(l["high"], kDigits) << "\n";
  }
  if (loops.size() > kMaxLines) out << "  and " << loops.size() - kMaxLines << " more: --json lists all\n";
  return out.str();
}

/// Returns the findings: for each its kind, count, elements, and a text line. An element is a number, or an
/// array of two.
Json findings_json(const Mesh& mesh, const MeshReport& report) {
  Json out = Json::array();
  for (std::size_t i = 0; i < kMeshFaultCount; ++i) {
    const auto fault = static_cast<MeshFault>(i);
    if (report[fault].count == 0) continue;
    Json elements = Json::array();
    for (const auto& [first, second] : report[fault].first)
      elements.push_back(second == kNull ? Json(first) : Json{first, second});
    out.push_back({{"kind", name_of(fault)},
                   {"count", report[fault].count},
                   {"elements", std::move(elements)},
                   {"text", report.line(fault, mesh)}});
  }
  return out;
}

Json mesh_json(const CheckedMesh& checked, const std::vector<BoundaryLoop>& loops) {
  const Mesh& mesh = checked.mesh();
  const MeshReport& report = checked.report();
  Json j;
  j["file"] = mesh.name;
  j["kind"] = "mesh";
  j["dim"] = mesh.dim;
  j["vertices"] = mesh.vertices.size();
  j["faces"] = mesh.face_count();
  j["box"] = box_json(mesh.vertices);
  j["components"] = report.components;
  j["genus"] = report.genus >= 0 ? Json(report.genus) : Json(nullptr);
  j["closed"] = report.closed;
  j["bounds_solid"] = report.bounds_solid;
  j["buildable"] = report.when_turned().buildable();  // because `build` flips the orientation
  j["queryable"] = report.queryable();
  j["findings"] = findings_json(mesh, report);
  j["boundary_loops"] = loops_json(loops);
  return j;
}

Json layers_json(const LrbRep& rep) {
  std::vector<std::array<std::uint64_t, 3>> layers(rep.layer_count());
  for (RegionId r = 0; r < rep.region_count(); ++r) {
    layers[rep.layer(r)][0] += 1;
    layers[rep.layer(r)][1] += rep.lids(r).size();
    layers[rep.layer(r)][2] += rep.floor(r).size();
  }
  Json out = Json::array();
  for (const auto& l : layers) out.push_back({{"regions", l[0]}, {"lids", l[1]}, {"floor_faces", l[2]}});
  return out;
}

void draw_findings(const pictures::FaultyMesh& faulty, const InspectOptions& o, Json& j,
                   std::vector<std::string>& notes) {
  const std::string& path = o.drawing;
  const pictures::Look look = sheet_look(o, pictures::kFindingsSheetWidth, 0);
  frames::check_views(look.views, faulty.mesh.dim);
  j["drawing"] = nullptr;
  if (const auto picture = pictures::picture_of(faulty, look)) {
    pictures::write_picture(*picture, path, look.dpi);
    j["drawing"] = path;
    return;
  }
  notes.push_back(faulty.mesh.name + ": no findings to draw; " + path + " was not written");
}

/// Measures the regions, and draws the ten with the largest waste if pictures are requested (`picture` is not
/// empty).
void report_regions(const LrbRep& rep, const InspectOptions& o, const pictures::Look& look,
                    const std::string& picture, Json& j) {
  if (rep.region_count() == 0)
    throw InputError(rep.name() +
                     ": no regions to list: an LRB-rep cannot be built; `lrbscope build` says why");
  const std::vector<bodies::RegionFigures> regions = bodies::region_figures(rep, o.sort, o.threads);
  j["total_waste"] = bodies::total_waste(regions);
  j["region_figures"] = regions_json(regions);
  if (!picture.empty()) {
    constexpr std::size_t kWorst = 10;
    std::vector<pictures::ShownRegion> shown;
    for (std::size_t i = 0; i < std::min(kWorst, regions.size()); ++i)
      shown.push_back({regions[i].region, region_caption(regions[i])});
    pictures::write_picture(
        pictures::region_sheet(rep, bodies::waste_over_faces(rep, regions), "waste per face", shown, look),
        picture, look.dpi);
  }
  if (!o.tried) return;
  const std::vector<bodies::Trial> trials = bodies::try_settings(rep, o.threads);
  j["trials"] = trials_json(trials);
  j["advice"] = bodies::advice(rep, trials);
}

void look_broadside(const LrbRep& rep, pictures::Look& look) {
  if (look.views.empty()) look.views.emplace_back();
  look.views[0].from = pictures::broadside(pictures::box_of(rep), look.views[0].up);
}

std::string as_text(const Json& j) {
  std::ostringstream out;
  for (const auto& [key, value] : j.items()) {
    if (value.is_array() && (key == "findings" || key == "violations" || key == "advice")) {
      out << key << (value.empty() ? ": none\n" : ":\n");
      for (const auto& line : value)
        out << "  " << (line.is_object() ? line["text"] : line).get<std::string>() << "\n";
    } else if (key == "boundary_loops") {
      if (!value.empty()) out << loops_text(value);
    } else if (key == "region_figures") {
      out << regions_text(value);
    } else if (key == "trials") {
      out << trials_text(value);
    } else if (key == "layers_from_the_solid") {
      out << "layers, from the solid outward:\n";
      for (const auto& l : value)
        out << "  " << l["regions"] << " regions, " << l["lids"] << " lids over " << l["floor_faces"]
            << " faces\n";
    } else {
      constexpr int kDigits = 6;  // of coordinates
      out << key << ": " << for_people(value, kDigits)
          << (key == "total_waste" ? std::string(" (") + bodies::kUsualWaste + ")" : "") << "\n";
    }
  }
  return out.str();
}

int run_inspect(InspectOptions o, const Globals& globals) {
  if (o.self_intersections) return list_self_intersections(o, globals);
  if (o.levels) return list_levels(o, globals);
  sheet_look(o, pictures::kBodySheetWidth, pictures::kBodySheetHeight);  // throws before the body is loaded
  Json j;
  std::unique_ptr<LrbRep> rep;
  std::vector<std::string> notes;
  bool failed = false;
  if (bodies::is_lrb_file(o.file)) {
    if (!o.drawing.empty() || !o.fail_on.empty())
      throw InputError(printable_name(o.file) + ": expected a mesh for " +
                       (o.drawing.empty() ? "--fail-on" : "--draw") +
                       ", found an LRB-rep, which has no findings; give its mesh" +
                       (o.drawing.empty() ? "" : ", or use --render"));
    rep = std::make_unique<LrbRep>(load_lrb(o.file));
    j["file"] = o.file;
    j["kind"] = "LRB-rep";
    j.update(bodies::body_figures(*rep));
    j["layers_from_the_solid"] = layers_json(*rep);
  } else {
    constexpr std::size_t kMaxElements = 1'000'000;  // per kind, so that the output is not larger than a mesh
    CheckedMesh mesh =
        check(bodies::read_body(o.file, o.corners, notes), o.json ? kMaxElements : MeshFinding::kShown);
    mesh.find_self_intersections();
    const std::vector<BoundaryLoop> loops = find_boundary_loops(mesh.mesh(), mesh.use());
    j = mesh_json(mesh, loops);
    const MeshReport shown = mesh.report().shortened();
    for (std::size_t i = 0; i < kMeshFaultCount; ++i) {
      const std::string kind(name_of(static_cast<MeshFault>(i)));
      if (shown.findings[i].count == 0 || std::ranges::count(o.fail_on, kind) == 0) continue;
      notes.push_back(mesh.mesh().name + ": fails on " + kind);
      failed = true;
    }
    if (!o.drawing.empty()) {
      if (o.pictures.camera.up == "auto")
        resolve_up(o.pictures.camera.up, bodies::faces_of_mesh(mesh.mesh()).rep, globals);
      constexpr std::uint64_t kMaxDrawn = 100'000;  // of more pairs, the first are drawn
      const std::uint64_t crossing = shown[MeshFault::self_intersection].count;
      const bool cross = crossing > 0 && crossing <= kMaxDrawn;
      draw_findings({mesh.mesh(), shown, loops,
                     cross ? self_intersections(mesh).segments : SelfIntersections().segments},
                    o, j, notes);
    }
    if (o.validate)
      rep = std::make_unique<LrbRep>(bodies::build_from_mesh(std::move(mesh), {}, notes));
    else if (o.render || o.regions)
      rep = std::make_unique<LrbRep>(
          bodies::body_of_mesh(std::move(mesh), with_progress({}, globals.quiet)).rep);
  }
  if (rep) resolve_up(o.pictures.camera.up, *rep, globals);
  pictures::Look look = sheet_look(o, pictures::kBodySheetWidth, pictures::kBodySheetHeight);
  bool valid = true;
  if (o.validate) {
    ValidateOptions validating;
    validating.threads = 0;
    const ValidateReport report = validate(*rep, validating);
    valid = report.valid;
    j["valid"] = report.valid;
    j["violations"] = report.violations;
    j["volume_error"] = report.volume_error;
  }
  std::string picture;
  if (o.render) {
    frames::check_views(look.views, rep->dim());
    picture = o.picture.empty() ? "out/" + std::filesystem::path(o.file).stem().string() +
                                      (o.regions ? "-regions.png" : ".png")
                                : o.picture;
    if (o.pictures.camera.from.empty()) look_broadside(*rep, look);
    if (!o.regions) pictures::write_picture(pictures::body_sheet(*rep, look), picture, look.dpi);
    j["picture"] = picture;
  }
  if (o.regions) report_regions(*rep, o, look, picture, j);
  note(globals, notes);
  print(o.json ? one_line(j) : as_text(j));
  return valid && !failed ? kOk : kMismatch;
}

}  // namespace

Command add_inspect(App& root, const Globals& globals) {
  App* app = root.add_subcommand("inspect", "Report the properties and defects of a mesh or an LRB-rep");
  const auto o = std::make_shared<InspectOptions>();
  app->add_option("FILE", o->file, "Mesh or .lrb file")->required();
  app->add_flag("--validate", o->validate,
                "Validate the LRB-rep (a mesh is built first); exit code 1 if it is invalid");
  std::vector<std::string> kinds;
  for (std::size_t i = 0; i < kMeshFaultCount; ++i) kinds.emplace_back(name_of(static_cast<MeshFault>(i)));
  app->add_option("--fail-on", o->fail_on, "KIND,...",
                  "Exit code 1 if the mesh has findings of these kinds, comma-separated: those of --json")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->one_of(kinds);
  app->add_flag(
      "--render", o->render,
      "Draw the body, its layers and its outermost wrapper; with --regions, also a map of wasted refinement "
      "and the ten worst regions");
  auto* regions =
      app->add_flag("--regions", o->regions, "List the regions (a mesh is built first), worst first");
  add_choice<bodies::RegionOrder>(*app, "--sort", o->sort, "Sort key [waste]");
  app->add_flag("--try", o->tried, "Rebuild with other settings and report which ones improve the LRB-rep")
      ->needs(regions);
  app->get_option("--sort")->needs(regions);
  app->add_option("--draw", o->drawing, "FILE.png",
                  "Draw the mesh's defects to this PNG, with the first defective elements marked; with "
                  "--self-intersections, the pairs and the segments in which they intersect");
  app->add_option("-o,--output", o->picture, "FILE.png", "Picture to write [out/NAME.png]");
  add_size_options(*app, o->pictures);
  add_camera_options(*app, o->pictures.camera);
  auto* json = app->add_flag("--json", o->json, "Print one JSON object");
  auto* pairs =
      app->add_flag("--self-intersections", o->self_intersections,
                    "Only list the pairs of faces that intersect, one JSON line each, with kind, segments "
                    "and curve; exit code 1 if there are any");
  for (Option* other : {json, regions, app->get_option("--validate"), app->get_option("--render"),
                        app->get_option("--output"), app->get_option("--fail-on")})
    pairs->excludes(other);
  auto* levels =
      app->add_flag("--levels", o->levels,
                    "Only list the levels of detail: how many faces the body (a mesh is built first) needs "
                    "at each of several tolerances, with proven deviations");
  for (Option* other : {pairs, regions, app->get_option("--validate"), app->get_option("--render"),
                        app->get_option("--draw"), app->get_option("--output"), app->get_option("--fail-on")})
    levels->excludes(other);
  app->add_option("--at", o->shares, "SHARE...",
                  "With --levels: tolerances, as fractions of the longest side of the body's box")
      ->in_hidden_range(0.0, 1.0)
      ->needs(levels)
      ->capture_default_str();
  add_join_option(*app, o->corners);
  return {app, [o, &globals] { return run_inspect(*o, globals); }};
}

}  // namespace lrb::tools
