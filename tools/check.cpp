#include "scenarios/profile/check.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include "scenarios/profile/captured_run.hpp"
#include "tools/commands.hpp"
#include "tools/import.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::tools {
namespace {

using nlohmann::ordered_json;

struct CheckOptions {
  std::vector<std::string> inputs;
  std::string queries, folder;
  std::optional<profile::Precision> precision;
  std::string up;  ///< of pictures
  bool split = false, json = false;
};

/// Returns a capture, read from a file or converted from a recorded run of lrbscope.
capture::Capture open_capture(const std::string& path, const QueryRange& range) {
  const bool is_run = std::filesystem::is_directory(path) || path.ends_with(".json");
  if (!is_run) return capture::read_capture(path, range.first, range.last);
  capture::Capture out = profile::captured(record::open_run(path));
  std::erase_if(out.queries, [&](const capture::Query& q) { return !range.contains(q.number); });
  return out;
}

ordered_json json_of(const profile::Prices& p) {
  ordered_json out;
  for (const auto& [name, count] : profile::kPriceCounts) out[name] = p.*count;
  return out;
}

ordered_json json_of(const profile::WrongPair& w) {
  ordered_json out{{"a", w.triangles.a},
                   {"b", w.triangles.b},
                   {"error", w.missed ? "missed" : "false"},
                   {"undecidable", w.undecidable},
                   {w.missed ? "overlap_depth" : "gap", w.margin},
                   {"error_bound", w.bound}};
  if (w.missed) out["culprit"] = name_of(w.culprit);
  if (w.nodes[0] != kNull) out["nodes"] = {w.nodes[0], w.nodes[1]};
  if (w.axis != capture::kNoAxis) out["axis"] = w.axis;
  return out;
}

/// Returns the lines of a capture: one for each query, and one for the sums.
std::string json_lines(const profile::Check& c) {
  std::string out;
  for (const profile::CheckedQuery& q : c.queries) {
    const profile::QueryVerdict& v = q.verdict;
    ordered_json wrong = ordered_json::array();
    for (const profile::WrongPair& w : v.wrong) wrong.push_back(json_of(w));
    out += one_line({{"engine", c.engine},
                     {"query", v.number},
                     {"verdict", name_of(v.outcome)},
                     {"remark", v.remark},
                     {"exact_pairs", v.exact_pairs},
                     {"right", v.right},
                     {"undecidable", v.undecidable},
                     {"missed", v.missed},
                     {"false", v.extra},
                     {"wrong_pairs", std::move(wrong)},
                     {"prices", json_of(q.prices)}});
  }
  const profile::CheckSums sum = c.sum();
  ordered_json verdicts;
  for (const auto& entry : kEnumNames<profile::Judgement>)
    verdicts[std::string(entry.name)] = sum.outcomes[static_cast<std::size_t>(entry.value)];
  ordered_json last{{"engine", c.engine},
                    {"queries", sum.queries},
                    {"precision", name_of(c.precision)},
                    {"verdicts", std::move(verdicts)},
                    {"prices", json_of(sum.prices)},
                    {"advice", profile::advice(sum.prices)}};
  if (!c.pose_error.empty()) last["pose_error"] = c.pose_error;
  if (!c.tree_faults.empty()) last["tree_faults"] = c.tree_faults;
  if (!c.sample.empty()) last["sample"] = c.sample;
  return out + one_line(std::move(last));
}

/// Returns the number of errors, and the first ones of each cause, which is named if there are more.
std::string lines_of(const std::vector<profile::Cause>& causes, const std::string& what) {
  constexpr std::size_t kShown = 3;
  std::size_t all = 0;
  std::string out;
  for (const auto& [words, lines] : causes) {
    all += lines.size();
    if (lines.size() > kShown) out += "  " + std::to_string(lines.size()) + " " + words + ", such as:\n";
    for (std::size_t i = 0; i < std::min(lines.size(), kShown); ++i) out += "  " + lines[i] + "\n";
  }
  return std::to_string(all) + " " + what + "\n" + out;
}

std::string text_of(const std::vector<profile::Check>& checks) {
  std::string out;
  for (const profile::Check& c : checks)
    for (const auto& [head, causes] :
         {std::pair{"wrong", &c.wrong}, {"undecidable in floats", &c.undecidable}})
      if (!causes->empty())
        out += c.engine + ": " +
               lines_of(*causes, std::string(head) + (c.sample.empty() ? "" : ", of the recorded queries"));
  out += report::in_columns(profile::verdict_table(checks), 2) + "\n" +
         report::in_columns(profile::price_table(checks), 2) + "\n";
  for (const profile::Check& c : checks) {
    for (const std::string& doubt : {c.pose_error, c.tree_faults, c.sample})
      if (!doubt.empty()) out += c.engine + ": " + doubt + "\n";
    out += c.engine + ": " + profile::advice(c.sum().prices) + "\n";
  }
  return out;
}

void write_page(const std::vector<profile::Check>& checks, bool wrong, const CheckOptions& o,
                const Globals& globals) {
  const report::Folder folder(o.folder);
  report::Document page("Answers and visits of " + std::string(checks.size() == 1 ? "an engine" : "engines"),
                        "An exact query checks each answer. Prices of visits: needed, proof, or waste.");
  profile::CheckSums all;
  for (const profile::Check& c : checks) all += c.sum();
  page.verdict(wrong ? "wrong in " +
                           std::to_string(all.outcomes[static_cast<std::size_t>(profile::Judgement::wrong)]) +
                           " of " + render::counted(all.queries, "query", "queries")
                     : "no wrong answers",
               !wrong)
      .command(globals.command_line);
  note(globals, profile::add_checks(page, checks, view_with(o.up).up));
  page.write(folder);
}

int run_check(CheckOptions o, const Globals& globals) {
  const QueryRange range = parse_queries(o.queries);
  profile::CheckSettings settings{o.precision, std::nullopt};
  if (o.split) settings.split = true;
  std::vector<profile::Check> checks;
  for (const std::string& path : o.inputs) {
    const capture::Capture capture = open_capture(path, range);
    if (capture.queries.empty())
      throw InputError(printable_name(path) + ": expected queries, found none" +
                       (o.queries.empty() ? "" : " with these numbers") + "; record some, or choose others");
    if (!o.up.empty() && !capture.meshes.empty())
      resolve_up(o.up, profile::captured_body(capture.meshes[0]).rep, globals);
    checks.push_back(profile::check(capture, settings, progress_report(globals.quiet)));
  }
  if (o.json)
    for (const profile::Check& c : checks) print(json_lines(c));
  // In texts, captures of the same engine are named by their files.
  std::map<std::string, std::size_t> captures;  // number for each engine
  for (const profile::Check& c : checks) ++captures[c.engine];
  for (std::size_t i = 0; i < checks.size(); ++i)
    if (captures[checks[i].engine] > 1) checks[i].engine = printable_name(o.inputs[i]);
  const bool wrong = std::ranges::any_of(checks, &profile::Check::is_wrong);
  if (!o.json) print(text_of(checks));
  if (!o.folder.empty()) {
    write_page(checks, wrong, o, globals);
    if (!o.json) print(o.folder + "/index.html\n");
  }
  return wrong ? kMismatch : kOk;
}

}  // namespace

Command add_check(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "check", "Check another engine's captured answers, and price its visits of tree nodes");
  const auto o = std::make_shared<CheckOptions>();
  app->add_option(
         "CAPTURE", o->inputs,
         "Captures, written by lrbscope_capture.h, or runs of lrbscope recorded with --events nodes; "
         "several are compared")
      ->required();
  app->add_option("--queries", o->queries, "FIRST-LAST",
                  "Only these queries, by number from 1: 40-60, 40- or 40");
  add_choice<profile::Precision>(*app, "--precision", o->precision,
                                 "Number format of the engine, which decides how close to contact its tests "
                                 "may err [float if all volumes are floats, else double]");
  app->add_flag("--split", o->split,
                "Split waste into volumes and order even for captures of more than " +
                    std::to_string(profile::kMaxVisitsToSplit) + " visits, which takes long");
  app->add_flag("--json", o->json, "Print JSON, a line for each query and one for the sums");
  app->add_option("-o,--output", o->folder, "DIR", "Also write a page to this folder");
  add_up_option(*app, o->up);
  return {app, [o, &globals] { return run_check(*o, globals); }};
}

}  // namespace lrb::tools
