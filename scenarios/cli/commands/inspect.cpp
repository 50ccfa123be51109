#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "engine/lrb/lrb_file.hpp"
#include "engine/lrb/validate.hpp"
#include "engine/mesh/checked_mesh.hpp"
#include "engine/mesh/io/mesh_io.hpp"
#include "scenarios/bodies/body.hpp"
#include "scenarios/bodies/hull_figures.hpp"
#include "scenarios/cli/command.hpp"
#include "scenarios/cli/options.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/run/body_sheet.hpp"
#include "scenarios/run/chosen_view.hpp"
#include "scenarios/run/dirt_picture.hpp"
#include "scenarios/run/frame_job.hpp"

namespace lrb::cli {
namespace {

using Json = nlohmann::ordered_json;

struct InspectOptions {
  std::string file, picture, drawing;
  PictureOptions pictures;
  bool validate = false, render = false, json = false;
};

Json box_json(const std::vector<Eigen::Vector3d>& vertices) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : vertices) box.extend(v);
  if (box.isEmpty()) return nullptr;
  return {{"low", {box.min().x(), box.min().y(), box.min().z()}},
          {"high", {box.max().x(), box.max().y(), box.max().z()}}};
}

Json mesh_json(const Mesh& mesh, const MeshReport& report) {
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
  j["buildable"] = report.when_turned().buildable();  // because `build` turns it
  j["queryable"] = report.queryable();
  j["findings"] = report.lines(mesh);
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

std::string as_text(const Json& j) {
  std::ostringstream out;
  for (const auto& [key, value] : j.items()) {
    if (value.is_array() && (key == "findings" || key == "violations")) {
      out << key << (value.empty() ? ": none\n" : ":\n");
      for (const auto& line : value) out << "  " << line.get<std::string>() << "\n";
    } else if (key == "layers_from_the_solid") {
      out << "layers, from the solid outward:\n";
      for (const auto& l : value)
        out << "  " << l["regions"] << " regions, " << l["lids"] << " lids over " << l["floor_faces"]
            << " faces\n";
    } else {
      constexpr int kDigits = 6;  // of coordinates
      out << key << ": " << for_people(value, kDigits) << "\n";
    }
  }
  return out.str();
}

void draw_findings(const Mesh& mesh, const MeshReport& report, const std::string& path, Json& j,
                   std::vector<std::string>& notes) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const bool any = std::any_of(report.findings.begin(), report.findings.end(),
                               [](const MeshFinding& f) { return f.count > 0; });
  if (any && !folder.empty()) io::make_folder(folder);
  if (any && run::draw_dirt(mesh, report, path)) {
    j["drawing"] = path;
    return;
  }
  j["drawing"] = nullptr;
  notes.push_back(mesh.name + ": nothing to draw: there are no findings; " + path + " was not written");
}

/// Returns how the body is to be drawn.
spec::FrameSpec sheet_frames(const InspectOptions& o) {
  const CameraOptions& camera = o.pictures.camera;
  const bool any = !o.pictures.size.empty() || o.pictures.dpi || !camera.from.empty() ||
                   !camera.look_at.empty() || !camera.up.empty() || camera.zoom || camera.orthographic;
  if (any && !o.render)
    throw InputError("--size, --dpi and where to look from are for --render: add it, or leave them out");
  spec::FrameSpec frames;
  frames.width = run::kBodySheetWidth;
  frames.height = run::kBodySheetHeight;
  apply(o.pictures, frames);
  run::check_frame_size(frames);
  return frames;
}

void look_broadside(const LrbRep& rep, spec::FrameSpec& frames) {
  if (frames.views.empty()) frames.views.emplace_back();
  frames.views[0].from = run::broadside(run::box_of(rep), frames.views[0].up);
}

int run_inspect(const InspectOptions& o, const Globals& globals) {
  spec::FrameSpec frames = sheet_frames(o);
  Json j;
  std::unique_ptr<LrbRep> rep;
  std::vector<std::string> notes;
  if (bodies::is_lrb_file(o.file)) {
    if (!o.drawing.empty())
      throw InputError(
          printable_name(o.file) +
          ": is an LRB-rep, which has no findings to draw; give its mesh, or draw it with --render");
    rep = std::make_unique<LrbRep>(load_lrb(o.file));
    j["file"] = o.file;
    j["kind"] = "LRB-rep";
    j.update(bodies::body_figures(*rep));
    j["layers_from_the_solid"] = layers_json(*rep);
  } else {
    CheckedMesh mesh = check(read_mesh(o.file));
    mesh.find_self_intersections();
    j = mesh_json(mesh.mesh(), mesh.report());
    if (!o.drawing.empty()) draw_findings(mesh.mesh(), mesh.report(), o.drawing, j, notes);
    if (o.validate)
      rep = std::make_unique<LrbRep>(bodies::build_from_mesh(std::move(mesh), {}, notes));
    else if (o.render)
      rep = std::make_unique<LrbRep>(bodies::body_of_mesh(std::move(mesh)).rep);
  }
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
  if (o.render) {
    const std::string picture =
        o.picture.empty() ? "out/" + std::filesystem::path(o.file).stem().string() + ".png" : o.picture;
    io::make_folder(std::filesystem::path(picture).parent_path().string());
    if (o.pictures.camera.from.empty()) look_broadside(*rep, frames);
    run::draw_body_sheet(*rep, picture, frames);
    j["picture"] = picture;
  }
  note(globals, notes);
  print(o.json ? one_line(j) : as_text(j));
  return valid ? kOk : kMismatch;
}

Command add_inspect(CLI::App& root, const Globals& globals) {
  CLI::App* app =
      root.add_subcommand("inspect", "Tell what a mesh or an LRB-rep is, and what is wrong with it");
  const auto o = std::make_shared<InspectOptions>();
  app->add_option("FILE", o->file, "Mesh or .lrb file")->required();
  app->add_flag("--validate", o->validate,
                "Prove that the LRB-rep keeps its promises (a mesh is built first); exit code 1 if not");
  app->add_flag("--render", o->render, "Draw the body, its layers and its outermost wrapper");
  app->add_option("--draw", o->drawing,
                  "Draw what is wrong with a mesh, to this picture: the first offenders are pointed out")
      ->type_name("FILE.png");
  app->add_option("-o,--output", o->picture, "Picture to write [out/NAME.png]")->type_name("FILE.png");
  add_size_options(*app, o->pictures);
  add_camera_options(*app, o->pictures.camera);
  app->add_flag("--json", o->json, "Print one JSON object");
  return {app, [o, &globals] { return run_inspect(*o, globals); }};
}

}  // namespace

std::vector<CommandEntry> inspect_commands() {
  return {{add_inspect, 60}};
}

}  // namespace lrb::cli
