#include <memory>

#include <nlohmann/json.hpp>

#include "bench/levels/level_report.hpp"
#include "scenarios/bodies/body_figures.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/report/document.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::cli {
namespace {

struct LevelsOptions {
  bodies::Corners corners = bodies::Corners::joined;
  std::string body, folder, up;
  std::vector<double> shares;
  BuildOptions build;
  bool json = false;
};

/// `why_none`: why the body has no levels of detail, or empty if it has some.
std::string as_table(const std::vector<bodies::LevelFigures>& levels, const LrbRep& rep,
                     const std::string& why_none) {
  constexpr int kDigits = 4;
  const std::string head = rep.name() + ": " + std::to_string(rep.real_face_count()) + " faces\n";
  if (!why_none.empty()) return head + "no levels of detail, because " + why_none + "\n";
  std::vector<std::vector<std::string>> rows = {{"share", "tolerance", "faces", "deviation"}};
  for (const bodies::LevelFigures& l : levels)
    rows.push_back({io::number_text(l.share, kDigits), io::number_text(l.tolerance, kDigits),
                    std::to_string(l.faces), io::number_text(l.bound, kDigits)});
  return head + report::in_columns(rows, 0);
}

int run_levels(const LevelsOptions& o, const Globals& globals) {
  const bodies::LoadedBody body = bodies::load_body(o.body, with_progress(o.build, globals.quiet), o.corners);
  levels::LevelReportOptions report{o.shares, {}, o.build.threads, globals.command_line};
  if (!o.up.empty()) report.view = turned_up(report.view, o.up[0] - 'x');
  if (!o.folder.empty()) levels::check_drawable(body.rep, report.shares);
  note(globals, body.notes);
  const std::string why_none = why_no_levels(body.rep);
  if (!why_none.empty()) note(globals, {note_no_levels(body.rep)});
  if (!o.folder.empty()) note(globals, levels::write_level_report(body.rep, report, o.folder));
  const std::string page = o.folder.empty() ? "" : o.folder + "/index.html";
  std::vector<bodies::LevelFigures> levels;
  if (why_none.empty()) levels = bodies::level_figures(body.rep, o.shares, o.build.threads);
  if (o.json) {
    nlohmann::ordered_json j;
    j["name"] = body.rep.name();
    j["real_faces"] = body.rep.real_face_count();
    j["levels"] = bodies::level_json(levels);
    if (!why_none.empty()) j["no_levels"] = why_none;
    if (!page.empty()) j["page"] = page;
    print(one_line(j));
  } else {
    print(as_table(levels, body.rep, why_none) + (page.empty() ? "" : page + "\n"));
  }
  return kOk;
}

}  // namespace

Command add_levels(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "levels",
      "Report how many faces a body needs at each of several tolerances (levels of detail), with proven "
      "error bounds");
  const auto o = std::make_shared<LevelsOptions>();
  o->shares.assign(std::begin(bodies::kLevelShares), std::end(bodies::kLevelShares));
  app->add_option("BODY", o->body, "Mesh or .lrb file")->required();
  app->add_option("--at", o->shares, "SHARE...",
                  "Tolerances, as fractions of the longest side of the body's box")
      ->in_hidden_range(0.0, 1.0)
      ->capture_default_str();
  app->add_option(
      "-o,--output", o->folder, "FOLDER",
      "Write pictures and a page of the wrappers, their deviation from the body and their face counts");
  add_up_option(*app, o->up);
  o->build.threads = 0;
  add_build_options(*app, o->build);
  app->add_flag("--json", o->json, "Print one JSON object");
  add_join_option(*app, o->corners);
  return {app, [o, &globals] { return run_levels(*o, globals); }};
}

}  // namespace lrb::cli
